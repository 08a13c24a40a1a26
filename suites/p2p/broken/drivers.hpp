// The good P2P drivers by protocol, as suites/*/protocol.cpp puts them into its client.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/p2p/driver.hpp"
#include "src/p2p/parameters.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof::p2p_broken {

/// `model` names the user frames where `definition` does not. Errors are those of the protocol's
/// configuration.
Result<std::unique_ptr<p2p::P2pDriver>> make_driver(std::string_view protocol,
                                                    const plc::PortConfig& port,
                                                    const nlohmann::json& config,
                                                    std::string_view model,
                                                    const p2p::P2pParameters& parameters);

}  // namespace fieldproof::p2p_broken
