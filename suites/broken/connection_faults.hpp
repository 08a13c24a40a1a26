// What servers on networks do wrong with connections, whatever they speak: behaviours for the
// tables of faults.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "suites/broken/network_server.hpp"

namespace fieldproof::broken {

inline Burst reset_of(LinkId link) {
  return {.bytes = {}, .start = {}, .link = link, .event = LinkEvent::reset};
}

inline bool is_answer(const Burst& one) { return one.event == LinkEvent::data; }

/// Answers go where `choose` says.
template <typename Settings>
auto answers_on(LinkId (*choose)(LinkId own, const std::vector<LinkId>& links)) {
  return [choose] {
    return NetworkBehaviour<Settings>{.act = [choose](Bursts& does, Server& server) {
      for (Burst& one : does)
        if (is_answer(one)) one.link = choose(one.link, server.links);
    }};
  };
}

/// Each connection gets each answer.
inline void answer_to_all(Bursts& does, Server& server) {
  Bursts all;
  for (const Burst& one : does) {
    all.push_back(one);
    for (const LinkId link : server.links)
      if (is_answer(one) && link != one.link) {
        all.push_back(one);
        all.back().link = link;
      }
  }
  does = std::move(all);
}

/// A connection ends behind its first answer.
inline void reset_behind_answers(Bursts& does, Server&) {
  const std::size_t count = does.size();
  for (std::size_t i = 0; i < count; ++i)
    if (is_answer(does[i])) does.push_back(reset_of(does[i].link));
}

/// The client's FIN is not answered.
inline void never_reset(Bursts& does, Server&) {
  std::erase_if(does, [](const Burst& one) { return one.event == LinkEvent::reset; });
}

/// An event of a connection that the good server does not hear of.
template <typename Settings>
auto deaf_to(LinkEvent event) {
  return [event] {
    return NetworkBehaviour<Settings>{.hear = [event](Burst heard, Server&) {
      return heard.event == event ? Bursts{} : Bursts{std::move(heard)};
    }};
  };
}

/// A connection that ended by FIN keeps its place.
template <typename Settings>
NetworkBehaviour<Settings> fin_keeps_the_place() {
  auto ended = std::make_shared<Bursts>();
  return {.hear =
              [ended](Burst heard, Server&) {
                if (heard.event != LinkEvent::closed) return Bursts{std::move(heard)};
                ended->push_back(reset_of(heard.link));
                return Bursts{};
              },
          .act =
              [ended](Bursts& does, Server&) {
                std::ranges::move(std::exchange(*ended, {}), std::back_inserter(does));
              }};
}

/// What ends one connection ends all.
template <typename Settings>
auto ends_all_with(LinkEvent event) {
  return [event] {
    auto ends = std::make_shared<bool>(false);
    return NetworkBehaviour<Settings>{.hear =
                                          [ends, event](Burst heard, Server&) {
                                            *ends = *ends || heard.event == event;
                                            return Bursts{std::move(heard)};
                                          },
                                      .act =
                                          [ends](Bursts& does, Server& server) {
                                            if (!std::exchange(*ends, false)) return;
                                            for (const LinkId link : server.links)
                                              does.push_back(reset_of(link));
                                          }};
  };
}

/// One more than there is place for throws out the oldest.
template <typename Settings>
NetworkBehaviour<Settings> oldest_gives_way() {
  auto thrown = std::make_shared<std::vector<LinkId>>();
  return {.hear =
              [thrown](Burst heard, Server& server) {
                if (heard.event != LinkEvent::opened || server.links.size() < 4)
                  return Bursts{std::move(heard)};
                const LinkId oldest = server.links.front();
                thrown->push_back(oldest);
                Burst end = reset_of(oldest);
                end.start = heard.start;
                return Bursts{std::move(end), std::move(heard)};
              },
          .act =
              [thrown](Bursts& does, Server&) {
                for (const LinkId link : std::exchange(*thrown, {})) does.push_back(reset_of(link));
              }};
}

/// Deaf for good after so many refusals.
template <typename Settings>
NetworkBehaviour<Settings> tires_of_refusing(int most) {
  auto refused = std::make_shared<int>(0);
  return {.hear =
              [refused, most](Burst heard, Server&) {
                return *refused >= most && is_answer(heard) ? Bursts{} : Bursts{std::move(heard)};
              },
          .act =
              [refused](Bursts& does, Server&) {
                *refused +=
                    static_cast<int>(std::ranges::count(does, LinkEvent::reset, &Burst::event));
              }};
}

/// A place in memory is lost when a connection ends.
template <typename Settings>
auto forgets_with(LinkEvent event, std::string address) {
  return [event, address] {
    return NetworkBehaviour<Settings>{.hear = [event, address](Burst heard, Server& server) {
      if (heard.event == event) (void)server.plc.set(address, "0000");
      return Bursts{std::move(heard)};
    }};
  };
}

}  // namespace fieldproof::broken
