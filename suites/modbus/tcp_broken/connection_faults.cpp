// Faults of connections: how many, for whom, and how they end (FEnet EN 6.1.3, 6.2.2, 6.4).
#include <algorithm>

#include "suites/broken/connection_faults.hpp"
#include "suites/modbus/tcp_broken/faults.hpp"

namespace fieldproof::modbus_tcp_broken {

using Settings = modbus::TcpServerConfig;

std::vector<Fault> connection_faults() {
  return {
      {"five_connections", "a fifth connection is served",
       set_up([](Settings& to) { ++to.connections; }), "modbus_tcp/connections/five",
       "did not close"},
      {"three_connections", "the fourth connection is refused",
       set_up([](Settings& to) { to.connections = std::min(to.connections, 3u); }),
       "modbus_tcp/connections/four", "refused"},
      {"dedicated_ignored", "four connections are taken, however many are set",
       set_up([](Settings& to) { to.connections = 4; }), "modbus_tcp/connections/dedicated_2",
       "did not close"},
      {"oldest_gives_way", "a fifth connection throws out the first",
       broken::oldest_gives_way<Settings>, "modbus_tcp/connections/five", ""},
      {"answers_on_the_first", "all answers go to the oldest connection",
       broken::answers_on<Settings>(
           [](LinkId, const std::vector<LinkId>& links) { return links.front(); }),
       "modbus_tcp/connections/four", "on b"},
      {"answers_on_the_last", "all answers go to the newest connection",
       broken::answers_on<Settings>(
           [](LinkId, const std::vector<LinkId>& links) { return links.back(); }),
       "modbus_tcp/connections/four_at_once", "on a"},
      {"answers_on_the_other", "of two connections the other one gets the answer",
       broken::answers_on<Settings>([](LinkId own, const std::vector<LinkId>& links) {
         return own == links.front() ? links.back() : links.front();
       }),
       "modbus_tcp/connections/same_transaction", ""},
      {"answers_to_all", "each connection gets each answer", acts(broken::answer_to_all),
       "modbus_tcp/connections/answers_stay_apart", "bytes"},
      {"fin_unanswered", "the client's FIN is not answered", acts(broken::never_reset),
       "modbus_tcp/connections/fin_ends", "did not close"},
      {"fin_unused_unanswered", "the FIN of a connection without a request is not heard",
       broken::deaf_to<Settings>(LinkEvent::closed), "modbus_tcp/connections/fin_unused",
       "did not close"},
      {"fin_keeps_the_place", "a connection that ended by FIN keeps its place",
       broken::fin_keeps_the_place<Settings>, "modbus_tcp/connections/place_is_free_after_fin", ""},
      {"rst_keeps_the_place", "a connection that was reset keeps its place",
       broken::deaf_to<Settings>(LinkEvent::reset),
       "modbus_tcp/connections/place_is_free_after_rst", ""},
      {"rst_ends_all", "a reset connection ends the others",
       broken::ends_all_with<Settings>(LinkEvent::reset),
       "modbus_tcp/connections/reset_before_answer", "reset"},
      {"fin_ends_all", "a FIN ends the others", broken::ends_all_with<Settings>(LinkEvent::closed),
       "modbus_tcp/connections/place_is_free_after_fin", ""},
      {"one_request_a_connection", "a connection ends behind its first answer",
       acts(broken::reset_behind_answers), "modbus_tcp/mbap/transaction_again", "reset"},
      {"waits_for_ever", "the reception waiting time does not end a connection",
       set_up([](Settings& to) { to.waiting_time = Duration{}; }),
       "modbus_tcp/connections/waiting_time", "did not close"},
      {"vanished_for_ever", "a client that vanished keeps its place for ever",
       set_up([](Settings& to) { to.waiting_time = Duration{}; }),
       "modbus_tcp/connections/vanished_place_is_free", ""},
      {"impatient", "a connection ends after a second without a request",
       set_up([](Settings& to) { to.waiting_time = 1s; }), "modbus_tcp/connections/dedicated_1",
       "reset"},
      {"tires_of_refusing", "after eight refused connections nothing is answered",
       [] { return broken::tires_of_refusing<Settings>(8); },
       "modbus_tcp/connections/refused_often", "no answer"},
      {"memory_lost_with_fin", "what stood in memory is lost when a connection ends",
       broken::forgets_with<Settings>(LinkEvent::closed, "%MW99"),
       "modbus_tcp/connections/ten_in_a_row_fin", "data"},
      {"memory_lost_with_rst", "what stood in memory is lost when a connection is reset",
       broken::forgets_with<Settings>(LinkEvent::reset, "%MW99"),
       "modbus_tcp/connections/ten_in_a_row_rst", "data"},
  };
}

}  // namespace fieldproof::modbus_tcp_broken
