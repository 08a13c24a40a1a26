// The CDMA modems (Cnet KO 11.5): what they answer, and when they are deaf.
#include <nlohmann/json.hpp>

#include "suites/services/broken/faults.hpp"

namespace fieldproof::services_broken {

using nlohmann::json;

namespace {

/// Only a modem says this.
MakeBehaviour answers(std::function<std::string(const std::string& right)> wrong) {
  return edge({.says = [=](Bytes& bytes, unsigned) { bytes = to_bytes(wrong(to_text(bytes))); }});
}

MakeBehaviour replaced(std::string what, std::string with) {
  return answers([=](const std::string& right) {
    std::string text = right;
    if (const std::size_t at = text.find(what); at != text.npos)
      text.replace(at, what.size(), with);
    return text;
  });
}

MakeBehaviour modem(std::function<void(json& config)> edit) {
  return [=] {
    return Behaviour{.set_up = [=](json& config) {
      if (config.contains("modem")) edit(config);
    }};
  };
}

MakeBehaviour has(const std::string& key, const json& value) {
  return modem([=](json& config) { config[key] = value; });
}

/// A control line that is not looked at.
MakeBehaviour always_set(const std::string& line) {
  return [=] {
    Behaviour behaviour = has(line, true)();
    behaviour.edge.sets = [name = "@" + line](std::string_view address, std::string hex) {
      return address == name ? std::string("01") : hex;
    };
    return behaviour;
  };
}

/// A command needs no CR.
Behaviour without_cr() {
  return {.edge = {.hears = [](Burst& burst, unsigned) {
            const std::string text = to_text(burst.bytes);
            if (text == "AT") burst.bytes = to_bytes("AT\r");
            return text != "\r";
          }}};
}

}  // namespace

std::vector<Fault> modem_faults() {
  return {
      {"modem_error", "a command is answered by ERROR", replaced("OK", "ERROR"),
       "udata/modem/at/bsm", "expected"},
      {"modem_line_ends", "answers end with CR LF",
       answers([](const std::string& right) { return right + "\r\n"; }), "udata/modem/at/rcu",
       "bytes"},
      {"modem_no_connect", "dialling is answered by OK", replaced("CONNECT", "OK"),
       "udata/modem/dial", "expected"},
      {"modem_keeps_data", "what follows CONNECT is not passed on",
       shows("@data", {"30313233343536373839"}, ""), "udata/modem/dial", "@data"},
      {"modem_no_report", "an SMS is not reported", replaced("$006", ""), "udata/modem/bsm_sms",
       "no answer within"},
      {"modem_no_primo", "an RCU-890 answers an SMS by OK alone", replaced("*SKT*PRIMO:0", ""),
       "udata/modem/rcu_sms", "expected"},
      {"modem_primo_1", "an RCU-890 says that the SMS was not taken over",
       replaced("*SKT*PRIMO:0", "*SKT*PRIMO:1"), "udata/modem/rcu_no_network", "expected"},
      {"modem_always_sent", "a network that is not there has taken the SMS", has("network", true),
       "udata/modem/bsm_no_network", ""},
      {"modem_never_sent", "the network is never there", has("network", false),
       "udata/modem/rcu_sms", "expected"},
      {"modem_report_at_once", "the network takes an SMS at once", has("network_ms", 0),
       "udata/modem/bsm_sms", ""},
      {"modem_needs_no_dtr", "without DTR the modem answers, too", always_set("dtr"),
       "udata/modem/without_dtr", "where silence is due"},
      {"modem_needs_no_rts", "without RTS the modem answers, too", always_set("rts"),
       "udata/modem/without_rts", "where silence is due"},
      {"modem_needs_no_cr", "a command needs no CR", without_cr, "udata/modem/no_cr",
       "where silence is due"},
      {"modem_forgets_commands", "behind its first answer the modem is deaf",
       [] {
         return Behaviour{
             .edge = {.hears = [heard = 0](Burst&, unsigned) mutable { return ++heard == 1; }}};
       },
       "udata/modem/data_mode", "no answer within"},
  };
}

}  // namespace fieldproof::services_broken
