// `emulate MODEL --p2p FILE.json`: the P2P parameters of an emulated client.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "harness/hosting/device_host.hpp"

namespace fieldproof::cli {

/// The configuration in a file, as in `given.config` (vectors/README.md); its role is client.
/// Errors name the file.
Result<nlohmann::json> read_p2p_file(const std::string& path);

/// The same factory, whose errors name the file.
hosting::HostedFactory naming_file(hosting::HostedFactory make_device, std::string path);

}  // namespace fieldproof::cli
