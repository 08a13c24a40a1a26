// An XGT FEnet server with one known fault, so that the suite can be shown to find it.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "suites/xgt_fenet/broken/faults.hpp"

namespace fieldproof::xgt_fenet_broken {

/// `config` as of an XGT FEnet server. Errors name the model or the parameter.
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_server(const Behaviour& behaviour,
                                                                std::string_view model,
                                                                const nlohmann::json& config);

}  // namespace fieldproof::xgt_fenet_broken
