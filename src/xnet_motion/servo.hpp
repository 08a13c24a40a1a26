// What an axis moves: a servo drive on the motion bus, and switches along its way, as a test sets
// them up. Positions are in pulses of the axis as it stood at power-on.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "src/base/result.hpp"

namespace fieldproof::xnet {

/// A switch at an input X, numbered as SFD3034 to SFD3037 do: on from `from` to `to`.
struct Switch {
  unsigned terminal = 0;
  double from = 0, to = 0;
};

struct Servo {
  unsigned axis = 1;
  std::map<std::string, int> parameters;  // "P0-01": as 2-6-2 sets them for this axis
  std::vector<Switch> switches;
  double z_phase = 0;       // where the first Z of the encoder is; one in each turn
  double start = 0;         // where it stands
  double rated_torque = 1;  // N.m
  bool connected = true, alarm = false, clearable = true, stalled = false, enabled_by_hand = false;

  int parameter(const std::string& name) const;
};

/// {"axis": 1, "P7-02": 2, "switches": {"X4": [-40000, -30000]}, "z": 300, "start": -20000, ...},
/// parameters in a form of their own: "P7-01": 8723 or "0x2213". Errors name the key.
Result<Servo> read_servo(const nlohmann::json& config);

/// Is the drive set up so that the bus finds it (2-6-2)? `slaves`, `refresh_us`: SFD2991, SFD2990.
/// The error says which parameter is wrong.
Status check_servo(const Servo& servo, unsigned slaves, unsigned refresh_us);

}  // namespace fieldproof::xnet
