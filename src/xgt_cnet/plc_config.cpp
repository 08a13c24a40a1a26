#include "src/xgt_cnet/plc_config.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

namespace fieldproof {

namespace {
using nlohmann::json;

constexpr std::array<std::string_view, 5> p2p_keys{"count", "flag", "read", "save", "station"};

Result<P2pConfig> parse_p2p(const json& object, std::size_t number) {
  const std::string what = fmt::format("p2p block {}", number);
  if (const Status status = known_keys(object, what, p2p_keys); !status) return status.error();
  for (const char* key : {"flag", "read", "save", "station"}) {
    if (object.contains(key)) continue;
    return fail(fmt::format("cannot read {}: there is no {}; give flag, read, save and station", what, key));
  }
  P2pConfig block;
  ConfigReader reader(object, what);
  reader.text("flag", block.flag);
  reader.text("read", block.read);
  reader.text("save", block.save);
  reader.whole("station", 255, block.station);
  reader.whole("count", 120, block.count);
  if (reader.error()) return *reader.error();
  return block;
}

Status parse_p2p_blocks(const json& value, std::vector<P2pConfig>& to) {
  if (!value.is_array()) return fail("cannot read the PLC's configuration: p2p is not an array of blocks");
  for (const json& object : value) {
    Result<P2pConfig> block = parse_p2p(object, to.size());
    if (!block) return block.error();
    to.push_back(std::move(*block));
  }
  return ok();
}
}  // namespace

Result<PlcConfig> parse_plc_config(std::string_view model, const json& config) {
  constexpr std::string_view what = "the PLC's configuration";
  if (const Status status = known_keys(config, what, port_keys({"p2p", "time_out"})); !status) return status.error();
  PlcConfig plc;
  plc.model = model;
  ConfigReader reader(config, std::string(what));
  read_port_config(reader, plc);
  reader.whole("time_out", 50, plc.time_out);
  if (reader.error()) return *reader.error();
  if (const auto p2p = config.find("p2p"); p2p != config.end()) {
    if (const Status status = parse_p2p_blocks(*p2p, plc.p2p); !status) return status.error();
  }
  return plc;
}

}  // namespace fieldproof
