// ls_bus_broken_server: an inverter with a known fault on a terminal, in real time. For the tests
// of the suite, and for whoever writes a client and wants to see it meet a bad inverter.
#include <fmt/format.h>
#include <filesystem>

#include <cstdio>
#include <string>
#include <vector>

#include "harness/hosting/device_host.hpp"
#include "suites/ls_bus/broken/broken_inverter.hpp"
#include "suites/ls_bus/broken/faults.hpp"

namespace {

using namespace fieldproof;

int usage() {
  fmt::print(stderr,
             "usage: ls_bus_broken_server FAULT TTY [STATION]\n"
             "       ls_bus_broken_server --list\n"
             "FAULT    of the list; 'none' is a healthy inverter\n"
             "TTY      a terminal, or a path that becomes a link to a new pty\n"
             "STATION  0 to 255, 1 without\n");
  return 2;
}

int list() {
  for (const auto* table : {&ls_bus_broken::faults(), &ls_bus_broken::back_door_faults()})
    for (const ls_bus_broken::Fault& fault : *table)
      fmt::print("{:<32} {}\n", fault.name, fault.what);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (given.size() == 1 && given[0] == "--list") return list();
  if (given.size() < 2 || given.size() > 3) return usage();
  hosting::HostOptions host;
  (std::filesystem::exists(given[1]) ? host.tty : host.pty) = given[1];
  host.config["station"] = given.size() > 2 ? given[2] : "1";
  host.make_device = [&](const nlohmann::json& config) {
    return ls_bus_broken::make_broken_inverter(given[0], config);
  };
  return hosting::host_device(host);
}
