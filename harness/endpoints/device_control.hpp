// The back door of an emulator in another process: one JSON object a line asks, one answers.
//
//   {"begin": {"station": 1, ...}}                    a fresh device with this configuration
//   {"set": {"address": "%MW100", "hex": "1234"}}
//   {"get": {"address": "%MW100", "digits": 4}}       -> {"ok": true, "value": "1234"}
//   {"act": "power_cycle"}
//   -> {"ok": true} or {"error": "why"}
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::endpoints {

/// The answer line (with its newline) to one request line; `begin` makes the fresh device, `device`
/// gives the present one (nullptr: none yet).
std::string answer_control(std::string_view line,
                           const std::function<Status(const nlohmann::json& config)>& begin,
                           const std::function<plc::EmulatedDevice*()>& device);

/// A request as a line.
std::string control_line(const nlohmann::json& request);

/// "value" of an answer line (empty where there is none), or its error.
Result<std::string> read_control_answer(std::string_view line);

}  // namespace fieldproof::endpoints
