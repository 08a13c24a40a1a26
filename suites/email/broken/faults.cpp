#include "suites/email/broken/faults.hpp"

#include <nlohmann/json.hpp>

namespace fieldproof::email_broken {

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all =
      broken::gather<Fault>({dialogue_faults, mail_faults, result_faults, event_faults});
  return all;
}

MakeBehaviour hears(std::function<std::string(std::string, Module&)> change) {
  return [=] { return Behaviour{.hears = change}; };
}
MakeBehaviour says(std::function<std::string(std::string, Module&)> change) {
  return [=] { return Behaviour{.says = change}; };
}
MakeBehaviour acts(std::function<void(Bursts&, Module&)> change) {
  return [=] { return Behaviour{.acts = change}; };
}
MakeBehaviour shows(std::function<void(Module&)> change) {
  return [=] { return Behaviour{.shows = change}; };
}
MakeBehaviour ignores(std::function<bool(std::string_view, const Module&)> whether) {
  return [=] { return Behaviour{.ignores = whether}; };
}
MakeBehaviour p2p(std::function<void(nlohmann::json&)> change) {
  return [=] {
    return Behaviour{.works_with = [change](nlohmann::json& config) { change(config["p2p"]); }};
  };
}
MakeBehaviour email(std::function<void(nlohmann::json&)> change) {
  return p2p([change](nlohmann::json& p2p) { change(p2p["email"]); });
}

MakeBehaviour says_instead(std::string from, std::string to) {
  return says([=](std::string text, Module&) { return replaced(std::move(text), from, to); });
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace fieldproof::email_broken
