// Faults of the events of the CPU (DECISIONS.md email/cpu-events).
#include <nlohmann/json.hpp>

#include "suites/email/broken/faults.hpp"

namespace fieldproof::email_broken {

namespace {

using nlohmann::json;

MakeBehaviour without(const char* event) {
  return email([event](json& email) {
    if (email.contains("events")) email["events"].erase(event);
  });
}

MakeBehaviour events(void (*change)(json& events)) {
  return email([change](json& email) {
    if (email.contains("events")) change(email["events"]);
  });
}

/// Says and opens nothing while `silent` holds.
MakeBehaviour silent_while(bool (*silent)(const Module& module)) {
  return acts([silent](Bursts& does, Module& module) {
    if (silent(module)) does.clear();
  });
}

/// RUN comes too late for it to see that the change is undone.
MakeBehaviour undone_is_seen() {
  return [] {
    auto stopped = std::make_shared<bool>(false);
    return Behaviour{.ignores = [stopped](std::string_view action, const Module&) {
      const bool undone = action == "run" && *stopped;
      *stopped = *stopped || action == "stop";
      return undone;
    }};
  };
}

}  // namespace

std::vector<Fault> event_faults() {
  return {
      {"stop_unnoticed", "RUN to STOP is not mailed", without("run_to_stop"),
       "email/events/run_to_stop", "did not open"},
      {"run_unnoticed", "STOP to RUN is not mailed", without("stop_to_run"),
       "email/events/stop_to_run", "did not open"},
      {"error_unnoticed", "an error is not mailed", without("error"), "email/events/error/run",
       "did not open"},
      {"modes_exchanged", "RUN to STOP is mailed as STOP to RUN", events([](json& all) {
         std::swap(all["run_to_stop"], all["stop_to_run"]);
         for (const char* event : {"run_to_stop", "stop_to_run"})
           if (all[event].is_null()) all.erase(event);
       }),
       "email/events/run_to_stop", "argument"},
      {"all_events", "an event that is not set is mailed, too", events([](json& all) {
         for (const char* event : {"run_to_stop", "error"})
           if (!all.contains(event)) all[event] = {{"message", 0}, {"to", 0}};
       }),
       "email/events/not_set/run_to_stop", ""},
      {"silent_in_stop", "nothing is mailed in STOP",
       silent_while([](const Module& module) { return !module.run; }), "email/events/run_to_stop",
       "did not open"},
      {"silent_without_link", "events are not mailed with the link off",
       silent_while([](const Module& module) { return !module.link; }), "email/events/link_off",
       "did not open"},
      {"error_in_run_alone", "an error in STOP is not mailed",
       ignores([](std::string_view action, const Module& module) {
         return action == "error on" && !module.run;
       }),
       "email/events/error/stop", "did not open"},
      {"error_once", "an error that comes again is not mailed",
       ignores([](std::string_view action, const Module&) { return action == "error off"; }),
       "email/events/error/run", "did not open"},
      {"sees_all", "a change that is undone is mailed", undone_is_seen(), "email/events/undone",
       "before it had a reason"},
      {"looks_too_early", "a longer period is 10 s",
       email([](json& email) { email["period_s"] = 10; }), "email/events/period/s60", ""},
      {"looks_too_late", "10 s are 20 s", email([](json& email) {
         if (!email.contains("period_s")) email["period_s"] = 20;
       }),
       "email/events/run_to_stop", "did not open"},
      {"error_first", "the error goes before the mode", events([](json& all) {
         if (all.contains("run_to_stop") && all.contains("error"))
           std::swap(all["run_to_stop"], all["error"]);
       }),
       "email/events/stop_and_error", "argument"},
      {"keeps_the_period", "power does not begin the period anew",
       ignores([](std::string_view action, const Module&) { return action == "power_cycle"; }),
       "email/events/power_cycle", ""},
  };
}

}  // namespace fieldproof::email_broken
