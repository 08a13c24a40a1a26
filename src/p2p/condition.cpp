#include "src/p2p/condition.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

#include "src/base/letters.hpp"

namespace fieldproof::p2p {

namespace {
struct Clock {
  std::string_view mk, iec;  // device, keyword
  unsigned bit;              // of F word 9
  Duration period;
};
constexpr std::array clocks{Clock{"F90", "_T20MS", 0, 20ms}, Clock{"F92", "_T200MS", 2, 200ms},
                            Clock{"F93", "_T1S", 3, 1s}};
constexpr std::uint32_t clock_word = 9;

/// "F0092" and "F092" are F92.
std::string without_zeros(std::string text) {
  if (text.size() > 1) text.erase(1, text.find_first_not_of('0', 1) - 1);
  return text;
}

std::string clock_names(const plc::PlcModel& model) {
  std::string names;
  for (const Clock& clock : clocks)
    names += fmt::format("{}{} ({} ms)", names.empty() ? "" : ", ",
                         model.iec ? clock.iec : clock.mk, clock.period / 1ms);
  return names;
}

bool is_clock_bit(const Clock& clock, const plc::DeviceAddress& bit, const plc::PlcModel& model) {
  return !model.iec && model.areas[bit.area].letter == 'F' &&
         bit.index == clock_word * 16 + clock.bit;
}
}  // namespace

Result<P2pCondition> parse_p2p_condition(std::string_view flag, const plc::PlcModel& model) {
  const auto wrong = [&model](const std::string& what) {
    return fail(
        fmt::format("{}; give a bit such as %MX00000, or a clock: {}", what, clock_names(model)));
  };
  if (flag.empty()) return wrong("there is no flag");
  const std::string name = upper(std::string(flag));
  for (const Clock& clock : clocks)
    if (model.iec ? name == clock.iec : without_zeros(name) == clock.mk)
      return P2pCondition{{}, clock.period};
  const plc::ParsedAddress parsed = plc::parse_address(model, flag);
  if (!parsed)
    return wrong(fmt::format("flag '{}' is no bit of {}: {}", flag, model.name,
                             plc::describe(parsed.fault)));
  if (parsed.address.type != 'X')
    return wrong(fmt::format("flag '{}' is no bit: its type is {}", flag, parsed.address.type));
  for (const Clock& clock : clocks)
    if (is_clock_bit(clock, parsed.address, model)) return P2pCondition{{}, clock.period};
  return P2pCondition{parsed.address};
}

}  // namespace fieldproof::p2p
