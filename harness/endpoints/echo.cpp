#include "harness/endpoints/echo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/endpoints/forwarding.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/network_name.hpp"

namespace fieldproof::endpoints {

void EchoFilter::sent(ByteView bytes, Time end) {
  if (!bytes.empty()) under_way_.push_back({{bytes.begin(), bytes.end()}, end});
}

void EchoFilter::take(const Burst& burst) {
  for (std::size_t i = 0; i < burst.bytes.size(); ++i) {
    const Time start = burst.start + burst.character_time * static_cast<Duration::rep>(i);
    held_.push_back({burst.bytes[i], start, burst.character_time, i == 0});
    while (!held_.empty() && !settle()) release();
  }
}

bool EchoFilter::is_beginning(const Sending& sending) const {
  return held_.size() <= sending.bytes.size() &&
         std::ranges::equal(held_, ByteView(sending.bytes).first(held_.size()), {}, &Held::value);
}

/// Takes a whole echo out. False: what is held begins none.
bool EchoFilter::settle() {
  const auto found = std::ranges::find_if(
      under_way_, [this](const Sending& sending) { return is_beginning(sending); });
  if (found == under_way_.end()) return false;
  if (held_.size() < found->bytes.size()) return true;
  // Echoes come in the order of sending: those before it come no more.
  for (auto earlier = found - under_way_.begin(); earlier > 0; --earlier) lose(0);
  under_way_.pop_front();
  held_.clear();
  ++removed_;
  return true;
}

void EchoFilter::lose(std::size_t index) {
  const auto at = under_way_.begin() + static_cast<std::ptrdiff_t>(index);
  last_lost_ = std::move(at->bytes);
  under_way_.erase(at);
  ++lost_;
}

/// Hands over the first byte that is held.
void EchoFilter::release() {
  const Held byte = held_.front();
  held_.pop_front();
  for (Sending& sending : under_way_) sending.overtaken |= byte.start >= sending.end;
  if (byte.first || ready_.empty() || ready_.back().end() != byte.start)
    ready_.push_back({{}, byte.start, byte.character_time});
  ready_.back().bytes.push_back(byte.value);
}

void EchoFilter::expire(Time now) {
  for (std::size_t i = under_way_.size(); i-- > 0;)
    if (now > under_way_[i].end + patience) lose(i);
  while (!held_.empty() && !settle()) release();
}

void EchoFilter::conclude(Time now) {
  for (std::size_t i = under_way_.size(); i-- > 0;)
    if (under_way_[i].overtaken) lose(i);
  expire(now);
}

void EchoFilter::let_go() {
  while (!held_.empty()) release();
}

void EchoFilter::clear() {
  under_way_.clear();
  held_.clear();
  ready_.clear();
}

std::optional<Burst> EchoFilter::next() {
  if (ready_.empty()) return std::nullopt;
  Burst burst = std::move(ready_.front());
  ready_.pop_front();
  return burst;
}

std::string EchoFilter::take_troubles() {
  const std::size_t count = lost_ - std::exchange(told_, lost_);
  if (count == 0) return {};
  constexpr std::size_t enough = 16;
  const ByteView shown = ByteView(last_lost_).first(std::min(enough, last_lost_.size()));
  return fmt::format("{} missing or damaged echo{} (of {}{})", count, count == 1 ? "" : "es",
                     to_hex(shown), last_lost_.size() > enough ? " ..." : "");
}

namespace {

class WithoutEcho final : public Forwarding {
 public:
  explicit WithoutEcho(std::unique_ptr<Endpoint> line)
      : Forwarding(*line), line_(std::move(line)) {}

  Status begin(const nlohmann::json& config) override {
    filter_.conclude(now());
    return to_.begin(config);
  }

  Status act(std::string_view action) override {
    filter_.clear();
    return to_.act(action);
  }

  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId link) override {
    filter_.conclude(now());
    constexpr std::size_t enough = 3;
    if (filter_.removed() == 0 && filter_.lost() >= enough)
      return fail(fmt::format(
          "cannot send to {} with echo=on: of {} requests none has come back as it was sent, "
          "though something came; this line has no echo, or it is disturbed: leave echo=on out",
          describe(), filter_.lost()));
    Result<Sent> sent = to_.send(bytes, link);
    if (sent) filter_.sent(bytes, sent->end);
    return sent;
  }

  Result<Burst> receive(Time deadline) override {
    while (true) {
      if (std::optional<Burst> burst = filter_.next()) return *burst;
      Result<Burst> came = to_.receive(deadline);
      if (!came) filter_.let_go();
      if (std::optional<Burst> last = came ? std::nullopt : filter_.next()) return *last;
      if (!came || came->event != LinkEvent::data) return came;
      if (came->bytes.empty()) {
        filter_.expire(now());
        if (std::optional<Burst> overdue = filter_.next()) return *overdue;
        return came;
      }
      filter_.take(*came);
    }
  }

  std::string line_errors() override {
    filter_.conclude(now());
    std::string errors = to_.line_errors();
    const std::string echoes = filter_.take_troubles();
    if (!errors.empty() && !echoes.empty()) errors += ", ";
    return errors + echoes;
  }

 private:
  std::unique_ptr<Endpoint> line_;
  EchoFilter filter_;
};

}  // namespace

bool removes_echo(const EndpointName& name) { return name.option("echo", "off") == "on"; }

Status check_echo(const EndpointName& name, const harness::Protocol& protocol) {
  const std::string echo = name.option("echo", "off");
  if (echo != "on" && echo != "off")
    return fail(fmt::format("echo is '{}'; write echo=on, or leave it out", echo));
  if (echo == "on" && protocol.on_network())
    return fail(
        "it runs on a network, where nothing echoes; echo=on is for lines: leave echo=on out");
  if (echo == "on" && kind_of(name).simulated)
    return fail("nothing echoes on a simulated line; leave echo=on out");
  return ok();
}

std::unique_ptr<Endpoint> without_echo(std::unique_ptr<Endpoint> line) {
  return std::make_unique<WithoutEcho>(std::move(line));
}

}  // namespace fieldproof::endpoints
