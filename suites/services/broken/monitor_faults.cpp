// The frame monitor (Cnet EN 11.1.3, Cnet KO 10.1.3), and what it says of a service that does not
// run (10.2).
#include <nlohmann/json.hpp>

#include "suites/services/broken/faults.hpp"

namespace fieldproof::services_broken {

using nlohmann::json;

namespace {

/// One result is shown as another.
MakeBehaviour result(std::vector<std::string> from, std::string to) {
  return shows("@monitor", std::move(from), std::move(to));
}

/// What is not known is taken for what was seen before.
Behaviour unknown_is_the_last() {
  return {.edge = {.shows = [last = std::string("00")](std::string_view address,
                                                       std::string right) mutable {
            if (address == "@monitor" && right != "06") last = right;
            return address == "@monitor" ? last : right;
          }}};
}

MakeBehaviour sets_up(std::function<void(json& config)> edit) {
  return [=] { return Behaviour{.set_up = edit}; };
}

void enabled(json& config) {
  if (config.contains("p2p")) config["p2p"]["link"] = true;
}

void runs(json& config) {
  if (config.contains("mode")) config["mode"] = "run";
}

}  // namespace

std::vector<Fault> monitor_faults() {
  return {
      {"monitor_never", "nothing is monitored", result({"01", "02", "03", "04", "05", "06"}, "00"),
       "xgt_cnet/frame_monitor/server", "@monitor"},
      {"monitor_unknown_is_the_last", "a frame that is not known is shown as the one before",
       unknown_is_the_last, "xgt_cnet/frame_monitor/echo", "@monitor"},
      {"monitor_xgt_unknown", "frames of XGT are not known", result({"01", "02"}, "06"),
       "xgt_cnet/frame_monitor/server", "@monitor"},
      {"monitor_client_as_server", "an XGT client is shown as an XGT server", result({"02"}, "01"),
       "xgt_cnet/client_monitor/ko_client", "@monitor"},
      {"monitor_server_as_client", "an XGT server is shown as an XGT client", result({"01"}, "02"),
       "xgt_cnet/client_monitor/ko_server", "@monitor"},
      {"monitor_modbus_client_as_server", "a Modbus client is shown as a Modbus server",
       result({"04"}, "03"), "modbus_rtu/frame_monitor/client", "@monitor"},
      {"monitor_modbus_server_as_client", "a Modbus server is shown as a Modbus client",
       result({"03"}, "04"), "modbus_ascii/frame_monitor/server", "@monitor"},
      {"monitor_modbus_as_xgt", "a Modbus server is shown as an XGT server", result({"03"}, "01"),
       "modbus_rtu/frame_monitor/server", "@monitor"},
      {"monitor_user_frames_unknown", "user-defined frames are not known", result({"05"}, "06"),
       "user_frames/client_px7/monitor", "@monitor"},
      {"monitored_client_needs_no_link", "a client whose link is not enabled asks",
       sets_up(enabled), "xgt_cnet/client_monitor/ko_link", ""},
      {"monitored_client_asks_in_stop", "a client of a CPU in STOP asks", sets_up(runs),
       "xgt_cnet/client_monitor/ko_stop", ""},
      {"monitored_client_deaf_to_run", "a client does not begin with RUN", edge({.deaf_to = "run"}),
       "xgt_cnet/client_monitor/ko_stop", "no request within"},
      {"monitored_client_deaf_to_link", "a client does not begin with its link",
       edge({.deaf_to = "link on"}), "xgt_cnet/client_monitor/ko_link", "no request within"},
  };
}

}  // namespace fieldproof::services_broken
