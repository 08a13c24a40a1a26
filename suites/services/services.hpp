// Further services of the PLC under test: what stands in "services" of given.config
// (vectors/README.md).
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "src/base/result.hpp"
#include "src/plc/plc.hpp"

namespace fieldproof::services {

/// Puts the service that a case is about on the PLC.
using AddMain = std::function<Status(plc::Plc& plc, const nlohmann::json& config)>;

/// Are there any?
bool wants_services(const nlohmann::json& config);

/// A PLC in its power-on state with the service that `add` adds, which is told nothing of
/// "services", and with those of "services" of `config`: an object of protocol and configuration.
/// One on a serial line gets channel 2, one on a network the port of its protocol. Errors name the
/// model, the key or the service.
Result<std::unique_ptr<plc::EmulatedDevice>> make_plc(std::string_view model,
                                                      const nlohmann::json& config,
                                                      const AddMain& add);

}  // namespace fieldproof::services
