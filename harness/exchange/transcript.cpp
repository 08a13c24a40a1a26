#include "harness/exchange/transcript.hpp"

#include <map>

#include <algorithm>

namespace fieldproof::exchange {

using results::Event;

namespace {

struct Carried {
  std::size_t received = 0, sent = 0;
};

void add(const Event& event, Received& received) {
  if (received.arrivals.empty()) received.link = event.link;
  received.arrivals.push_back({received.bytes.size(), event.start, event.end});
  received.bytes.insert(received.bytes.end(), event.bytes.begin(), event.bytes.end());
}

void add_surplus(const Event& event, Carried carried, Share& surplus) {
  if (event.kind != Event::Kind::received) {
    if (!surplus.ending) surplus.ending = {&event, carried.received, carried.sent};
  } else if (surplus.received.arrivals.empty() || surplus.received.link == event.link) {
    add(event, surplus.received);
  }
}

}  // namespace

bool Ending::refused() const {
  return event->kind == Event::Kind::reset && received == 0 && sent == 0;
}

Shares shares_of(const Transcript& transcript) {
  Shares shares{std::vector<Share>(transcript.steps.size()), {}};
  std::map<std::string, Carried> carried;  // by link
  for (const Event& event : transcript.events) {
    Carried& link = carried[event.link];
    Share* step = event.step >= 0 && static_cast<std::size_t>(event.step) < shares.steps.size()
                      ? &shares.steps[static_cast<std::size_t>(event.step)]
                      : nullptr;
    if (event.surplus) add_surplus(event, link, shares.surplus);
    switch (event.kind) {
      case Event::Kind::sent:
        if (step) step->sent.insert(step->sent.end(), event.bytes.begin(), event.bytes.end());
        link.sent += event.bytes.size();
        break;
      case Event::Kind::received:
        if (step && !event.surplus) add(event, step->received);
        link.received += event.bytes.size();
        break;
      case Event::Kind::closed:
      case Event::Kind::reset:
        if (step && event.by_device) step->ending = {&event, link.received, link.sent};
        break;
      case Event::Kind::opened:
        link = {};
        if (step && event.by_device) step->opened = &event;
        break;
      case Event::Kind::note: break;
    }
  }
  return shares;
}

bool leaves_open(const Transcript& transcript) {
  using Kind = results::Event::Kind;
  const auto spoken = std::find_if(
      transcript.events.rbegin(), transcript.events.rend(), [](const results::Event& event) {
        return event.kind == Kind::sent || event.kind == Kind::received;
      });
  return spoken != transcript.events.rend() && spoken->kind == Kind::received;
}

}  // namespace fieldproof::exchange
