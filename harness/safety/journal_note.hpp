// Which journal has what a real device held, whatever folder its run wrote to.
#pragma once

#include <filesystem>
#include <string>

#include "harness/safety/journal.hpp"

namespace fieldproof::safety {

/// A link to the journal, one a device, in the user's state folder (fieldproof/journals in
/// XDG_STATE_HOME, else in ~/.local/state), for as long as a run may have left something open. So a
/// run with another --out finds it. Without a home there is none.
class JournalNote {
 public:
  explicit JournalNote(const JournalDevice& device);

  /// The journal, as an absolute path; empty: nothing is noted.
  std::string journal() const;
  void keep(const std::string& journal) const;
  /// Nothing is open in this journal; a note of another stays.
  void drop(const std::string& journal) const;
  /// The same of all devices.
  static void drop_all(const std::string& journal);

 private:
  std::filesystem::path link_;  // empty: there is no place
};

}  // namespace fieldproof::safety
