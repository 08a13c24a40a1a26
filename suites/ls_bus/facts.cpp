#include "suites/ls_bus/facts.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "src/base/spelling.hpp"
#include "src/ls_bus/codec.hpp"
#include "src/ls_bus/parameters.hpp"

namespace fieldproof::ls_bus_suite {

using ls_bus::LsFault;

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 8> keys{"error",     "exists",    "first", "last",
                                               "max_frame", "max_words", "model", "write"};

std::optional<unsigned> address_in(const json& facts, const char* key) {
  const std::string text = facts.value(key, "");
  const std::optional<Bytes> bytes = from_hex(text);
  if (text.size() != 4 || !bytes || bytes->size() != 2) return std::nullopt;
  return (*bytes)[0] << 8 | (*bytes)[1];
}

Status check_parameters(const json& facts) {
  const std::optional<unsigned> first = address_in(facts, "first"),
                                last = address_in(facts, "last");
  if (!first || !last || *last < *first)
    return fail("first and last are parameter addresses of four hex digits");
  if (!facts.contains("write") && !facts.contains("exists"))
    return fail("a fact about parameters says write or exists");
  const ls_bus::InverterParameters parameters;
  for (unsigned address = *first; address <= *last; ++address) {
    const bool exists = parameters.exist(address, 1), write = parameters.writable(address, 1);
    if (exists != facts.value("exists", true))
      return fail(fmt::format("{:04X}: the table says that it {}", address,
                              exists ? "exists" : "does not exist"));
    if (write != facts.value("write", write))
      return fail(
          fmt::format("{:04X}: the table has it {}", address, write ? "writable" : "read only"));
  }
  return ok();
}

Status check_number(const json& facts, const char* key, std::size_t has) {
  if (const std::size_t due = facts.value(key, has); due != has)
    return fail(fmt::format("{}: the table has {}, the manual {}", key, has, due));
  return ok();
}

Status check_error(const std::string& code) {
  constexpr std::array known{LsFault::frame, LsFault::address, LsFault::data, LsFault::function,
                             LsFault::rights};
  if (std::ranges::any_of(known,
                          [&](LsFault fault) { return ls_bus::ls_error_code(fault) == code; }))
    return ok();
  return fail(fmt::format("the emulated inverter has no error code '{}'", code));
}

}  // namespace

Status check_fact(const json& facts) {
  for (const auto& [key, value] : facts.items())
    if (std::ranges::find(keys, key) == keys.end())
      return fail(fmt::format("unknown fact '{}'{}", key, suggestion(key, keys)));
  if (facts.value("model", "") != "inverter")
    return fail("a fact of the LS Bus has model inverter");
  if (facts.size() == 1) return fail("a fact says something besides its model");
  if (facts.contains("first") || facts.contains("last"))
    if (const Status right = check_parameters(facts); !right) return right;
  if (facts.contains("error"))
    if (const Status right = check_error(facts.value("error", "")); !right) return right;
  if (const Status right = check_number(facts, "max_words", ls_bus::ls_max_words); !right)
    return right;
  return check_number(facts, "max_frame", ls_bus::ls_max_frame);
}

}  // namespace fieldproof::ls_bus_suite
