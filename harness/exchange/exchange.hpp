// Drives one endpoint through the steps of a case. Sends, listens and keeps time; judges nothing.
#pragma once

#include "harness/exchange/others.hpp"
#include "harness/exchange/prepared_case.hpp"
#include "harness/exchange/sanity.hpp"
#include "harness/exchange/transcript.hpp"

namespace fieldproof::exchange {

class Arming;

/// Refers to all that it is given.
class Exchange {
 public:
  Exchange(endpoints::Endpoint& endpoint, const harness::Protocol& protocol, ExchangeTiming timing,
           Channel aux = {}, Arming* arming = nullptr)
      : device_{&endpoint, &protocol, 1}, timing_(timing), aux_(aux), arming_(arming) {}

  /// The steps of a case and its end (CaseRun).
  Transcript run(const PreparedCase& prepared);
  /// The steps alone, for benchmarks: what comes late is not heard.
  Transcript run_steps(const PreparedCase& prepared);

  /// Sanity::anything_answers at this station.
  Result<Sign> anything_answers(int station, Duration patience, Duration reply_delay = {},
                                bool starting = false);
  /// Sanity::first_sign at this station.
  Result<Sign> first_sign(int station, Duration patience);
  /// Client role: does the device ask? Does what the case does before it expects the first request,
  /// and listens until `patience` is over; then until the device has given up, so that the next
  /// case begins in silence.
  Result<bool> anything_is_asked(const PreparedCase& prepared, Duration patience);
  /// Client role: listens until the device is silent for so long; at most ten seconds. Nothing of
  /// it is judged.
  Status settle(Duration silence) {
    const Result<bool> silent = exchange::settle(*device_.endpoint, silence);
    return silent ? ok() : Status(silent.error());
  }
  /// What somebody else has asked for: unasked_bytes() at this station.
  Result<Bytes> unasked_bytes(int station, Duration watch) {
    return exchange::unasked_bytes(at(station), watch, timing_);
  }
  /// How long answers to the probe take: so many, or fewer when `budget` is over first.
  Result<results::ResponseTimes> time_probes(int station, int count, Duration budget);

 private:
  Channel at(int station) const { return {device_.endpoint, device_.protocol, station}; }

  Channel device_;
  ExchangeTiming timing_;
  Channel aux_;
  Arming* arming_;
};

}  // namespace fieldproof::exchange
