// One case on its way: its steps, in order, over its links.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "harness/exchange/links.hpp"
#include "harness/exchange/memory_access.hpp"
#include "harness/exchange/partner.hpp"
#include "harness/exchange/prepared_case.hpp"
#include "harness/exchange/sanity.hpp"

namespace fieldproof::exchange {

/// What a case runs against. Nothing is owned.
struct Surroundings {
  Channel device;
  ExchangeTiming timing;
  Channel aux;               // a second channel of the same PLC
  Arming* arming = nullptr;  // what makes a real client ask
};

class CaseRun {
 public:
  /// Both outlive it. Opens the implicit link, where the case has one.
  CaseRun(const Surroundings& around, const PreparedCase& prepared);
  CaseRun(const CaseRun&) = delete;
  CaseRun& operator=(const CaseRun&) = delete;

  /// Executes the steps. Stops early at trouble of the port, a flood, or when a step is refused.
  void execute();
  /// Listens to what still belongs to the case: in simulated time until the promised silence is
  /// over, in real time until a probe is answered, since replies come in order. A device that
  /// answers no probe is `dead`. Closes what is open.
  void finish();
  /// Client role: does what the case does before it expects the first request. Does one come?
  /// Closes what is open.
  Result<bool> is_asked(Duration patience);

  Transcript take() { return std::move(transcript_); }

 private:
  void begin();
  bool is_missing(const PreparedStep& step);
  void step(const PreparedStep& step);
  bool stopped() const { return transcript_.trouble || transcript_.flooded; }
  StepRecord& record() { return transcript_.steps.back(); }
  int index() const { return static_cast<int>(transcript_.steps.size()) - 1; }
  Time now() const { return around_.device.endpoint->now(); }
  const endpoints::Capabilities& can() const { return around_.device.endpoint->capabilities(); }

  void send(const PreparedStep& step);
  bool send_pieces(Link& link, const notation::FrameTemplate& frame, ByteView bytes);
  /// Keeps the silence that a request needs before it where silence is what ends a frame.
  void await_frame_gap(const Link& link);
  void await_frame(const PreparedStep& step);
  void take_frame(Link& link, std::optional<std::size_t> length);
  std::optional<std::size_t> complete(const PreparedStep& step, const Link& link);
  /// Answers the request that an `expect` has just taken, else the next one, whatever it asks.
  void partner(const PreparedStep& step);
  void answer(const PreparedStep& step);
  void silence(const PreparedStep& step);
  bool goes_on(const PreparedStep& silence, const Link& link) const;
  void repeat_behind_lost_probe(Link& link);
  bool wait_until(Time moment, Link* only);

  void open(const PreparedStep& step);
  void open_line(const std::string& name, const Channel& to);
  void close(const PreparedStep& step);
  void await_ending(const PreparedStep& step);
  void await_opening(const PreparedStep& step);

  void act(const std::string& action);
  Status cycle_power();
  void set_memory(const std::vector<std::pair<std::string, std::string>>& memory);
  void look_at_memory(const PreparedStep& step);
  void settle_before_look();
  /// On a real device they count on from case to case; the case counts from its beginning.
  void note_counters();
  std::string since_beginning(const std::string& address, std::string value) const;
  void borrow_idle_link();

  void take_trace();
  bool probe(Link& link, std::optional<int> step);
  bool hear_the_rest();
  bool probe_links();
  void hear_end(const Link& link);
  void look_for_life();
  void close_links();

  Surroundings around_;
  const PreparedCase& prepared_;
  bool client_, neighbours_;  // neighbours: further stations hear all that is said
  Transcript transcript_;
  std::map<std::string, std::string> counters_;  // of a real device, at the beginning
  Links links_;
  MemoryAccess memory_;
  Partner partner_;
  notation::Captures captures_;
  const Link* last_sender_ = nullptr;  // and the step that it sent in
  int last_sending_ = -1;
  const PreparedStep* last_sent_ = nullptr;
  const PreparedStep* lost_probe_ = nullptr;  // a probe behind this one was not answered
};

}  // namespace fieldproof::exchange
