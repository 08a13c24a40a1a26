// Exchanges that are not judged: does anything answer, and how fast? They are made by the probe, a
// harmless request of the protocol that anything healthy answers. (`fieldproof probe`, which looks
// for the settings of an unknown device, sends it, too.)
#pragma once

#include <string>

#include "harness/exchange/channel.hpp"
#include "harness/exchange/timing.hpp"
#include "harness/exchange/visit.hpp"
#include "reports/results/response_times.hpp"

namespace fieldproof::exchange {

/// What comes of asking whether anything answers.
enum class Sign {
  alive,
  silent,
  endless,  // what comes does not end: it is no answer to anything
  refused,  // the connection: nothing listens there
  ended,    // the device took the connection and closed it without a word
  echo      // what was sent comes back, whatever comes behind it
};

/// What is wrong with a device that is not `alive`: "nothing answers any more".
std::string why_dead(Sign sign);

class Sanity {
 public:
  Sanity(Channel device, ExchangeTiming timing, Visit::Elsewhere elsewhere = {})
      : device_(device), timing_(timing), visit_(device, std::move(elsewhere)) {}

  /// Repeats the probe until `patience` is over; a device may be set to delay its replies. What
  /// answers is not judged. A protocol without a probe counts as alive. `starting`: nobody may
  /// listen yet, and a refused connection is tried again.
  Result<Sign> anything_answers(Duration patience, Duration reply_delay = {},
                                bool starting = false);

  /// The same at the start of a run, where a line that echoes is told from a device that answers:
  /// three probes have come back.
  Result<Sign> first_sign(Duration patience);

  /// How long answers to the probe take: so many, or fewer when `budget` is over first.
  Result<results::ResponseTimes> time_probes(int count, Duration budget);

 private:
  Status hear_answers(Time until, Time begun);
  Status before_probe(Time last);
  Result<std::optional<Duration>> time_probe(ByteView request, Time& last);
  Result<bool> comes_back(ByteView request, Time& last);
  std::size_t take_frames(Bytes& bytes) const;

  Channel device_;
  ExchangeTiming timing_;
  Visit visit_;
  Bytes heard_;                           // of frames that are not complete yet
  Bytes all_;                             // since the first probe, at most flood_limit and a burst
  std::size_t probes_ = 0, answers_ = 0;  // over the present connection
  bool endless_ = false;                  // what came to the last of them
};

/// Listens until the endpoint is silent for so long; no longer than `patience`, or a flood. Nothing
/// of it is judged. False: it is not silent then.
Result<bool> settle(endpoints::Endpoint& endpoint, Duration silence, Duration patience = 10s);

}  // namespace fieldproof::exchange
