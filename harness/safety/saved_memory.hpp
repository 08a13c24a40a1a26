// Puts back what a case writes on a real device: reads before, keeps a journal, writes back after,
// and reads again.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/safety/journal.hpp"
#include "harness/safety/sure_access.hpp"

namespace fieldproof::safety {

class SavedMemory {
 public:
  /// `device` is what the journal says of it. Without a journal nothing may be written.
  SavedMemory(endpoints::Endpoint& endpoint, const harness::Protocol& protocol, Duration patience,
              JournalDevice device, std::shared_ptr<Journal> journal)
      : protocol_(protocol),
        memory_({&endpoint, &protocol, device.station}, patience),
        device_(std::move(device)),
        journal_(std::move(journal)) {}

  /// Before a case: each place that is not known from an earlier case is read surely, and all are
  /// on the disk when this returns. Errors say why the case must not write; what could be read is
  /// in the journal then, too.
  Status save(const std::vector<harness::Protocol::Written>& written);
  /// Of the last `restore` that has left something.
  const Error& failure() const { return why_; }
  /// The last error, of `save` or `restore`, was of the port, not of the device.
  bool port_failed() const { return failure_ == Reading::Kind::port; }
  /// It is that the device did not answer, or without an end.
  bool lost() const {
    return failure_ == Reading::Kind::unanswered || failure_ == Reading::Kind::endless;
  }
  /// It is that no sound answer came.
  bool unserved() const { return lost() || failure_ == Reading::Kind::unsure; }
  /// What a place holds now (SureAccess::look).
  Reading look(const std::string& address, std::size_t digits) {
    return memory_.look(address, digits);
  }
  /// SureAccess::damaged.
  unsigned damaged() const { return memory_.damaged(); }

  /// After it: what has changed is put back, the latest first. Empty, or what could not be, and
  /// why.
  std::string restore();
  /// What is not put back: "%MW100 = 00E2, %MW101 = 0000".
  std::string open_places() const;
  /// Puts back one entry of a journal, and reads it again. Errors say what it holds instead.
  Status put_back(const OpenEntry& entry);

 private:
  using Key = std::pair<std::string, std::size_t>;  // address and digits
  Reading read(const harness::Protocol::Place& place);
  std::vector<harness::Protocol::Place> words_of(const std::string& address,
                                                 std::size_t digits) const;
  Reading word_by_word(const harness::Protocol::Place& place);
  Status write(const OpenEntry& entry, const std::string& holds);
  bool is_open(const Key& key) const;

  const harness::Protocol& protocol_;
  SureAccess memory_;
  JournalDevice device_;
  std::shared_ptr<Journal> journal_;
  Reading::Kind failure_ = Reading::Kind::digits;  // of the last save or put_back
  Error why_;                                      // of the last restore
  std::map<Key, std::string>
      known_;  // what places held when this run first came to them; empty: no such memory
};

/// `written` without overlaps, and joined where words are adjacent; what nobody can tell is left
/// out.
std::vector<harness::Protocol::Written> joined(std::vector<harness::Protocol::Written> written);

}  // namespace fieldproof::safety
