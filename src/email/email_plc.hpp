// E-mail on an emulated XGB PLC with an Ethernet module (FEnet EN 7.4).
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/base/result.hpp"
#include "src/plc/plc.hpp"

namespace fieldproof::email {

/// Adds the service where `p2p` of `config` (given.config of a vector, vectors/README.md) has
/// `email`, beside the P2P channels, which are added by others. Errors name the key, or the block
/// and its key.
Status add_email(plc::Plc& plc, const nlohmann::json& config);

/// A PLC in its power-on state that has this service alone; without `p2p` it mails nothing. Errors
/// also name the model, and blocks that ask over a P2P channel.
Result<std::unique_ptr<plc::EmulatedDevice>> make_email_plc(std::string_view model,
                                                            const nlohmann::json& config);

}  // namespace fieldproof::email
