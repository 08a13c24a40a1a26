#include "harness/exchange/client_program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>

#include "harness/exchange/p2p_blocks.hpp"
#include "harness/exchange/prepared_case.hpp"
#include "src/base/nesting.hpp"

namespace fieldproof::exchange {

namespace {

using nlohmann::json;
using vectors::Step;

/// In the order of the README.
constexpr std::array<std::string_view, 16> abilities{
    "clock",   "memory",   "busy",      "mode",   "link",           "power_cycle",
    "channel", "time_out", "delay",     "frames", "character_time", "write_order",
    "line",    "names",    "transport", "mail"};

struct Told {
  std::string_view key, as;
};
constexpr std::array<Told, 8> told{{{"mode", "mode"},
                                    {"time_out", "time_out"},
                                    {"delay_ms", "delay"},
                                    {"rs485", "delay"},
                                    {"inter_character_ms", "character_time"},
                                    {"write_order", "write_order"},
                                    {"line", "line"},
                                    {"bench_line", "line"}}};

/// The settings of mails in `p2p`, of whatever protocol the blocks are.
constexpr const char* mail_key = "email";

bool sets_flag(const Step& step, const std::string& flag) {
  return step.kind == Step::Kind::set &&
         std::ranges::any_of(step.memory, [&](const auto& one) { return one.first == flag; });
}

/// Does the partner leave the request without an answer that the client takes for one?
bool unanswered_by(const vectors::PartnerSpec& partner) {
  return partner.fault == "never" || partner.fault == "late";
}

/// A request is left without an answer, and the case goes on with another on its link: how long the
/// client waits shows.
bool waits_out(const vectors::Case& source) {
  std::map<std::string, bool> of_links;
  for (const Step& step : source.steps) {
    bool& open = of_links[step.on];
    if (step.kind == Step::Kind::send) open = false;
    if (step.kind == Step::Kind::partner) open = unanswered_by(*step.partner);
    if (step.kind != Step::Kind::expect) continue;
    if (open || (step.times > 1 && !step.partner)) return true;
    open = !step.partner || unanswered_by(*step.partner);
  }
  return false;
}

/// A flag rises while the answer to a request is still due.
bool fires_while_busy(const vectors::Case& source, const std::vector<json>& blocks) {
  bool open = false;
  for (const Step& step : source.steps) {
    if (step.kind == Step::Kind::expect) open = !step.partner;
    if (step.kind == Step::Kind::send || step.kind == Step::Kind::partner ||
        step.kind == Step::Kind::wait)
      open = false;
    const bool fires = std::ranges::any_of(
        blocks, [&](const json& block) { return sets_flag(step, flag_of(block)); });
    if (open && fires) return true;
  }
  return false;
}

/// A name of the partner that a module would send otherwise: with zeros in front of its number.
bool is_padded(const std::string& name) {
  const std::size_t digit = name.find_first_of("0123456789");
  return name.starts_with('%') && digit != std::string::npos && name[digit] == '0' &&
         digit + 1 < name.size() && name[digit + 1] != '.';
}

std::vector<std::string> texts(const json& block, const char* key) {
  return block.contains(key) ? block[key].get<std::vector<std::string>>()
                             : std::vector<std::string>();
}

/// What one block saves fires, or is sent by, another one; or memory changes under a clock.
bool needs_memory(const vectors::Case& source, const std::vector<json>& blocks,
                  const SameMemory& same_memory) {
  const auto shared = [&](const std::vector<std::string>& addresses, const std::string& one) {
    return std::ranges::any_of(addresses,
                               [&](const std::string& other) { return same_memory(one, other); });
  };
  for (const json& block : blocks) {
    std::vector<std::string> used = sent_addresses(block);
    if (!flag_of(block).empty() && !runs_by_clock(block)) used.push_back(flag_of(block));
    for (const json& other : blocks)
      if (other.value("function", "") == "read")
        for (const std::string& saved : texts(other, "save"))
          if (shared(used, saved)) return true;
    if (!runs_by_clock(block)) continue;
    for (const Step& step : source.steps)
      if (step.kind == Step::Kind::set)
        for (const auto& [address, hex] : step.memory)
          if (shared(sent_addresses(block), address)) return true;
  }
  return false;
}

}  // namespace

bool has_mail(const json& p2p) { return p2p.is_object() && p2p.contains(mail_key); }

ClientProgram program_of(os::LineProgram& stimulus) {
  return {[&stimulus](const std::string& line) { return stimulus.tell(line); },
          [&stimulus](Duration patience) { return stimulus.answer(patience); },
          [&stimulus] { return stimulus.restart(); }};
}

ClientProgram program_of(endpoints::Endpoint& endpoint) {
  return {[&endpoint](const std::string& line) { return endpoint.tell(line); },
          [&endpoint](Duration patience) { return endpoint.answer(patience); },
          [&endpoint] { return endpoint.act("power_cycle"); }};
}

Result<Declared> read_declaration(const std::string& answer) {
  if (answer.empty()) return Declared{};
  const auto wrong = [&](const std::string& why) {
    return fail(
        fmt::format("the program of --stimulus answers '{}': {}; right is {{\"follows\": "
                    "[...], \"time_out_ms\": 200}} with any of {}",
                    answer.substr(0, 200), why, fmt::join(abilities, ", ")));
  };
  const json said = json::parse(not_too_deep(answer), nullptr, false);
  if (!said.is_object()) return wrong("this is no JSON object");
  const json follows = said.value("follows", json());
  if (!follows.is_array()) return wrong("\"follows\" is not a list");
  Declared declared{true, {}, {}};
  for (const json& one : follows) {
    if (!one.is_string() || std::ranges::find(abilities, one.get<std::string>()) == abilities.end())
      return wrong(one.dump() + " is nothing that it could follow");
    declared.follows.insert(one.get<std::string>());
  }
  const json time_out = said.value("time_out_ms", json(0u));
  if (!time_out.is_number_unsigned() || time_out > 60'000)
    return wrong("\"time_out_ms\" is not 0 to 60000");
  declared.time_out = time_out.get<int>() * 1ms;
  return declared;
}

std::set<std::string> needs_of(const vectors::Case& source, bool on_a_line,
                               const SameMemory& same_memory) {
  std::set<std::string> needs;
  const std::vector<json> blocks = p2p_blocks(source.config);
  const json p2p = source.config.value("p2p", json::object());
  for (const json& block : blocks) {
    const std::string function = block.value("function", "");
    if (runs_by_clock(block)) needs.insert("clock");
    if (std::ranges::any_of(texts(block, function == "write" ? "save" : "read"), is_padded))
      needs.insert("names");
    if (function == "send" || function == "receive") needs.insert("frames");
    if (block.contains("data")) needs.insert("memory");
    if (on_a_line && block.contains("channel") && block["channel"] != number_of(p2p, "channel", 1))
      needs.insert("channel");
  }
  if (has_mail(p2p)) needs.insert("mail");
  if (asks_by_datagrams(source.config)) needs.insert("transport");
  if (!p2p.value("link", true)) needs.insert("link");
  if (source.config.value("mode", "run") != "run") needs.insert("mode");
  for (const Step& step : source.steps) {
    if (step.action.starts_with("link")) needs.insert("link");
    if (step.action.starts_with("error")) needs.insert("mail");
    if (step.action == "stop" || step.action == "run") needs.insert("mode");
    if (step.action == "power_cycle") needs.insert("power_cycle");
    if (step.action.starts_with("send ")) needs.insert("frames");
  }
  if (waits_out(source)) needs.insert("time_out");
  if (fires_while_busy(source, blocks)) needs.insert("busy");
  if (needs_memory(source, blocks, same_memory)) needs.insert("memory");
  return needs;
}

std::string_view told_as(std::string_view config_key) {
  const auto found = std::ranges::find(told, config_key, &Told::key);
  return found == told.end() ? std::string_view() : found->as;
}

Duration client_time_out(const json& config, bool on_a_line) {
  if (!on_a_line) return 5s;
  return (number_of(config, "time_out", 1) + 1) * 100ms;
}

json set_up_of(const vectors::Case& source, bool on_a_line) {
  const json& config = source.config;
  const json p2p = config.value("p2p", json::object());
  json begin{{"mode", config.value("mode", "run")},
             {"link", p2p.value("link", true)},
             {"channel", number_of(p2p, "channel", 1)},
             {"station", number_of(config, "station", 0)},
             {"time_out_ms", client_time_out(config, on_a_line) / 1ms},
             {"delay_ms", number_of(config, "delay_ms", 0)},
             {"inter_character_ms", number_of(config, "inter_character_ms", 0)},
             {"rs485", config.value("rs485", false)},
             {"blocks", p2p_blocks(config)},
             {"memory", json::object()}};
  for (const char* key : {"write_order", "line"})
    if (config.contains(key)) begin[key] = config[key];
  if (has_mail(p2p)) begin["mail"] = p2p[mail_key];
  for (const auto& [address, hex] : source.memory) begin["memory"][address] = hex;
  return begin;
}

}  // namespace fieldproof::exchange
