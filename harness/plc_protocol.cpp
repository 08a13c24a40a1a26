#include "harness/plc_protocol.hpp"

namespace fieldproof::harness {

std::vector<std::string> PlcProtocol::models() const {
  std::vector<std::string> names;
  for (const plc::PlcModel& one : plc::plc_models()) names.emplace_back(one.name);
  return names;
}

std::uint32_t PlcProtocol::words_of(std::string_view area) const {
  const plc::DeviceArea* found = area.size() == 1 ? model().area(area[0]) : nullptr;
  return found ? found->words : 0;
}

std::vector<Protocol::Area> PlcProtocol::areas() const {
  std::vector<Area> areas;
  for (char letter = 'A'; letter <= 'Z'; ++letter)
    if (std::vector<std::uint32_t> ends = plc::last_words_of(letter); !ends.empty())
      areas.push_back({std::string(1, letter), std::move(ends)});
  return areas;
}

}  // namespace fieldproof::harness
