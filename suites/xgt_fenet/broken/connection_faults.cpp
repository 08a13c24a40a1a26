// Faults of connections: how many, for whom, and how they end (FEnet EN 6.1.3, 6.2.2, 6.3.1).
#include "suites/broken/connection_faults.hpp"

#include <algorithm>

#include "suites/xgt_fenet/broken/faults.hpp"

namespace fieldproof::xgt_fenet_broken {

using Settings = xgt_fenet::ServerConfig;

namespace {

bool begins_a_frame(ByteView bytes) { return !bytes.empty() && bytes[0] == 'L'; }

/// Not the request, but its first bytes restart the waiting time: where a frame begins, the good
/// server is made to believe in a request, whose answer nobody sees.
Behaviour any_byte_restarts() {
  return {.hear =
              [](Burst heard, Server&) {
                if (heard.event != LinkEvent::data || !begins_a_frame(heard.bytes))
                  return Bursts{std::move(heard)};
                Burst whole = heard;
                whole.bytes = *from_hex(
                    "4C 53 49 53 2D 58 47 54 00 00 00 00 A0 33 77 77 0E 00 00 00 54 00 02 00 00 00 "
                    "01 00 04 00 "
                    "25 4D 57 30");
                return Bursts{std::move(whole), std::move(heard)};
              },
          .act =
              [](Bursts& does, Server&) {
                std::erase_if(
                    does, [](const Burst& one) { return word_at(one.bytes, invoke_at) == 0x7777; });
              }};
}

/// The client's FIN is answered by FIN.
void fin_by_fin(Bursts& does, Server&) {
  for (Burst& one : does)
    if (one.event == LinkEvent::reset) one.event = LinkEvent::closed;
}

/// The waiting time counts from the connection, not from the last request.
Behaviour waits_from_the_beginning(Duration most) {
  struct Kept {
    std::map<LinkId, Time> since;
    Time now{};
  };
  auto kept = std::make_shared<Kept>();
  return {.hear =
              [kept](Burst heard, Server&) {
                kept->now = heard.start;
                if (heard.event == LinkEvent::opened) kept->since[heard.link] = heard.start;
                return Bursts{std::move(heard)};
              },
          .act =
              [kept, most](Bursts& does, Server&) {
                for (const auto& [link, since] : kept->since)
                  if (kept->now - since > most) does.push_back(broken::reset_of(link));
                std::erase_if(kept->since,
                              [&](const auto& one) { return kept->now - one.second > most; });
              }};
}

}  // namespace

std::vector<Fault> connection_faults() {
  return {
      {"five_connections", "a fifth connection is served",
       set_up([](Settings& to) { ++to.dedicated.connections; }), "xgt_fenet/connections/five",
       "did not close"},
      {"three_connections", "the fourth connection is refused", set_up([](Settings& to) {
         to.dedicated.connections = std::min(to.dedicated.connections, 3u);
       }),
       "xgt_fenet/connections/four", ""},
      {"dedicated_ignored", "four connections are taken, however many are set",
       set_up([](Settings& to) { to.dedicated.connections = 4; }),
       "xgt_fenet/connections/dedicated_2", "did not close"},
      {"oldest_gives_way", "a fifth connection throws out the first",
       broken::oldest_gives_way<Settings>, "xgt_fenet/connections/five", ""},
      {"answers_on_the_first", "all answers go to the oldest connection",
       broken::answers_on<Settings>(
           [](LinkId, const std::vector<LinkId>& links) { return links.front(); }),
       "xgt_fenet/connections/four", ""},
      {"answers_on_the_last", "all answers go to the newest connection",
       broken::answers_on<Settings>(
           [](LinkId, const std::vector<LinkId>& links) { return links.back(); }),
       "xgt_fenet/connections/four_at_once", ""},
      {"answers_on_the_other", "of two connections the other one gets the answer",
       broken::answers_on<Settings>([](LinkId own, const std::vector<LinkId>& links) {
         return own == links.front() ? links.back() : links.front();
       }),
       "xgt_fenet/connections/same_invoke", ""},
      {"answers_to_all", "each connection gets each answer", acts(broken::answer_to_all),
       "xgt_fenet/connections/answers_stay_apart", ""},
      {"fin_by_fin", "the client's FIN is answered by FIN", acts(fin_by_fin),
       "xgt_fenet/connections/fin_by_rst", ""},
      {"fin_unanswered", "the client's FIN is not answered", acts(broken::never_reset),
       "xgt_fenet/connections/fin_ends", "did not close"},
      {"fin_unused_unanswered", "the FIN of a connection without a request is not heard",
       broken::deaf_to<Settings>(LinkEvent::closed), "xgt_fenet/connections/fin_unused",
       "did not close"},
      {"fin_keeps_the_place", "a connection that ended by FIN keeps its place",
       broken::fin_keeps_the_place<Settings>, "xgt_fenet/connections/one_place/fin", ""},
      {"rst_keeps_the_place", "a connection that was reset keeps its place",
       broken::deaf_to<Settings>(LinkEvent::reset), "xgt_fenet/connections/one_place/rst", ""},
      {"rst_ends_all", "a reset connection ends the others",
       broken::ends_all_with<Settings>(LinkEvent::reset),
       "xgt_fenet/connections/reset_before_answer", ""},
      {"one_request_a_connection", "a connection ends behind its first answer",
       acts(broken::reset_behind_answers), "xgt_fenet/connections/answers_stay_apart", ""},
      {"waits_for_ever", "the reception waiting time does not end a connection",
       set_up([](Settings& to) { to.dedicated.waiting_time = Duration{}; }),
       "xgt_fenet/connections/waiting_time_unused", "did not close"},
      {"vanished_for_ever", "a client that vanished keeps its place for ever",
       set_up([](Settings& to) { to.dedicated.waiting_time = Duration{}; }),
       "xgt_fenet/connections/vanished_place_is_free", ""},
      {"waits_three_times", "the reception waiting time is three times as long",
       set_up([](Settings& to) { to.dedicated.waiting_time *= 3; }),
       "xgt_fenet/connections/waiting_time_unused", ""},
      {"waits_a_second_less", "the reception waiting time is a second shorter",
       set_up([](Settings& to) { to.dedicated.waiting_time -= 1s; }),
       "xgt_fenet/connections/waiting_time/s2", ""},
      {"waits_from_the_beginning", "a request does not restart the waiting time",
       [] { return waits_from_the_beginning(2s); }, "xgt_fenet/connections/waiting_time/s3", ""},
      {"any_byte_restarts", "half a frame restarts the waiting time", any_byte_restarts,
       "xgt_fenet/connections/waiting_time_of_half_a_frame", ""},
      {"impatient", "a connection ends after a second without a request",
       set_up([](Settings& to) { to.dedicated.waiting_time = 1s; }), "xgt_fenet/connections/idle",
       ""},
      {"tires_of_refusing", "after eight refused connections nothing is answered",
       [] { return broken::tires_of_refusing<Settings>(8); }, "xgt_fenet/connections/refused_often",
       "no answer"},
      {"fin_ends_all", "a FIN ends the others", broken::ends_all_with<Settings>(LinkEvent::closed),
       "xgt_fenet/connections/one_place/fin", ""},
  };
}

}  // namespace fieldproof::xgt_fenet_broken
