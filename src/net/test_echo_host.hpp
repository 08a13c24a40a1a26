// For tests: a host that echoes on TCP and UDP port 7, and does on its links what it is told.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "src/net/host.hpp"

namespace fieldproof::net::test {

/// Told by "bye" (FIN), "rst" (RST), "call" (connects to port 9 of 192.0.2.1 and says "hello"
/// there) and "tell" (a datagram there).
class EchoHost : public Host {
 public:
  bool listens(Transport, std::uint16_t port) const override { return port == 7; }

  void receive(const Burst& burst) override {
    heard.push_back(burst);
    const std::string text = to_text(burst.bytes);
    const auto on = [&burst](LinkEvent event) {
      return Burst{.bytes = {}, .link = burst.link, .event = event};
    };
    if (text == "bye") {
      will_do(burst.start, on(LinkEvent::closed));
    } else if (text == "rst") {
      will_do(burst.start, on(LinkEvent::reset));
    } else if (text == "call" || text == "tell") {
      const LinkId own = next_own_++;
      const LinkEvent event = text == "call" ? LinkEvent::opened : LinkEvent::datagram;
      const Bytes hello = to_bytes("hello");
      will_do(burst.start, {.bytes = event == LinkEvent::opened ? Bytes{} : hello,
                            .link = own,
                            .event = event,
                            .port = 9,
                            .peer = "192.0.2.1"});
      if (event == LinkEvent::opened) will_do(burst.start, {.bytes = hello, .link = own});
    } else if (burst.event == LinkEvent::data || burst.event == LinkEvent::datagram) {
      will_do(burst.start + think,
              {.bytes = burst.bytes, .link = burst.link, .event = burst.event});
    }
  }

  std::optional<Time> wake_at() const override {
    return plan_.empty() ? std::nullopt : std::optional(plan_.begin()->first);
  }

  std::vector<Burst> advance(Time now) override {
    std::vector<Burst> done;
    for (; !plan_.empty() && plan_.begin()->first <= now; plan_.erase(plan_.begin()))
      done.push_back(std::move(plan_.begin()->second));
    return done;
  }

  /// Of one event, as text with a comma behind each burst.
  std::string heard_of(LinkEvent event) const {
    std::string text;
    for (const Burst& burst : heard)
      if (burst.event == event) text += to_text(burst.bytes) + ",";
    return text;
  }

  void will_do(Time at, Burst burst) { plan_.emplace(at, std::move(burst)); }

  Duration think{};  // from a request to its echo
  std::vector<Burst> heard;

 private:
  std::multimap<Time, Burst> plan_;
  LinkId next_own_ = first_own_link;
};

}  // namespace fieldproof::net::test
