#include "src/xgt_fenet/remote.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "src/base/spelling.hpp"
#include "src/plc/config_reader.hpp"

namespace fieldproof::xgt_fenet {

namespace {

constexpr std::size_t deepest = 2;
constexpr std::array<std::string_view, 5> networks{"rnet", "fdnet", "cnet", "fenet", "fdenet"};
constexpr std::array<std::string_view, 4> keys{"base", "ip", "network", "slot"};

bool is_ethernet(const std::string& network) { return network == "fenet" || network == "fdenet"; }

Result<RemoteStage> read_stage(const nlohmann::json& object, const std::string& what) {
  if (const Status known = plc::known_keys(object, what, keys); !known) return known.error();
  RemoteStage stage{.network = "fenet"};
  plc::ConfigReader reader(object, what);
  reader.text("network", stage.network);
  reader.whole("base", 15, stage.base);
  reader.whole("slot", 15, stage.slot);
  reader.text("ip", stage.ip);
  if (reader.error()) return *reader.error();
  const auto wrong = [&](const std::string& why) {
    return fail(fmt::format("cannot read {}: {}", what, why));
  };
  if (std::ranges::find(networks, stage.network) == networks.end())
    return wrong(fmt::format("network is '{}'; use one of {}{}", stage.network,
                             fmt::join(networks, ", "), suggestion(stage.network, networks)));
  if (is_ethernet(stage.network) && !plc::is_ipv4(stage.ip))
    return wrong(fmt::format("ip is '{}'; give the IPv4 address of the module in the distant PLC",
                             stage.ip));
  if (!is_ethernet(stage.network) && !stage.ip.empty())
    return wrong(fmt::format("a module of {} has no ip; remove the key", stage.network));
  return stage;
}

}  // namespace

Result<std::vector<RemoteStage>> read_remote(const nlohmann::json& stages) {
  if (!stages.is_array() || stages.empty())
    return fail("cannot read remote: give a list of remote 1, and of remote 2 behind it");
  if (stages.size() > deepest)
    return fail(
        fmt::format("cannot read remote: it has {} stages; over remote 2 is not available "
                    "(FEnet EN 9.2.4)",
                    stages.size()));
  std::vector<RemoteStage> read;
  for (const nlohmann::json& one : stages) {
    Result<RemoteStage> stage = read_stage(one, fmt::format("remote {}", read.size() + 1));
    if (!stage) return stage.error();
    read.push_back(std::move(*stage));
  }
  return read;
}

}  // namespace fieldproof::xgt_fenet
