// `emulate MODEL --config FILE.json`: what is set up in an emulated device; `--p2p FILE.json`: the
// P2P parameters of an emulated client.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "harness/hosting/device_host.hpp"

namespace fieldproof::cli {

/// The configuration in a file, as in `given.config` (vectors/README.md). Errors name the file.
Result<nlohmann::json> read_config_file(const std::string& path);
/// The same of a client.
Result<nlohmann::json> read_p2p_file(const std::string& path);

/// The same factory, whose errors name the file.
hosting::HostedFactory naming_file(hosting::HostedFactory make_device, std::string path);

}  // namespace fieldproof::cli
