#include "harness/explore/vector_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace fieldproof::explore {

using nlohmann::ordered_json;
using vectors::Case;
using vectors::PartnerSpec;
using vectors::Step;

namespace {

ordered_json object_of(const std::vector<std::pair<std::string, std::string>>& memory) {
  ordered_json object = ordered_json::object();
  for (const auto& [address, hex] : memory) object[address] = hex;
  return object;
}

ordered_json object_of(const PartnerSpec& spec) {
  ordered_json partner = spec.config;
  if (!spec.memory.empty()) partner["memory"] = object_of(spec.memory);
  if (!spec.fault.empty()) partner["fault"] = spec.fault;
  return partner;
}

ordered_json object_of(const Step& step) {
  ordered_json one;
  switch (step.kind) {
    case Step::Kind::send: one["send"] = step.frames.front().text; break;
    case Step::Kind::expect:
      one["expect"] = step.frames.front().text;
      if (step.partner) one["partner"] = object_of(*step.partner);
      break;
    case Step::Kind::silence: one["silence"] = true; break;
    case Step::Kind::expect_close: one["expect_close"] = "any"; break;
    case Step::Kind::wait: one["wait"] = fmt::format("{:.0f}ms", to_ms(step.duration)); break;
    case Step::Kind::set: one["set"] = object_of(step.memory); break;
    case Step::Kind::check: one["check"] = object_of(step.memory); break;
    case Step::Kind::act: one["do"] = step.action; break;
    case Step::Kind::open: one["open"] = step.on; return one;
    default: break;  // no sequence has such
  }
  if (!step.on.empty()) one["on"] = step.on;
  return one;
}

}  // namespace

std::string vector_text(const Case& source) {
  ordered_json steps = ordered_json::array();
  for (const Step& step : source.steps) steps.push_back(object_of(step));
  ordered_json vector{{"id", source.id}, {"title", source.title}};
  vector["source"] = {{"manual", source.source.manual},
                      {"section", source.source.section},
                      {"quote", source.source.quote}};
  vector["level"] = source.level;
  vector["basis"] = source.basis;
  if (!source.decisions.empty()) {
    vector["decision"] = ordered_json::array();
    for (const vectors::Decision& one : source.decisions) vector["decision"].push_back(one.id);
  }
  vector["why"] = source.why;
  if (!source.config.empty()) vector["given"]["config"] = source.config;
  if (!source.memory.empty()) vector["given"]["memory"] = object_of(source.memory);
  vector["steps"] = std::move(steps);
  if (!source.transpose) vector["transpose"] = false;
  return ordered_json::array({vector}).dump(2) + "\n";
}

}  // namespace fieldproof::explore
