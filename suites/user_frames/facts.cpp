#include "suites/user_frames/facts.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "src/plc/config_reader.hpp"
#include "src/user_frames/definition.hpp"

namespace fieldproof::user_frames_suite {

namespace {

using nlohmann::json;

constexpr std::string_view what = "a fact";

Status check_limit(const json& facts) {
  constexpr std::array<std::string_view, 2> keys{"limit", "value"};
  if (const Status known = plc::known_keys(facts, what, keys); !known) return known.error();
  const std::string limit = facts["limit"].is_string() ? facts["limit"].get<std::string>() : "";
  const std::size_t held = limit == "frame_bytes"      ? user_frames::max_frame
                           : limit == "constant_bytes" ? user_frames::max_constant
                           : limit == "variables"      ? user_frames::max_variables
                                                       : 0;
  if (held == 0) return fail("a fact has limit frame_bytes, constant_bytes or variables");
  return facts.value("value", json()) == held
             ? ok()
             : fail(fmt::format("{} are limited to {}, not {}", limit, held,
                                facts.value("value", json()).dump()));
}

Status check_method(const json& facts) {
  constexpr std::array<std::string_view, 2> keys{"bytes", "check"};
  if (const Status known = plc::known_keys(facts, what, keys); !known) return known.error();
  const user_frames::CheckMethodFacts* method =
      facts["check"].is_string() ? user_frames::find_check_method(facts["check"].get<std::string>())
                                 : nullptr;
  if (!method) return fail("there is no check " + facts["check"].dump());
  return facts.value("bytes", json()) == method->bytes
             ? ok()
             : fail(fmt::format("{} has {} bytes, not {}", method->name, method->bytes,
                                facts.value("bytes", json()).dump()));
}

Status check_definition(const json& facts) {
  constexpr std::array<std::string_view, 2> keys{"definition", "refused"};
  if (const Status known = plc::known_keys(facts, what, keys); !known) return known.error();
  const Result<user_frames::FrameDefinition> definition =
      user_frames::parse_frame_definition(facts["definition"].dump(), "definition");
  const auto refused = facts.find("refused");
  if (refused == facts.end()) return definition ? ok() : Status(definition.error());
  if (!refused->is_string()) return fail("refused is no text");
  if (definition) return fail("the definition is accepted");
  if (definition.error().message.find(refused->get<std::string>()) != std::string::npos)
    return ok();
  return fail("the definition is refused otherwise: " + definition.error().message);
}

}  // namespace

Status check_fact(const json& facts) {
  if (facts.contains("limit")) return check_limit(facts);
  if (facts.contains("check")) return check_method(facts);
  if (facts.contains("definition")) return check_definition(facts);
  return fail("a fact about user-defined frames has limit, check or definition");
}

}  // namespace fieldproof::user_frames_suite
