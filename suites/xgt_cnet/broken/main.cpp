// xgt_cnet_broken_server: a device with a known fault on a terminal, in real time. For the tests of
// the suite, and for whoever writes a driver and wants to see it meet a bad device.
#include <fmt/format.h>
#include <filesystem>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "harness/hosting/device_host.hpp"
#include "src/xgt_cnet/plc_config.hpp"
#include "suites/xgt_cnet/broken/broken_server.hpp"

namespace {

using namespace fieldproof;

int usage() {
  fmt::print(stderr,
             "usage: xgt_cnet_broken_server FAULT TTY [STATION [STORAGE]]\n"
             "       xgt_cnet_broken_server --list\n"
             "FAULT    of the list; 'none' is a healthy device\n"
             "TTY      a terminal, or a path that becomes a link to a new pty\n"
             "STATION  0 to 255, 1 without\n"
             "STORAGE  a file for what a fault keeps where power is lost\n");
  return 2;
}

int list() {
  for (const xgt_cnet_broken::Fault& fault : xgt_cnet_broken::faults())
    fmt::print("{:<38} {}\n", fault.name, fault.what);
  return 0;
}

/// One frame a line, in hex.
xgt_cnet_broken::Storage storage_in(const std::string& path) {
  xgt_cnet_broken::Storage storage;
  if (path.empty()) return storage;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (std::optional<Bytes> frame = from_hex(line)) storage.frames.push_back(std::move(*frame));
  storage.save = [path](const std::vector<Bytes>& frames) {
    std::ofstream out(path);
    for (const Bytes& frame : frames) out << to_hex(frame) << '\n';
  };
  return storage;
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (given.size() == 1 && given[0] == "--list") return list();
  if (given.size() < 2 || given.size() > 4) return usage();
  xgt_cnet_broken::Storage storage = storage_in(given.size() > 3 ? given[3] : "");
  hosting::HostOptions host;
  host.model = "xbc-h";
  (std::filesystem::exists(given[1]) ? host.tty : host.pty) = given[1];
  host.config["station"] = given.size() > 2 ? given[2] : "1";
  host.make_device =
      [&](const nlohmann::json& config) -> Result<std::unique_ptr<plc::EmulatedDevice>> {
    const Result<plc::PortConfig> parsed =
        xgt_cnet::parse_plc_config(config.at("model").get<std::string>(), config);
    if (!parsed) return parsed.error();
    return xgt_cnet_broken::make_broken_plc(given[0], *parsed, storage);
  };
  return hosting::host_device(host);
}
