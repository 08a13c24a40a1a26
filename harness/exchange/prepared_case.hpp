// A case made concrete for the station it runs against: templates instead of notation.
#pragma once

#include <string>
#include <vector>

#include "harness/exchange/channel.hpp"
#include "harness/notation/frame_template.hpp"
#include "harness/protocols.hpp"
#include "harness/vectors/case.hpp"

namespace fieldproof::exchange {

struct PreparedFrame {
  std::string alternative;  // its name; empty where there is one frame alone
  const vectors::Frame* source = nullptr;
  notation::FrameTemplate frame;
};

struct PreparedStep {
  const vectors::Step* step = nullptr;
  std::vector<PreparedFrame> frames;  // send: one; expect: every alternative, the preferred first
  std::string link;                   // that it uses, opens or closes
  const harness::Protocol* protocol = nullptr;  // spoken there, at this station
  int station = 1;
  std::uint16_t port = 0;    // open: where the device listens
  bool network = false;      // the link is no line
  bool passed_over = false;  // check: at a moment that the endpoint cannot keep; not judged
};

/// Points into the Case, which must outlive it.
struct PreparedCase {
  const vectors::Case* source = nullptr;
  int station = 1;
  bool has_probe = true;       // the protocol has a request that anything healthy answers
  bool implicit_link = false;  // the bench opens one at the beginning
  Duration reply_delay{};      // configured for every reply (delay_ms), of RS-485 alone
  std::vector<PreparedStep> steps;
  std::string stimulus;  // a hash of all that is done to the device

  bool is_client() const;  // the module asks, the bench answers
  /// A block asks at the pace of a clock: there is always one more request.
  bool runs_by_clock() const;
  /// A device that asks, whose line settings differ from the bench's, or that lets nobody in,
  /// answers no probe.
  bool answers_probes() const;
  /// Its host table leaves the bench out: nothing it says is answered.
  bool is_shut_out() const;
  /// What the client under test waits for an answer (client_program.hpp).
  Duration client_time_out() const;
  /// How long what it has asked last may disturb the next case: on a line until its time-out; on a
  /// network a late answer belongs to a connection and has a number, so no longer than on a line.
  Duration client_settles() const;
  /// How long after its stimulus the first byte of an expected frame may come: what the step says,
  /// or the time that the device needs behind its delay.
  Duration reply_limit(const vectors::Step& step, Duration response_max) const;
  bool expects_requests() const;  // in the partner's chair: an expect or partner step
  bool listens_for_silence() const;
  bool looks_at_counters() const;  // a check of @status, @errors or @services
  /// It looks at them before anything was sent, after a restart, or after memory that is reached by
  /// requests, which would count what the bench itself has asked: they are to count from power-on.
  bool counts_from_power_on() const;
  /// Requests of the bench's own would not be answered, or would be counted: what it sets and looks
  /// at goes past the wire, where there is a way.
  bool goes_past_the_wire() const { return is_shut_out() || counts_from_power_on(); }
  /// Behind a loss of power it looks for what was there before: a program that is started again has
  /// forgotten it.
  bool looks_for_what_is_kept() const;
  /// The shortest pause or wait, or 0 when there is none.
  Duration shortest_pause(Duration character_time) const;
};

/// A number of a configuration, which may be given as text.
int number_of(const nlohmann::json& config, const char* key, int fallback);

/// What else of the same device a case may speak to.
struct OtherWays {
  harness::Protocols known{{}};  // for services that a case opens
  Channel aux{};
};

/// Errors name the step.
Result<PreparedCase> prepare(const vectors::Case& source, int station,
                             const harness::Protocol& protocol, const OtherWays& others = {});

}  // namespace fieldproof::exchange
