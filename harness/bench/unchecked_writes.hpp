// Writes by requests without a check, over a line: one that was damaged on its way may be
// acknowledged all the same, and have changed another word than it names. Nobody can tell which.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/protocol.hpp"
#include "harness/safety/saved_memory.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::bench {

class UncheckedWrites {
 public:
  /// Those of a case (writes_without_check), in its order. Notes what the places hold that they
  /// name; but for those that the case itself `changes` by other means (the bench sets them, the
  /// power goes), where nothing shows.
  void before(const std::vector<Bytes>& requests,
              const std::vector<harness::Protocol::Written>& changes,
              const harness::Protocol& protocol, safety::SavedMemory& memory);
  /// Looks whether what the device has not refused stands where it belongs. `cut_off`: the port
  /// failed, so that there was no answer to hear.
  void after(const results::CaseResult& result, const harness::Protocol& protocol,
             safety::SavedMemory& memory, bool cut_off);

  /// Those that may have changed another word; empty: none. `bad_line`: it has damaged what it
  /// carried, so that also those count whose place would have looked the same without them.
  std::string doubtful(bool bad_line) const;

 private:
  using Place = std::pair<std::string, std::string>;  // address and digits
  struct Write {
    Bytes request;
    std::vector<Place> sets;
    bool shows = true;  // the places held something else before
  };

  using Due = std::map<std::string, std::string>;  // digits by address
  static bool is_lost(Write& write, const Due& due, safety::SavedMemory& memory);

  std::vector<Write> writes_;               // of the present case
  std::vector<std::string> lost_, unseen_;  // frames, with the case
};

/// Nothing tells a device that this write was damaged: it has no check, or a wrong one.
bool writes_without_check(ByteView request, const harness::Protocol& protocol);

}  // namespace fieldproof::bench
