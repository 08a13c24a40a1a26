// Faults of connections: how many, for whom, and how they end (FEnet EN 6.1.3, 6.2.2, 6.4).
#include <algorithm>
#include <memory>

#include "suites/modbus/tcp_broken/faults.hpp"

namespace fieldproof::modbus_tcp_broken {

namespace {

Burst reset_of(LinkId link) {
  return {.bytes = {}, .start = {}, .link = link, .event = LinkEvent::reset};
}

bool is_answer(const Burst& one) { return one.event == LinkEvent::data; }

/// Answers go where `choose` says.
MakeBehaviour answers_on(LinkId (*choose)(LinkId own, const std::vector<LinkId>& links)) {
  return acts([choose](Bursts& does, Server& server) {
    for (Burst& one : does)
      if (is_answer(one)) one.link = choose(one.link, server.links);
  });
}

/// An event of a connection that the good server does not hear of.
MakeBehaviour deaf_to(LinkEvent event) {
  return hears([event](Burst heard, Server&) {
    return heard.event == event ? Bursts{} : Bursts{std::move(heard)};
  });
}

/// What ends one connection ends all.
MakeBehaviour ends_all_with(LinkEvent event) {
  return [event] {
    auto ends = std::make_shared<bool>(false);
    return Behaviour{.hear =
                         [ends, event](Burst heard, Server&) {
                           *ends = *ends || heard.event == event;
                           return Bursts{std::move(heard)};
                         },
                     .act =
                         [ends](Bursts& does, Server& server) {
                           if (!std::exchange(*ends, false)) return;
                           for (const LinkId link : server.links) does.push_back(reset_of(link));
                         }};
  };
}

/// One more than there is place for throws out the oldest.
Behaviour oldest_gives_way() {
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
Behaviour tires_of_refusing(int most) {
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

/// Memory is lost when a connection ends.
MakeBehaviour forgets_with(LinkEvent event) {
  return hears([event](Burst heard, Server& server) {
    if (heard.event == event) (void)server.plc.set("%MW99", "0000");
    return Bursts{std::move(heard)};
  });
}

}  // namespace

std::vector<Fault> connection_faults() {
  return {
      {"five_connections", "a fifth connection is served",
       set_up([](modbus::TcpServerConfig& to) { ++to.connections; }), "modbus_tcp/connections/five",
       "did not close"},
      {"three_connections", "the fourth connection is refused",
       set_up([](modbus::TcpServerConfig& to) { to.connections = std::min(to.connections, 3u); }),
       "modbus_tcp/connections/four", "refused"},
      {"dedicated_ignored", "four connections are taken, however many are set",
       set_up([](modbus::TcpServerConfig& to) { to.connections = 4; }),
       "modbus_tcp/connections/dedicated_2", "did not close"},
      {"oldest_gives_way", "a fifth connection throws out the first", oldest_gives_way,
       "modbus_tcp/connections/five", ""},
      {"answers_on_the_first", "all answers go to the oldest connection",
       answers_on([](LinkId, const std::vector<LinkId>& links) { return links.front(); }),
       "modbus_tcp/connections/four", "on b"},
      {"answers_on_the_last", "all answers go to the newest connection",
       answers_on([](LinkId, const std::vector<LinkId>& links) { return links.back(); }),
       "modbus_tcp/connections/four_at_once", "on a"},
      {"answers_on_the_other", "of two connections the other one gets the answer",
       answers_on([](LinkId own, const std::vector<LinkId>& links) {
         return own == links.front() ? links.back() : links.front();
       }),
       "modbus_tcp/connections/same_transaction", ""},
      {"answers_to_all", "each connection gets each answer", acts([](Bursts& does, Server& server) {
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
       }),
       "modbus_tcp/connections/answers_stay_apart", "bytes"},
      {"fin_unanswered", "the client's FIN is not answered", acts([](Bursts& does, Server&) {
         std::erase_if(does, [](const Burst& one) { return one.event == LinkEvent::reset; });
       }),
       "modbus_tcp/connections/fin_ends", "did not close"},
      {"fin_unused_unanswered", "the FIN of a connection without a request is not heard",
       deaf_to(LinkEvent::closed), "modbus_tcp/connections/fin_unused", "did not close"},
      {"fin_keeps_the_place", "a connection that ended by FIN keeps its place",
       [] {
         auto ended = std::make_shared<Bursts>();
         return Behaviour{.hear =
                              [ended](Burst heard, Server&) {
                                if (heard.event != LinkEvent::closed)
                                  return Bursts{std::move(heard)};
                                ended->push_back(reset_of(heard.link));
                                return Bursts{};
                              },
                          .act =
                              [ended](Bursts& does, Server&) {
                                std::ranges::move(std::exchange(*ended, {}),
                                                  std::back_inserter(does));
                              }};
       },
       "modbus_tcp/connections/place_is_free_after_fin", ""},
      {"rst_keeps_the_place", "a connection that was reset keeps its place",
       deaf_to(LinkEvent::reset), "modbus_tcp/connections/place_is_free_after_rst", ""},
      {"rst_ends_all", "a reset connection ends the others", ends_all_with(LinkEvent::reset),
       "modbus_tcp/connections/reset_before_answer", "reset"},
      {"fin_ends_all", "a FIN ends the others", ends_all_with(LinkEvent::closed),
       "modbus_tcp/connections/place_is_free_after_fin", ""},
      {"one_request_a_connection", "a connection ends behind its first answer",
       acts([](Bursts& does, Server&) {
         const std::size_t count = does.size();
         for (std::size_t i = 0; i < count; ++i)
           if (is_answer(does[i])) does.push_back(reset_of(does[i].link));
       }),
       "modbus_tcp/mbap/transaction_again", "reset"},
      {"waits_for_ever", "the reception waiting time does not end a connection",
       set_up([](modbus::TcpServerConfig& to) { to.waiting_time = Duration{}; }),
       "modbus_tcp/connections/waiting_time", "did not close"},
      {"vanished_for_ever", "a client that vanished keeps its place for ever",
       set_up([](modbus::TcpServerConfig& to) { to.waiting_time = Duration{}; }),
       "modbus_tcp/connections/vanished_place_is_free", ""},
      {"impatient", "a connection ends after a second without a request",
       set_up([](modbus::TcpServerConfig& to) { to.waiting_time = 1s; }),
       "modbus_tcp/connections/dedicated_1", "reset"},
      {"tires_of_refusing", "after eight refused connections nothing is answered",
       [] { return tires_of_refusing(8); }, "modbus_tcp/connections/refused_often", "no answer"},
      {"memory_lost_with_fin", "what stood in memory is lost when a connection ends",
       forgets_with(LinkEvent::closed), "modbus_tcp/connections/ten_in_a_row_fin", "data"},
      {"memory_lost_with_rst", "what stood in memory is lost when a connection is reset",
       forgets_with(LinkEvent::reset), "modbus_tcp/connections/ten_in_a_row_rst", "data"},
  };
}

}  // namespace fieldproof::modbus_tcp_broken
