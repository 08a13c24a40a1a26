// Drives one endpoint through the steps of a case. Sends, listens and keeps time; judges nothing.
#pragma once

#include "harness/bench/memory_access.hpp"
#include "harness/bench/prepared_case.hpp"
#include "harness/bench/transcript.hpp"
#include "harness/endpoints/endpoint.hpp"
#include "harness/results/response_times.hpp"

namespace fieldproof {

struct ExchangeTiming {
  Duration response_max = 500ms;   // the profile's limit: request's last byte to reply's first
  Duration late_watch = 700ms;     // how much longer a late answer is waited for, so that it can be named
  Duration promised_silence = 1s;  // simulated time: each silence is waited out in full
  Duration quiet = 100ms;          // no further byte for so long: what is incomplete stays so
};

class Exchange {
 public:
  Exchange(Endpoint& endpoint, const Protocol& protocol, ExchangeTiming timing)
      : endpoint_(endpoint), protocol_(protocol), timing_(timing), memory_(endpoint, protocol, timing.response_max) {}

  /// Executes the steps. Stops early at trouble of the port, a flood, or when a set or check is refused.
  Transcript run(const PreparedCase& prepared);

  /// Listens to what still belongs to the case: in simulated time until the promised silence is over, in real time
  /// until a probe is answered, since replies come in order. A link that answers no probe is `dead`.
  void close(const PreparedCase& prepared, Transcript& transcript);

  /// Does anything answer? Repeats the probe until `patience` is over; a device may be set to delay its replies.
  /// What answers is not judged.
  Result<bool> anything_answers(int station, Duration patience, Duration reply_delay = {});

  /// How long answers to the probe take: so many, or fewer when `budget` is over first.
  Result<ResponseTimes> time_probes(int station, int count, Duration budget);

 private:
  void step(const PreparedCase& prepared, const PreparedStep& step, Transcript& transcript);
  void await_return(const PreparedCase& prepared, Transcript& transcript);
  void send(const PreparedStep& step, StepRecord& record, Transcript& transcript);
  void expect(const PreparedStep& step, StepRecord& record, Transcript& transcript);
  void silence(const PreparedCase& prepared, StepRecord& record, Transcript& transcript);
  void wait_until(Time moment, StepRecord& record, Transcript& transcript);
  void access_memory(const PreparedCase& prepared, const Step& step, StepRecord& record, Transcript& transcript);

  bool transmit(ByteView bytes, Transcript& transcript);
  /// Keeps the silence that a request needs before it where silence is what ends a frame.
  void await_frame_gap(Transcript& transcript);
  /// Waits for one burst into `pending_`; false when `deadline` passed, the port failed or the device floods.
  bool listen(Time deadline, Transcript& transcript);
  std::size_t complete_length(const PreparedStep& step);
  std::size_t take_frames(Bytes& bytes) const;
  /// Sends a probe and takes out what came before its reply; false when no reply to the probe came.
  bool probe(const PreparedCase& prepared, Received& before, Transcript& transcript);
  void note(std::string text, Transcript& transcript);

  Endpoint& endpoint_;
  const Protocol& protocol_;
  ExchangeTiming timing_;
  MemoryAccess memory_;
  Received pending_;  // came, but no step has taken it
  Sent last_sent_;
  Time last_heard_{};
  bool neighbours_ = false;  // further stations hear all that is said
  Time stimulus_{};   // what the next reply answers: a transmission, the reply before it, a set or do
  Bytes last_bytes_;
  Captures captures_;
};

}  // namespace fieldproof
