#include "src/xnet_network/check_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "src/base/duration.hpp"
#include "src/xnet_motion/motion_bus.hpp"
#include "src/xnet_network/instruction.hpp"
#include "src/xnet_network/port_results.hpp"

namespace fieldproof::xnet {

namespace {

constexpr std::array<std::string_view, 8> plain_actions{
    "run", "stop", "power_cycle", "on", "off", "noise on", "noise off", "release"};

}  // namespace

Error unknown_action(std::string_view action) {
  return fail(fmt::format(
      "cannot do '{}': a PLC on X-NET can run, stop, power_cycle, on, off, noise on, noise off, "
      "slow 20ms, modbus port 2 address error, free format port 2 send correct, BIT_READ, "
      "BIT_WRITE, REG_READ, REG_WRITE, hold one of them, release; 'B: off' is of B",
      action));
}

Error unknown_counter(std::string_view address) {
  return fail(fmt::format("cannot read {}: write @U0-62 of servo 1", address));
}

TextCheck::TextCheck(std::string_view model, const nlohmann::json& config) {
  plcs_.emplace_back("A", find_model(model));
  const nlohmann::json stations = config.value("stations", nlohmann::json::array());
  for (const nlohmann::json& one : stations) {
    const std::string letter(1, static_cast<char>('A' + plcs_.size() % 26));
    known_ = known_ && one.is_object() && plcs_.size() < 26;
    if (!known_) return;
    const auto text = [&](const char* key, const std::string& otherwise) {
      const auto found = one.find(key);
      return found != one.end() && found->is_string() ? found->get<std::string>() : otherwise;
    };
    plcs_.emplace_back(text("name", letter), find_model(text("model", "xd3")));
  }
  known_ = std::ranges::none_of(plcs_, [](const auto& one) { return one.second == nullptr; });
}

const Model* TextCheck::addressed(std::string_view& text) const {
  const std::size_t colon = text.find(':');
  if (colon == text.npos) return plcs_.front().second;
  const auto named = std::ranges::find_if(
      plcs_, [&](const auto& one) { return one.first == text.substr(0, colon); });
  text.remove_prefix(colon + 1);
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  return named == plcs_.end() ? nullptr : named->second;
}

Status TextCheck::address(std::string_view address, std::size_t digits) const {
  if (!known_) return ok();
  std::string_view own = address;
  const Model* const model = addressed(own);
  if (!model) return fail(fmt::format("cannot reach {}: there is no such PLC", address));
  if (own == "@turns") return ok();
  if (own.starts_with("@U0-"))
    return MotionBus::is_counter(own.substr(1)) ? ok() : Status(unknown_counter(address));
  const Result<std::string> read = blank_memory(*model).get(own, digits);
  return read ? ok() : Status(read.error());
}

Status TextCheck::action(std::string_view action) const {
  if (!known_) return ok();
  std::string_view what = action;
  const Model* const model = addressed(what);
  if (!model) return fail(fmt::format("cannot do '{}': there is no such PLC", action));
  if (std::ranges::count(plain_actions, what) > 0 || what.starts_with("release ")) return ok();
  constexpr std::string_view hold = "hold ", slow_by = "slow ";
  if (what.starts_with(slow_by)) {
    const Result<Duration> late = parse_duration(what.substr(slow_by.size()));
    return late ? ok() : Status(late.error());
  }
  if (is_port_result(what)) return check_port_result(what, *model);
  if (what.starts_with(hold)) what.remove_prefix(hold.size());
  if (!is_instruction(what) && !MotionBus::knows(what)) return unknown_action(action);
  return check_instruction(what, *model);
}

}  // namespace fieldproof::xnet
