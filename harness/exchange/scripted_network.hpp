// A network endpoint for tests: each link answers by a table, in simulated time.
#pragma once

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::exchange {

class ScriptedNetwork : public endpoints::Endpoint {
 public:
  /// What the device does so long after what was done to it.
  struct Act {
    Duration after;
    std::string text{};
    LinkEvent event = LinkEvent::data;
    int instead = 0;  // on the link that was opened so many before this one
  };

  endpoints::Capabilities can{.simulated = true, .connections = true, .datagrams = true};
  std::map<std::string, std::vector<Act>> answers;  // by what was sent
  std::vector<Act> when_opened, when_closed;
  std::vector<Burst> of_device;   // what it does of itself
  std::vector<std::string> done;  // "open tcp 502", "1 <ask>", "close 1 fin"
  int refused_from = 1'000;       // this link and all later ones

  const endpoints::Capabilities& capabilities() const override { return can; }
  std::string describe() const override { return "scripted network"; }
  Time now() const override { return now_; }
  Duration character_time() const override { return {}; }
  Status begin(const nlohmann::json&) override { return ok(); }

  Result<LinkId> open(Transport transport, std::uint16_t port) override {
    transports_[++last_] = transport;
    done.push_back(std::string("open ") + (transport == Transport::udp ? "udp " : "tcp ") +
                   std::to_string(port));
    if (static_cast<int>(last_) >= refused_from)
      act(last_, {{0ms, {}, LinkEvent::reset}});
    else
      act(last_, when_opened);
    return last_;
  }
  Status close(LinkId link, Closing how) override {
    done.push_back("close " + std::to_string(link) +
                   (how == Closing::fin   ? " fin"
                    : how == Closing::rst ? " rst"
                                          : " vanish"));
    if (how == Closing::fin)
      act(link, when_closed);
    else
      std::erase_if(coming_, [&](const Burst& burst) { return burst.link == link; });
    return ok();
  }
  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId link) override {
    const LinkId number = link >= first_own_link ? link - first_own_link + 100 : link;
    done.push_back(std::to_string(number) + ' ' + to_text(bytes));
    act(link, answers[to_text(bytes)]);
    return Sent{now_, now_};
  }
  Result<Burst> receive(Time deadline) override {
    for (Burst& burst : of_device) coming_.push_back(std::move(burst));
    of_device.clear();
    const auto next = std::ranges::min_element(coming_, {}, &Burst::start);
    if (next == coming_.end() || next->start > deadline) {
      now_ = std::max(now_, deadline);
      return Burst{};
    }
    Burst burst = std::move(*next);
    coming_.erase(next);
    now_ = std::max(now_, burst.start);
    return burst;
  }

 private:
  void act(LinkId link, const std::vector<Act>& acts) {
    for (const Act& one : acts) {
      const bool data = one.event == LinkEvent::data;
      const LinkId on = link - static_cast<LinkId>(one.instead);
      coming_.push_back(
          {to_bytes(one.text),
           now_ + one.after,
           {},
           on,
           data && transports_[on] == Transport::udp ? LinkEvent::datagram : one.event,
           0,
           {}});
    }
  }

  Time now_{};
  LinkId last_ = 0;
  std::map<LinkId, Transport> transports_;
  std::vector<Burst> coming_;
};

}  // namespace fieldproof::exchange
