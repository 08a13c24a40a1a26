// The back door of an emulator in another process: the lines of --control (suites/example), and
// more.
//
//   {"begin": {"station": 1, ...}}        a fresh device with this configuration
//   {"config": {"delay_ms": 10}}          a fresh one with the present configuration changed so
//   {"set": {"%MW100": "1234"}}
//   {"get": ["%MW100"]}, or with digits {"get": {"%MW100": 8}}   -> {"values": {"%MW100": "1234"}}
//   {"do": "power_cycle"}
//   -> {"ok": true} or {"error": "why"}
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::endpoints {

struct ControlledDevice {
  std::function<Status(const nlohmann::json& config)> begin;   // makes the fresh device
  std::function<Status(const nlohmann::json& change)> config;  // the same, with this changed
  std::function<plc::EmulatedDevice*()> device;                // the present one; nullptr: none yet
};

/// The answer line (with its newline) to one request line.
std::string answer_control(std::string_view line, const ControlledDevice& device);

/// A request as a line.
std::string control_line(const nlohmann::json& request);

/// The values of an answer line (none: an empty object), or its error.
Result<nlohmann::json> read_control_answer(std::string_view line);

}  // namespace fieldproof::endpoints
