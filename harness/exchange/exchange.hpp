// Drives one endpoint through the steps of a case. Sends, listens and keeps time; judges nothing.
#pragma once

#include "harness/endpoints/endpoint.hpp"
#include "harness/exchange/memory_access.hpp"
#include "harness/exchange/partner.hpp"
#include "harness/exchange/prepared_case.hpp"
#include "harness/exchange/transcript.hpp"
#include "reports/results/response_times.hpp"

namespace fieldproof::exchange {

struct ExchangeTiming {
  Duration response_max = 500ms;  // the profile's limit: request's last byte to reply's first
  Duration late_watch =
      700ms;  // how much longer a late answer is waited for, so that it can be named
  Duration promised_silence = 1s;  // simulated time: each silence is waited out in full
  Duration quiet = 100ms;          // no further byte for so long: what is incomplete stays so
};

class Exchange {
 public:
  Exchange(endpoints::Endpoint& endpoint, const harness::Protocol& protocol, ExchangeTiming timing,
           AuxLink aux = {}, Arming* arming = nullptr)
      : endpoint_(endpoint),
        protocol_(protocol),
        timing_(timing),
        memory_(endpoint, protocol, timing.response_max, aux, arming) {}

  /// Executes the steps. Stops early at trouble of the port, a flood, or when a set or check is
  /// refused.
  Transcript run(const PreparedCase& prepared);

  /// Listens to what still belongs to the case: in simulated time until the promised silence is
  /// over, in real time until a probe is answered, since replies come in order. A link that answers
  /// no probe is `dead`.
  void close(const PreparedCase& prepared, Transcript& transcript);

  /// Does anything answer? Repeats the probe until `patience` is over; a device may be set to delay
  /// its replies. What answers is not judged.
  Result<bool> anything_answers(int station, Duration patience, Duration reply_delay = {});

  /// Client role: does the device ask? Does what the case does before it expects the first request,
  /// and listens until `patience` is over; then until the device has given up, so that the next
  /// case begins in silence.
  Result<bool> anything_is_asked(const PreparedCase& prepared, Duration patience);
  /// Client role: listens until the line is silent for so long; at most ten seconds. Nothing of it
  /// is judged.
  Status settle(Duration silence);
  /// How long answers to the probe take: so many, or fewer when `budget` is over first.
  Result<results::ResponseTimes> time_probes(int station, int count, Duration budget);

 private:
  void step(const PreparedCase& prepared, const PreparedStep& step, Transcript& transcript);
  void await_return(const PreparedCase& prepared, Transcript& transcript);
  void send(const PreparedStep& step, StepRecord& record, Transcript& transcript);
  void await_frame(const PreparedStep& step, StepRecord& record, Transcript& transcript);
  /// Answers the request that an `expect` has just taken, else the next one, whatever it asks.
  void partner(const PreparedCase& prepared, const PreparedStep& step, StepRecord& record,
               Transcript& transcript);
  void answer(const PreparedCase& prepared, const vectors::PartnerSpec& spec, StepRecord& record,
              Transcript& transcript);
  void silence(const PreparedCase& prepared, StepRecord& record, Transcript& transcript);
  void wait_until(Time moment, StepRecord& record, Transcript& transcript);
  void access_memory(const PreparedCase& prepared, const vectors::Step& step, StepRecord& record,
                     Transcript& transcript);

  bool transmit(ByteView bytes, Transcript& transcript);
  /// Keeps the silence that a request needs before it where silence is what ends a frame.
  void await_frame_gap(Transcript& transcript);
  /// Waits for one burst into `pending_`; false when `deadline` passed, the port failed or the
  /// device floods.
  bool listen(Time deadline, Transcript& transcript);
  std::size_t complete_length(const PreparedStep& step);
  std::size_t take_frames(Bytes& bytes) const;
  /// Sends a probe and takes out what came before its reply; false when no reply to the probe came.
  bool probe(const PreparedCase& prepared, Received& before, Transcript& transcript);
  void note(std::string text, Transcript& transcript);

  endpoints::Endpoint& endpoint_;
  const harness::Protocol& protocol_;
  ExchangeTiming timing_;
  MemoryAccess memory_;
  Received pending_;  // came, but no step has taken it
  Sent last_sent_;
  Time last_heard_{};
  bool neighbours_ = false;  // further stations hear all that is said
  Time
      stimulus_{};  // what the next reply answers: a transmission, the reply before it, a set or do
  Bytes last_bytes_;
  notation::Captures captures_;
  std::optional<Partner> partner_;  // of this case
  Burst request_;                   // of the client, taken by `expect` and not answered yet
};

}  // namespace fieldproof::exchange
