// How a driver handed over before a run told it otherwise, for whoever opens the port after a run
// that was killed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace fieldproof::endpoints {

/// Of what a driver has not, nothing.
struct LatencyBefore {
  std::optional<bool> low_latency;
  std::optional<long> trigger, timer;
};

/// A file of the user's, named by the port, for as long as a run has told its driver otherwise. It
/// is of one start of the system: another has the driver's own values again.
class LatencyNote {
 public:
  /// Without a folder nothing is kept.
  LatencyNote(const std::filesystem::path& folder, const std::string& port);

  /// Nothing is known: all empty.
  LatencyBefore read() const;
  void keep(const LatencyBefore& before) const;
  void drop() const;

 private:
  std::filesystem::path file_;
};

}  // namespace fieldproof::endpoints
