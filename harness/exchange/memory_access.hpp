// Memory of the device under test, by the best way there is: the back door of an emulator, the
// protocol itself (a device that asks answers nothing), a second channel of the same PLC.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "harness/exchange/arming.hpp"
#include "harness/exchange/channel.hpp"
#include "harness/exchange/memory_runs.hpp"
#include "harness/exchange/prepared_case.hpp"
#include "harness/exchange/visit.hpp"

namespace fieldproof::exchange {

/// "B:D0" is memory of a partner of the device, which is asked over the second channel.
struct PlaceName {
  std::string_view partner;  // "B"; empty: of the device itself
  std::string_view address;
};
PlaceName place_name(std::string_view address);

/// How the message of a case begins whose set-up the device did not take.
inline constexpr std::string_view set_up_failure = "set-up: ";
/// What came to a request goes on for longer than the longest frame.
inline constexpr std::string_view without_end = "the reply does not end";

class MemoryAccess {
 public:
  /// `aux`: a second channel of the PLC under test, as server. `arming` may be nullptr: then sets
  /// ask for nothing. `elsewhere`: Visit.
  MemoryAccess(Channel device, Duration patience, Channel aux = {}, Arming* arming = nullptr,
               Visit::Elsewhere elsewhere = {});

  /// Errors name the address and the reason; `refused()` then tells whether the device itself
  /// refused. Memory of a real client that nobody can set is left: the bench has seen that the line
  /// does not depend on it (Arming::objection).
  Status set(const PreparedCase& prepared, const std::string& address, const std::string& hex);
  /// The same for words that follow each other: one by one where the device refuses them in one.
  Status set(const PreparedCase& prepared, MemoryRun run);
  /// These values in order, what can be asked for at once in one.
  std::vector<MemoryRun> runs(const PreparedCase& prepared, const MemoryValues& values) const;
  Result<std::string> get(const PreparedCase& prepared, const std::string& address,
                          std::size_t digits);
  /// The error says that the PLC of this address is none that the bench reaches.
  Status partner_of(const std::string& address) const;
  /// Is there a way to read it? Of a real client only over a second channel, and no counters.
  bool can_read(const PreparedCase& prepared, const std::string& address) const;
  /// The last error came from the device (a NAK, no answer), not from a way that does not exist.
  bool refused() const { return refused_; }
  /// The last request got no sound answer, not even a refusal.
  bool unserved() const { return unserved_; }
  /// The last request was not answered at all, or without an end.
  bool lost() const { return silent_ || endless_; }

  /// The last request over the wire, and what came to it, for reports.
  std::string said() const;

  /// What comes back to a request over the wire, as far as it came in time; empty: nothing.
  Result<Bytes> ask(ByteView request) { return ask(device_, request); }

  /// Requests go over this link of a case, on a network, until leave().
  void borrow(LinkId link) { visit_.borrow(link); }
  /// After the last request for now: closes what was opened for them.
  void leave();

 private:
  Channel own(const PreparedCase& prepared) const {
    return {device_.endpoint, device_.protocol, prepared.station};
  }
  Status write(const Channel& server, const std::string& address, const std::string& hex);
  Result<std::string> read(const Channel& server, const std::string& address, std::size_t digits);
  Result<Bytes> ask(const Channel& server, ByteView request);
  Result<Bytes> ask_again(const Channel& server, ByteView request);
  Result<Bytes> set_again(const Channel& server, ByteView request);
  Result<Bytes> sound(const Channel& server, ByteView request, Result<Bytes> reply);
  Result<Bytes> ask_in_any_mode(const Channel& server, ByteView request,
                                const std::function<bool(ByteView)>& taken);
  Result<Channel> partner(const PlaceName& name) const;
  Visit& visit_of(const Channel& server);
  Status let_pass(const Channel& server, Duration silence);
  std::string why(const Error& error) const;

  Channel device_;
  Duration patience_;
  Channel aux_;
  Arming* arming_;
  Visit visit_;
  std::optional<Visit> aux_visit_;
  bool refused_ = false, unserved_ = false;
  bool silent_ = false, endless_ = false;
  bool mute_ = false;     // it was silent, and was so when it was asked again
  bool unsound_ = false;  // what the device answers does not become sound by asking again
  Bytes asked_, answered_;
};

/// Leaves at the end of a scope.
class Leaving {
 public:
  explicit Leaving(MemoryAccess& memory) : memory_(memory) {}
  ~Leaving() { memory_.leave(); }
  Leaving(const Leaving&) = delete;
  Leaving& operator=(const Leaving&) = delete;

 private:
  MemoryAccess& memory_;
};

}  // namespace fieldproof::exchange
