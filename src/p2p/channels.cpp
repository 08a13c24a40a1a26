#include "src/p2p/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "src/plc/config_reader.hpp"

namespace fieldproof::p2p {

namespace {

using nlohmann::json;

Result<P2pChannel> read_channel(const json& object, const std::string& what, unsigned highest,
                                std::string partner) {
  constexpr std::array<std::string_view, 5> keys{"channel", "partner", "port", "protocol",
                                                 "transport"};
  if (const Status known = plc::known_keys(object, what, keys); !known) return known.error();
  P2pChannel channel{.partner = std::move(partner)};
  bool datagrams = false;
  plc::ConfigReader reader(object, what);
  reader.whole("channel", highest, channel.number);
  reader.text("protocol", channel.protocol);
  reader.host("partner", channel.partner);
  reader.whole("port", 65'535u, channel.port);
  reader.either("transport", "udp", "tcp", datagrams);
  if (reader.error()) return *reader.error();
  if (channel.number == 0)
    return fail(fmt::format("cannot read {}: give its channel, 1 to {}", what, highest));
  if (datagrams) channel.transport = Transport::udp;
  return channel;
}

}  // namespace

Result<std::vector<P2pChannel>> parse_p2p_channels(const json& p2p, unsigned highest) {
  std::vector<P2pChannel> channels;
  const auto list = p2p.find("channels");
  if (list == p2p.end()) return channels;
  if (!list->is_array())
    return fail("cannot read p2p.channels: it is no list; give one object a channel");
  for (const json& object : *list) {
    const std::string what = fmt::format("p2p.channels[{}]", channels.size());
    Result<P2pChannel> one = read_channel(object, what, highest, p2p.value("partner", ""));
    if (!one) return one.error();
    if (std::ranges::find(channels, one->number, &P2pChannel::number) != channels.end())
      return fail(fmt::format("cannot read {}: channel {} is there twice; leave one out", what,
                              one->number));
    channels.push_back(std::move(*one));
  }
  return channels;
}

}  // namespace fieldproof::p2p
