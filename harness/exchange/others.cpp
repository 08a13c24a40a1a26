#include "harness/exchange/others.hpp"

#include <algorithm>
#include <random>

namespace fieldproof::exchange {

namespace {

class Watch {
 public:
  Watch(const Channel& line, const ExchangeTiming& timing)
      : endpoint_(*line.endpoint),
        protocol_(*line.protocol),
        timing_(timing),
        request_(line.protocol->probe(line.station, {})) {}

  bool can_ask() const { return !request_.empty(); }
  const Bytes& unasked() const { return unasked_; }

  /// Nothing is outstanding: whatever comes was asked for by somebody else.
  Status listen(Time until) {
    while (unasked_.size() <= flood_limit) {
      const Result<Burst> burst = endpoint_.receive(until);
      if (!burst) return burst.error();
      if (is_nothing(*burst)) return ok();
      note(burst->bytes);
    }
    return ok();
  }

  /// One probe and its answer, whatever that is; an answer that is only late is waited for.
  Status ask() {
    const Result<Sent> sent = endpoint_.send(request_);
    if (!sent) return sent.error();
    Time until = sent->end + timing_.response_max + timing_.late_watch;
    Bytes heard;
    std::optional<std::size_t> length;
    while (!(length = protocol_.frame_length(heard)) && heard.size() <= flood_limit) {
      const Result<Burst> burst = endpoint_.receive(until);
      if (!burst) return burst.error();
      if (is_nothing(*burst)) return ok();
      heard.insert(heard.end(), burst->bytes.begin(), burst->bytes.end());
      until = burst->end() + timing_.quiet;
    }
    note(ByteView(heard).subspan(length.value_or(0)));
    return ok();
  }

 private:
  void note(ByteView bytes) { unasked_.insert(unasked_.end(), bytes.begin(), bytes.end()); }

  endpoints::Endpoint& endpoint_;
  const harness::Protocol& protocol_;
  const ExchangeTiming& timing_;
  Bytes request_, unasked_;
};

}  // namespace

Result<Bytes> unasked_bytes(const Channel& line, Duration watch, const ExchangeTiming& timing) {
  Watch looking(line, timing);
  std::mt19937 random{std::random_device{}()};
  std::uniform_int_distribution pause_ms(20, 80);
  const Time end = line.endpoint->now() + watch;
  while (line.endpoint->now() < end && looking.unasked().size() <= flood_limit) {
    const Time next = line.endpoint->now() + pause_ms(random) * 1ms;
    if (const Status listened = looking.listen(std::min(next, end)); !listened)
      return listened.error();
    if (!looking.can_ask()) continue;
    if (const Status asked = looking.ask(); !asked) return asked.error();
  }
  return looking.unasked();
}

}  // namespace fieldproof::exchange
