#include "suites/hs_link/facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "src/hs_link/flags.hpp"
#include "src/hs_link/parameter.hpp"
#include "src/plc/config_reader.hpp"

namespace fieldproof::hs_link_suite {

namespace {

using hs_link::Flag;
using nlohmann::json;

constexpr std::array<std::pair<std::string_view, Flag>, 7> flags{{{"rlink", Flag::rlink},
                                                                  {"ltrbl", Flag::ltrbl},
                                                                  {"state", Flag::state},
                                                                  {"mod", Flag::mod},
                                                                  {"trx", Flag::trx},
                                                                  {"err", Flag::err},
                                                                  {"setblock", Flag::setblock}}};

/// "%LX032" is %LX32.
std::string without_zeros(std::string text) {
  const std::size_t first = text.find_first_of("0123456789");
  if (first == text.npos) return text;
  const std::size_t digits = std::min(text.find_first_not_of('0', first), text.size() - 1);
  return text.erase(first, digits - first);
}

Status compare(const char* what, const std::string& printed, const std::string& held) {
  if (printed.empty() || printed == held) return ok();
  return fail(fmt::format("{}: the manual prints {}, the table has {}", what, printed, held));
}

Status check_flag(const json& facts) {
  constexpr std::array<std::string_view, 5> keys{"block", "flag", "hs_link", "iec", "mk"};
  constexpr const char* what = "a fact of the high-speed link";
  if (const Status known = plc::known_keys(facts, what, keys); !known) return known;
  unsigned link = 1, block = 0;
  std::string name, mk, iec;
  plc::ConfigReader reader(facts, what);
  reader.whole("hs_link", 2, link);
  reader.whole("block", hs_link::most_blocks - 1, block);
  reader.text("flag", name);
  reader.text("mk", mk);
  reader.text("iec", iec);
  if (reader.error()) return *reader.error();
  const auto flag = std::ranges::find(flags, name, &std::pair<std::string_view, Flag>::first);
  if (flag == flags.end() || link == 0 || (mk.empty() && iec.empty()))
    return fail(
        "a fact of the high-speed link names hs_link (1, 2), flag (rlink, ltrbl, state, mod, trx, "
        "err, setblock), and mk or iec");
  const unsigned bit =
      hs_link::flag_address(plc::plc_models().front(), link, flag->second, block).index;
  if (const Status same = compare("mk", mk, fmt::format("L{:04}{:X}", bit / 16, bit % 16)); !same)
    return same;
  return compare("iec", without_zeros(iec), iec.empty() ? "" : fmt::format("%LX{}", bit));
}

Status check_parameter(const json& facts) {
  constexpr std::array<std::string_view, 3> keys{"accepted", "parameter", "station"};
  constexpr const char* what = "a fact of the high-speed link parameter";
  if (const Status known = plc::known_keys(facts, what, keys); !known) return known;
  unsigned station = 1;
  bool accepted = true;
  plc::ConfigReader reader(facts, what);
  reader.whole("station", 255, station);
  reader.boolean("accepted", accepted);
  if (reader.error()) return *reader.error();
  const Result<hs_link::Parameter> read =
      hs_link::read_parameter(facts["parameter"], station, plc::plc_models().front());
  if (bool(read) == accepted) return ok();
  return accepted ? Status(read.error()) : Status(fail("the parameter is accepted"));
}

}  // namespace

Status check_fact(const json& facts) {
  return facts.contains("parameter") ? check_parameter(facts) : check_flag(facts);
}

}  // namespace fieldproof::hs_link_suite
