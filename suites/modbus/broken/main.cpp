// modbus_broken_server: a device with a known fault on a terminal, in real time. For the tests of
// the suite, and for whoever writes a driver and wants to see it meet a bad device.
#include <fmt/format.h>
#include <filesystem>

#include <cstdio>
#include <string>
#include <vector>

#include "harness/hosting/device_host.hpp"
#include "suites/modbus/broken/broken_server.hpp"
#include "suites/modbus/broken/faults.hpp"

namespace {

using namespace fieldproof;

int usage() {
  fmt::print(stderr,
             "usage: modbus_broken_server rtu|ascii FAULT TTY [STATION [KEY=VALUE...]]\n"
             "       modbus_broken_server --list\n"
             "FAULT    of the list; 'none' is a healthy device\n"
             "TTY      a terminal, or a path that becomes a link to a new pty\n"
             "STATION  0 to 255, 1 without\n"
             "KEY      of the configuration: bit_read_base, bit_write_base, word_read_base, "
             "word_write_base, ...\n");
  return 2;
}

int list() {
  for (const modbus_broken::Fault& fault : modbus_broken::faults())
    fmt::print("{:<38} {}\n", fault.name, fault.what);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (given.size() == 1 && given[0] == "--list") return list();
  if (given.size() < 3) return usage();
  hosting::HostOptions host;
  (std::filesystem::exists(given[2]) ? host.tty : host.pty) = given[2];
  host.model = "xbc-h";
  host.config["station"] = given.size() > 3 ? given[3] : "1";
  for (std::size_t i = 4; i < given.size(); ++i) {
    const std::size_t equals = given[i].find('=');
    if (equals == std::string::npos) return usage();
    host.config[given[i].substr(0, equals)] = given[i].substr(equals + 1);
  }
  host.make_device = [&](const nlohmann::json& config) {
    return modbus_broken::make_broken_server(given[0], given[1], config);
  };
  return hosting::host_device(host);
}
