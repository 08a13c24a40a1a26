#include "harness/exchange/visit.hpp"

#include <utility>

namespace fieldproof::exchange {

namespace {

/// How long the device gets to close its side, too; some never do.
constexpr Duration farewell = 100ms;

}  // namespace

Visit::Visit(const Channel& to, Elsewhere elsewhere)
    : endpoint_(*to.endpoint),
      elsewhere_(std::move(elsewhere)),
      transport_(implicit_transport(to)) {
  if (!transport_) link_ = line_link;
}

void Visit::borrow(LinkId link) {
  leave();
  link_ = link;
  ended_.reset();
  heard_ = false;
}

Status Visit::enter() {
  if (ended_) leave();
  if (link_) return ok();
  ended_.reset();
  heard_ = false;
  const Result<LinkId> link = endpoint_.open(*transport_, 0);
  if (!link) return link.error();
  link_ = *link;
  own_ = true;
  return ok();
}

Result<Sent> Visit::send(ByteView bytes) {
  if (const Status entered = enter(); !entered) return entered.error();
  return endpoint_.send(bytes, *link_);
}

void Visit::hand_over(Burst burst) {
  if (elsewhere_) elsewhere_(std::move(burst));
}

Result<Burst> Visit::receive(Time deadline) {
  while (!ended_) {
    Result<Burst> burst = endpoint_.receive(deadline);
    if (!burst || is_nothing(*burst)) return burst;
    if (burst->link != link_) {
      hand_over(std::move(*burst));
      continue;
    }
    if (is_end(*burst)) {
      ended_ = burst->event;
      if (!own_) hand_over(*burst);  // a link of the case: its end is the case's
    }
    if (burst->bytes.empty()) continue;
    heard_ = true;
    return burst;
  }
  return Burst{};
}

Status Visit::pause(Duration duration) {
  const Time end = endpoint_.now() + duration;
  while (true) {
    Result<Burst> burst = endpoint_.receive(end);
    if (!burst) return burst.error();
    if (is_nothing(*burst)) return ok();
    if (burst->link != link_) hand_over(std::move(*burst));
  }
}

void Visit::leave() {
  if (!transport_) return;
  const std::optional<LinkId> link = std::exchange(link_, std::nullopt);
  if (!std::exchange(own_, false) || !endpoint_.close(*link, Closing::fin) || ended_) return;
  const Time end = endpoint_.now() + farewell;
  while (true) {
    Result<Burst> burst = endpoint_.receive(end);
    if (!burst || is_nothing(*burst)) return;
    if (burst->link != link)
      hand_over(std::move(*burst));
    else if (is_end(*burst))
      return;
  }
}

}  // namespace fieldproof::exchange
