#include "harness/endpoints/controlled.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ranges>

#include "harness/device_names.hpp"
#include "src/base/letters.hpp"
#include "src/base/nesting.hpp"

namespace fieldproof::endpoints {

namespace {

using nlohmann::json;

constexpr Duration answer_patience = 10s;  // a program may start its device anew to set it up

std::string as_line(const json& wish) {
  return wish.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// One JSON object may say what the values are in more than one way.
json values_in(const json& answer) {
  for (const char* key : {"values", "get"})
    if (answer.contains(key) && answer[key].is_object()) return answer[key];
  return answer;
}

/// As many as the letter of the type says; where there is none, the element is a word.
std::size_t element_digits(std::string_view address, std::size_t digits) {
  const auto name = harness::read_element_name(address);
  return std::min(digits, name ? 2 * name->element_bytes() : 4);
}

bool is_hex(std::string_view text) {
  return text.find_first_not_of("0123456789ABCDEFabcdef") == std::string_view::npos;
}

}  // namespace

Controlled::Controlled(std::unique_ptr<Endpoint> device, const harness::Protocol& protocol,
                       ControlProgram program)
    : Forwarding(*device),
      device_(std::move(device)),
      protocol_(protocol),
      program_(std::move(program)),
      capabilities_(device_->capabilities()),
      starts_(device_->starts()),
      beside_(static_cast<bool>(program_)) {
  capabilities_.control = true;
  capabilities_.renews = !beside_;
  if (program_) return;
  program_.tell = [this](const std::string& line) { return device_->tell(line); };
  program_.answer = [this](Duration longest) { return device_->answer(longest); };
}

void Controlled::note_starts() {
  if (starts_ == to_.starts()) return;
  starts_ = to_.starts();
  told_ = declared_;
  mute_.clear();
}

/// Its answer. Errors: trouble, or what it refuses.
Result<json> Controlled::ask(const json& wish) {
  if (!mute_.empty()) return refuse(mute_);
  while (!program_.answer(0ns).empty()) {
  }  // what it has said unasked
  const std::string line = as_line(wish);
  if (const Status told = program_.tell(line); !told) {
    if (!beside_) return fail("--control: " + told.error().message);
    mute_ = "--control: " + told.error().message;
    return refuse(mute_);
  }
  const std::string said = program_.answer(answer_patience);
  if (said.empty()) {
    mute_ = fmt::format(
        "--control gave no answer to {} within {} s; it is to print one line, a JSON object, for "
        "each that it reads, and to flush it",
        line, answer_patience / 1s);
    return refuse(mute_);
  }
  json answer = json::parse(not_too_deep(said), nullptr, false);
  if (!answer.is_object())
    return refuse(fmt::format("--control: the answer to {} is no JSON object: {}", line, said));
  if (const auto error = answer.find("error"); error != answer.end())
    return refuse(fmt::format("--control refuses {}: {}", line,
                              error->is_string() ? error->get<std::string>() : error->dump()));
  return answer;
}

Status Controlled::begin(const json& config) {
  before_.clear();
  wanted_ = config;
  if (const Status begun = to_.begin(config); !begun) return begun;
  if (declared_.is_null()) declared_ = told_ = config;
  return tell_config();
}

/// What differs from what it was told last; after a restart from what it has then.
Status Controlled::tell_config() {
  note_starts();
  json wish = json::object();
  for (const auto& [key, value] : wanted_.items())
    if (!to_.configures(key) && !unsupported_.contains(key) && told_.value(key, json()) != value)
      wish[key] = value;
  for (const auto& [key, value] : told_.items())
    if (!wanted_.contains(key) && !to_.configures(key)) wish[key] = nullptr;
  if (wish.empty()) return ok();
  const Result<json> answer = ask({{"config", wish}});
  if (!answer) return answer.error();
  std::vector<std::string> refused;
  if (const auto no = answer->find("unsupported"); no != answer->end())
    for (const auto& [key, value] : wish.items())
      if (!no->is_array() || std::ranges::find(*no, json(key)) != no->end()) {
        unsupported_.insert(key);
        if (!value.is_null() && declared_.value(key, json()) != value) refused.push_back(key);
      }
  told_ = wanted_;
  if (refused.empty()) return ok();
  return refuse(fmt::format("needs {} = {}, which --control does not support", refused.front(),
                            wish[refused.front()].dump()));
}

bool Controlled::configures(std::string_view key) const {
  return to_.configures(key) || !unsupported_.contains(key);
}

/// A value may go on in the elements that follow.
std::vector<std::string> Controlled::elements(std::string_view address, std::size_t digits) const {
  const std::size_t count = digits / std::max<std::size_t>(1, element_digits(address, digits));
  const auto name = harness::read_element_name(address);
  std::vector<std::string> names{std::string(address)};
  for (std::size_t i = 1; i < count; ++i) {
    const Result<std::string> next = name ? harness::element_further_on(*name, i) : fail("");
    const auto moved = next ? std::optional(*next) : protocol_.moved(address, static_cast<int>(i));
    if (!moved) break;
    names.push_back(*moved);
  }
  return names;
}

Status Controlled::write(std::string_view address, std::string_view hex) {
  const std::vector<std::string> names = elements(address, hex.size());
  const std::size_t each = names.size() == 1 ? hex.size() : element_digits(address, hex.size());
  json values = json::object();
  for (std::size_t i = 0; i < names.size(); ++i) values[names[i]] = hex.substr(i * each, each);
  const Result<json> answer = ask({{"set", values}});
  if (!answer) return answer.error();
  if (answer->contains("unsupported"))
    return refuse(fmt::format("cannot set {}: --control does not support it", address));
  return ok();
}

Status Controlled::set(std::string_view address, std::string_view hex) {
  const Result<std::string> was = get(address, hex.size());
  if (!was && !was.error().refused) return was.error();
  if (was)
    before_.emplace_back(address, *was);
  else if (!capabilities_.can_power_cycle)  // one that ends with the run needs nothing put back
    return refuse(fmt::format("cannot set {}, since it could not be put back: {}", address,
                              was.error().message));
  return write(address, hex);
}

Result<std::string> Controlled::get(std::string_view address, std::size_t digits) {
  const std::vector<std::string> names = elements(address, digits);
  const Result<json> answer = ask({{"get", names}});
  if (!answer) return answer.error();
  if (answer->contains("unsupported"))
    return refuse(fmt::format("cannot look at {}: --control does not support it", address));
  const json values = values_in(*answer);
  std::string hex;
  for (const std::string& name : names) {
    const auto one = values.find(name);
    const bool text = one != values.end() && one->is_string();
    if (!text || !is_hex(one->get_ref<const std::string&>()))
      return refuse(
          fmt::format("--control: the answer {} has no hex digits for {}", answer->dump(), name));
    hex += upper(one->get<std::string>());
  }
  if (hex.size() != digits)
    return refuse(fmt::format("--control: {} is {} hex digits; the answer {} has {}", address,
                              digits, answer->dump(), hex.size()));
  return hex;
}

Status Controlled::act(std::string_view action) {
  if (action == "power_cycle" && capabilities_.can_power_cycle) {
    if (const Status done = to_.act(action); !done) return done;
    note_starts();
    return wanted_.is_null() ? ok() : tell_config();
  }
  const Result<json> answer = ask({{"do", action}});
  note_action(action);
  if (!answer) return answer.error();
  if (!answer->contains("unsupported")) return ok();
  return refuse(fmt::format("cannot do '{}': --control does not support it", action));
}

Status Controlled::renew() {
  if (!capabilities_.renews) return Endpoint::renew();
  const Result<json> answer = ask({{"do", "power_cycle"}});
  if (!answer) return answer.error();
  capabilities_.renews = !answer->contains("unsupported");
  if (!capabilities_.renews) return Endpoint::renew();
  to_.lose_links();
  told_["mode"] = nullptr;  // the one in which it comes up
  return ok();
}

/// What an action has changed is told again before the next case: "stop" changes the mode, "error
/// on" the error.
void Controlled::note_action(std::string_view action) {
  if (action == "power_cycle")
    told_ = declared_;
  else if (action == "run" || action == "stop")
    told_["mode"] = action;
  else
    told_[std::string(action.substr(0, action.find(' ')))] = action;
}

Status Controlled::put_back() {
  Status done = ok();
  for (const auto& [address, hex] : std::views::reverse(before_))
    if (const Status one = write(address, hex); !one && done) done = one;
  before_.clear();
  return done;
}

}  // namespace fieldproof::endpoints
