// Memory of a real device over a line that may be bad: what is read here is written back later, so
// nothing counts that is not sure.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/exchange/memory_access.hpp"

namespace fieldproof::safety {

/// What came of asking for a place.
struct Reading {
  enum class Kind {
    digits,      // sure
    refused,     // by the device, twice
    no_request,  // of the protocol reads it
    unanswered,  // not a byte, again and again
    endless,     // what came did not end
    unsure,      // damaged again and again, or never twice the same
    port         // the port failed
  };
  Kind kind = Kind::unsure;
  std::string digits;
  Error why;  // of what is not sure
};

class SureAccess {
 public:
  /// `patience`: until the answer begins. Only a device that the bench starts itself, and that
  /// forgets all with its process, may be asked without checks where it cannot be asked with them.
  SureAccess(exchange::Channel device, Duration patience);

  /// Two sound answers in a row that agree; between what is not sound, or does not agree, the line
  /// gets time to become silent. A reply is sound when its check is right and it answers that
  /// request (Protocol::sound_reply).
  Reading read(const std::string& address, std::size_t digits);
  /// One sound answer, where answers carry a check: to compare with what was read surely.
  Reading look(const std::string& address, std::size_t digits);
  /// Asks until a sound answer says that it is done. An error that is not `refused()`: nobody
  /// knows whether it is.
  Status write(const std::string& address, const std::string& hex);
  /// The last error of write() came from the device, soundly.
  bool refused() const { return refused_; }

  /// Answers that were damaged or lost, and sound when they were asked for again: the line is bad.
  unsigned damaged() const { return damaged_; }

  /// After the last request for now (MemoryAccess::leave).
  void leave() { memory_.leave(); }

 private:
  using Requests = std::vector<Bytes>;
  Reading once(const Requests& requests, std::size_t digits);
  void ask_without_checks(const Requests& checked, std::size_t digits, Reading& reading);
  Reading until_sure(const std::string& address, std::size_t digits, bool twice);
  Reading ask(const Requests& requests, std::size_t digits, bool twice);
  Status write_one(const std::string& address, ByteView request);
  bool settle();

  exchange::Channel device_;
  exchange::MemoryAccess memory_;
  bool may_go_unchecked_;
  bool unchecked_ = false;  // asking with checks has not led to anything
  bool answers_ = false;    // there was a sound answer to a request with a check
  bool hopeless_ = false;   // the last place could not be read in all attempts
  bool refused_ = false;
  unsigned damaged_ = 0;
};

}  // namespace fieldproof::safety
