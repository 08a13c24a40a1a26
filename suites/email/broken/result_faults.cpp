// Faults of blocks: when they mail, and what they show of it (DECISIONS.md email/status).
#include <nlohmann/json.hpp>

#include "suites/email/broken/faults.hpp"

namespace fieldproof::email_broken {

namespace {

using nlohmann::json;

/// Block 0 of P2P 1 shows `wrong` where `right` is due.
MakeBehaviour status(std::string right, std::string wrong) {
  return shows([=](Module& module) {
    if (*module.plc.get("%LW513", 0) == right) (void)module.plc.set("%LW513", wrong);
  });
}

void pulse(Module& module) {
  (void)module.plc.set("%MX0", "00");
  (void)module.plc.set("%MX0", "01");
}

/// Block 0 fires once more when its result is `result`.
MakeBehaviour again_at(std::string result) {
  return [=] {
    auto done = std::make_shared<bool>(false);
    return Behaviour{.shows = [=](Module& module) {
      if (*done || *module.plc.get("%LW512", 0) != result) return;
      *done = true;
      pulse(module);
    }};
  };
}

/// Without QUIT it never ends a connection itself.
MakeBehaviour no_time_out() {
  return acts([](Bursts& does, Module& module) {
    std::erase_if(does, [&](const Burst& one) {
      return one.event == LinkEvent::closed && module.last_said != "QUIT\r\n";
    });
  });
}

}  // namespace

std::vector<Fault> result_faults() {
  return {
      {"address_is_transfer", "a refused recipient gives 0005", status("0001", "0005"),
       "email/status/refused_recipient/c5", "0001"},
      {"server_is_transfer", "a refused greeting gives 0005", status("0003", "0005"),
       "email/status/refused_greeting/c5", "0003"},
      {"transfer_is_server", "a refused text gives 0003", status("0005", "0003"),
       "email/status/refused_text/c5", "0005"},
      {"off_is_server", "switched off gives 0003", status("0007", "0003"),
       "email/status/switched_off", "0007"},
      {"mails_when_off", "mails although e-mail is switched off",
       email([](json& email) { email["use"] = true; }), "email/status/switched_off", ""},
      {"error_stays", "a mail that is taken leaves STATUS as it was",
       [] {
         auto last = std::make_shared<std::string>();
         return Behaviour{.shows = [last](Module& module) {
           const std::string now = *module.plc.get("%LW513", 0);
           if (now == "0000" && !last->empty()) (void)module.plc.set("%LW513", *last);
           if (now != "0000") *last = now;
         }};
       },
       "email/status/good_after_bad", "0000"},
      {"errors_uncounted", "errors are not counted",
       shows([](Module& module) { (void)module.plc.set("%LD258", "00000000"); }),
       "email/status/refused_data/c5", "%LD258"},
      {"no_results", "a block shows nothing",
       shows([](Module& module) { (void)module.plc.set("%LW512", "0000"); }),
       "email/dialogue/one_address", "%LW512"},
      {"retries", "a mail that failed is sent again", again_at("0002"),
       "email/status/silent_sender", ""},
      {"on_level", "a flag that stays on mails again", again_at("0001"), "email/block/held_flag",
       ""},
      {"no_time_out", "a silent server is waited for without end", no_time_out(),
       "email/status/silent_text", "did not close"},
      {"quit_at_silence", "QUIT is said to a silent server", acts([](Bursts& does, Module& module) {
         const bool quit = module.last_said == "QUIT\r\n";
         for (std::size_t i = 0; i < does.size() && !quit; ++i)
           if (does[i].event == LinkEvent::closed)
             does.insert(does.begin() + static_cast<std::ptrdiff_t>(i++),
                         {.bytes = to_bytes("QUIT\r\n"), .start = {}, .link = does[i].link});
       }),
       "email/status/silent_hello", ""},
      {"deaf_to_stop", "STOP does not end a mail",
       ignores([](std::string_view action, const Module&) { return action == "stop"; }),
       "email/block/stop_gives_up", "did not close"},
      {"mails_in_stop", "blocks mail in STOP",
       [] { return Behaviour{.works_with = [](json& config) { config["mode"] = "run"; }}; },
       "email/block/edge_in_stop", ""},
      {"deaf_to_link", "the link enable changes nothing",
       ignores([](std::string_view action, const Module&) { return action.starts_with("link"); }),
       "email/block/link_off", ""},
      {"ereceive_mails", "ERECEIVE mails, too", p2p([](json& p2p) {
         for (json& block : p2p["blocks"])
           if (block["function"] == "ereceive")
             block = {{"function", "esend"}, {"flag", "%MX0"}, {"message", 0}, {"to", 0}};
       }),
       "email/block/ereceive", ""},
      {"last_block_first", "blocks that fire together go from the last on", p2p([](json& p2p) {
         if (p2p["blocks"].size() == 2) std::swap(p2p["blocks"][0]["to"], p2p["blocks"][1]["to"]);
       }),
       "email/block/two_on_one_flag", "argument"},
      {"results_of_p2p_1", "parameter 3 shows its results where 1 does",
       p2p([](json& p2p) { p2p["parameter"] = 1; }), "email/block/no_channel/p3", "%LW896"},
  };
}

}  // namespace fieldproof::email_broken
