// What an axis moves: a servo drive on the motion bus, and switches along its way, as a test sets
// them up. Positions are in pulses of the axis as it stood at power-on.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"

namespace fieldproof::xnet {

/// A switch at an input X, numbered as SFD3034 to SFD3037 do: on from `from` to `to`.
struct Switch {
  unsigned terminal = 0;
  double from = 0, to = 0;
};

/// What a servo counts of the bus (2-6-2, U0-61 to U0-68). What the manual is silent about:
/// DECISIONS.md xnet/servo-counters.
class BusCounters {
 public:
  /// Each of the next so many refresh periods has an error of this kind: "sync", "data", "crc",
  /// "uart". False: there is no such kind.
  bool expect(std::string_view kind, unsigned periods);
  /// One refresh period. `retries`: P7-06.
  void refresh(unsigned retries);
  /// An error was in the last period, or will be in the next one.
  bool is_disturbed() const { return periods_ > 0 || in_a_row_ > 0; }
  /// "Initial status": it waits for the synchronizing frame.
  bool is_lost() const { return lost_; }
  /// "U0-62". Nothing: it counts no such thing.
  std::optional<unsigned> get(std::string_view name) const;

 private:
  unsigned all_ = 0, overtimes_ = 0;
  std::array<unsigned, 4> of_kind_{};
  std::size_t kind_ = 0;
  unsigned periods_ = 0, in_a_row_ = 0;
  bool lost_ = false;
};

struct Servo {
  unsigned axis = 1;
  std::map<std::string, int> parameters;  // "P0-01": as 2-6-2 sets them for this axis
  std::vector<Switch> switches;
  double z_phase = 0;       // where the first Z of the encoder is; one in each turn
  double start = 0;         // where it stands
  double rated_torque = 1;  // N.m
  BusCounters counters;
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
