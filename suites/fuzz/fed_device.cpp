#include "suites/fuzz/fed_device.hpp"

#include <algorithm>

#include "suites/fuzz/rule.hpp"

namespace fieldproof::fuzz {

void FedDevice::connect() {
  link_ = ++connections_;
  tell(LinkEvent::opened);
}

void FedDevice::disconnect() { tell(LinkEvent::reset); }

void FedDevice::feed(ByteView bytes) {
  run(now_);
  Burst burst;
  burst.bytes.assign(bytes.begin(), bytes.end());
  burst.start = now_;
  if (net::Host* const host = network()) {
    burst.link = link_;
    burst.event = carries_;
    if (link_ != 0) host->receive(burst);
  } else if (line::Device* const line = device_->line()) {
    burst.character_time = 100us;
    line->receive(burst);
    now_ = burst.end();
  }
  run(now_);
}

void FedDevice::feed_pieces(ByteView pieces) {
  while (pieces.size() > 2) {
    const std::size_t count = std::min<std::size_t>(pieces[0] + 1, pieces.size() - 2);
    feed(pieces.subspan(2, count));
    pause(pieces[1] * 200us);
    pieces = pieces.subspan(2 + count);
  }
}

void FedDevice::tell(LinkEvent event) {
  net::Host* const host = network();
  if (!host) return;
  Burst burst;
  burst.start = now_;
  burst.link = link_;
  burst.event = event;
  burst.port = protocol_.default_port();
  host->receive(burst);
  run(now_);
}

std::optional<Time> FedDevice::wake() {
  if (net::Host* const host = network()) return host->wake_at();
  line::Device* const line = device_->line();
  return line ? line->wake_at() : std::nullopt;
}

/// Where it connects to others, they are fed to it from then on.
void FedDevice::note(const Burst& burst) {
  sent_ |= !burst.bytes.empty();
  if (burst.link < first_own_link) return;
  if (burst.event == LinkEvent::opened || burst.event == LinkEvent::datagram) link_ = burst.link;
  if (burst.event == LinkEvent::datagram) carries_ = LinkEvent::datagram;
  if (burst.event == LinkEvent::reset && burst.link == link_) link_ = 0;
}

void FedDevice::run(Time until) {
  constexpr std::size_t most_wakes = 200'000;
  std::size_t wakes = 0;
  for (auto at = wake(); at && *at <= until; at = wake()) {
    rule(++wakes < most_wakes, "a device comes to rest");
    now_ = std::max(now_, *at);
    if (net::Host* const host = network())
      for (const Burst& burst : host->advance(now_)) note(burst);
    else
      sent_ |= !device_->line()->advance(now_).empty();
  }
  now_ = std::max(now_, until);
}

}  // namespace fieldproof::fuzz
