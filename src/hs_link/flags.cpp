#include "src/hs_link/flags.hpp"

#include <algorithm>

namespace fieldproof::hs_link {

namespace {

/// First word behind that of the link.
unsigned first_word(Flag flag) {
  switch (flag) {
    case Flag::rlink:
    case Flag::ltrbl: return 0;
    case Flag::state: return 2;
    case Flag::mod: return 6;
    case Flag::trx: return 10;
    case Flag::err: return 14;
    case Flag::setblock: return 18;
  }
  return 0;
}

}  // namespace

plc::DeviceAddress flag_address(const plc::PlcModel& model, unsigned link, Flag flag,
                                unsigned block) {
  const auto area = std::ranges::find(model.areas, 'L', &plc::DeviceArea::letter);
  const unsigned bit = flag == Flag::ltrbl ? 1 : block;
  const unsigned word = (link == 2 ? 26 : 0) + first_word(flag);
  return {static_cast<std::uint8_t>(area - model.areas.begin()), 'X', false, word * 16 + bit};
}

}  // namespace fieldproof::hs_link
