#include "src/hs_link/parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "src/plc/config_reader.hpp"

namespace fieldproof::hs_link {

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 4> keys{"blocks", "enable", "link", "period_ms"};
constexpr std::array<std::string_view, 5> block_keys{"area", "block", "mode", "size", "station"};

Error wrong(const std::string& what) {
  return fail(fmt::format("cannot read the high-speed link parameter: {}", what));
}

Result<plc::DeviceAddress> read_area(const std::string& name, unsigned words,
                                     const plc::PlcModel& model) {
  const plc::ParsedAddress parsed = plc::parse_address(model, name);
  if (!parsed || parsed.address.type != 'W')
    return wrong(
        fmt::format("the area '{}' is no word of {}; write it as %MW100", name, model.name));
  if (!plc::fits(model, parsed.address, words))
    return wrong(fmt::format("{} words from {} on are past the end of the area", words, name));
  return parsed.address;
}

Result<Block> read_block(const json& object, unsigned own, const plc::PlcModel& model) {
  constexpr const char* what = "a block of the high-speed link";
  if (const Status known = plc::known_keys(object, what, block_keys); !known) return known.error();
  Block block;
  block.station = own;
  std::string area;
  plc::ConfigReader reader(object, what);
  reader.either("mode", "send", "receive", block.sends);
  reader.whole("station", last_station, block.station);
  reader.whole("block", most_blocks - 1, block.number);
  reader.whole("size", most_words, block.words);
  reader.text("area", area);
  if (reader.error()) return *reader.error();
  if (block.words == 0) return wrong("a block of 0 words; give it 1 to 200");
  if (block.sends && block.station != own)
    return wrong(
        fmt::format("a block that is sent is of station {}, not of {}", own, block.station));
  if (!block.sends && !object.contains("station"))
    return wrong("a block that is received names no station; write which one sends it");
  const Result<plc::DeviceAddress> first = read_area(area, block.words, model);
  if (!first) return first.error();
  block.area = *first;
  return block;
}

Status check_counts(const std::vector<Block>& blocks) {
  const auto sent = static_cast<std::size_t>(std::ranges::count(blocks, true, &Block::sends));
  if (blocks.size() > most_blocks)
    return wrong(fmt::format("{} blocks; a link has at most {}", blocks.size(), most_blocks));
  if (sent > most_one_way || blocks.size() - sent > most_one_way)
    return wrong(fmt::format("{} blocks to send and {} to receive; each at most {}", sent,
                             blocks.size() - sent, most_one_way));
  return ok();
}

Status read_blocks(const json& list, const plc::PlcModel& model, Parameter& parameter) {
  if (!list.is_array()) return wrong("\"blocks\" is no list");
  for (const json& one : list) {
    Result<Block> block = read_block(one, parameter.station, model);
    if (!block) return block.error();
    parameter.blocks.push_back(*block);
  }
  return check_counts(parameter.blocks);
}

}  // namespace

Result<Parameter> read_parameter(const json& object, unsigned station, const plc::PlcModel& model) {
  constexpr const char* what = "the high-speed link parameter";
  if (const Status known = plc::known_keys(object, what, keys); !known) return known.error();
  Parameter parameter;
  parameter.station = station;
  plc::ConfigReader reader(object, what);
  reader.whole("link", 2, parameter.link);
  reader.milliseconds("period_ms", parameter.period);
  reader.boolean("enable", parameter.enabled);
  if (reader.error()) return *reader.error();
  if (parameter.link == 0) return wrong("link 0; there are links 1 and 2");
  if (station > last_station)
    return wrong(fmt::format("station {}; stations are 0 to {}", station, last_station));
  if (parameter.period < shortest_period || parameter.period > longest_period)
    return wrong("the period is 20 ms to 10 s");
  if (object.contains("blocks"))
    if (const Status read = read_blocks(object["blocks"], model, parameter); !read)
      return read.error();
  return parameter;
}

}  // namespace fieldproof::hs_link
