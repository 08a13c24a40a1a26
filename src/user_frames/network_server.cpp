#include "src/user_frames/network_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/plc/port_config.hpp"

namespace fieldproof::user_frames {

namespace {

constexpr std::string_view whose = "the user frame server's configuration";

/// Behind a datagram: its end is that of the frame.
constexpr Duration datagram_gap{1};

}  // namespace

Status check_network_port(unsigned port) {
  const bool own = port == 502 || (port >= 2002 && port <= 2006);
  if (port >= first_network_port && port <= 65535 && !own) return ok();
  return fail(
      fmt::format("port is {}; user-defined frames have 1024 and up, but not 502 and 2002 "
                  "to 2006, which are the module's own",
                  port));
}

UserFrameServer::UserFrameServer(const FrameDefinition& definition, plc::PlcMemory& memory,
                                 std::uint16_t port, bool run)
    : definition_(definition), memory_(memory), port_(port), run_(run) {}

std::unique_ptr<UserFramePort> UserFrameServer::new_port(bool datagrams) const {
  plc::PortConfig config;
  config.inter_character = datagrams ? datagram_gap : network_gap;
  auto port = std::make_unique<UserFramePort>(definition_, memory_, config);
  port->set_run(run_);
  return port;
}

UserFrameServer::Partner& UserFrameServer::partner(LinkId link, bool datagrams) {
  last_ = link;
  Partner& one = partners_[link];
  if (!one.port) one = {new_port(datagrams), datagrams};
  return one;
}

template <typename Work>
void UserFrameServer::counting(UserFramePort& port, Work work) {
  const plc::ServiceCounters before = port.counters();
  work();
  const plc::ServiceCounters& now = port.counters();
  counters_.services += now.services - before.services;
  counters_.errors += now.errors - before.errors;
  // A partner of whom nothing was counted does not say what the last frame was.
  if (now.services != before.services || now.errors != before.errors) counters_.status = now.status;
}

void UserFrameServer::receive(const Burst& burst) {
  now_ = std::max(now_, burst.start);
  switch (burst.event) {
    case LinkEvent::opened: partner(burst.link, false); return;
    case LinkEvent::closed: return end(burst.link);
    case LinkEvent::reset: partners_.erase(burst.link); return;
    case LinkEvent::data:
      if (!partners_.contains(burst.link)) return end(burst.link);
      break;
    case LinkEvent::datagram: break;
  }
  Partner& from = partner(burst.link, burst.event == LinkEvent::datagram);
  counting(*from.port, [&] { from.port->receive(burst); });
  if (from.datagrams) speak(burst.link, from, burst.start + 2 * datagram_gap);
}

/// What it has to say, until then.
void UserFrameServer::speak(LinkId link, Partner& partner, Time until) {
  for (;;) {
    Bytes bytes;
    counting(*partner.port, [&] { bytes = partner.port->advance(until); });
    if (bytes.empty()) return;
    doings_.push_back({.bytes = std::move(bytes),
                       .start = now_,
                       .link = link,
                       .event = partner.datagrams ? LinkEvent::datagram : LinkEvent::data});
  }
}

std::optional<Time> UserFrameServer::wake_at() const {
  if (!doings_.empty()) return now_;
  std::optional<Time> first;
  for (const auto& [link, partner] : partners_)
    if (const auto wake = partner.port->wake_at(); wake && (!first || *wake < *first)) first = wake;
  return first;
}

std::vector<Burst> UserFrameServer::advance(Time now) {
  now_ = std::max(now_, now);
  for (auto& [link, partner] : partners_) speak(link, partner, now_);
  return std::exchange(doings_, {});
}

void UserFrameServer::end(LinkId link) {
  doings_.push_back({.bytes = {}, .start = now_, .link = link, .event = LinkEvent::reset});
  partners_.erase(link);
}

void UserFrameServer::power_cycle() {
  counters_ = {};
  partners_.clear();
  doings_.clear();
}

void UserFrameServer::set_run(bool run) {
  run_ = run;
  for (auto& [link, partner] : partners_) partner.port->set_run(run);
}

std::optional<Status> UserFrameServer::act(std::string_view action) {
  const auto last = partners_.find(last_);
  if (last == partners_.end()) return new_port(true)->act(action);  // whether there is such a frame
  std::optional<Status> done;
  counting(*last->second.port, [&] { done = last->second.port->act(action); });
  return done;
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_user_frame_server(
    const FrameDefinition& definition, const nlohmann::json& config) {
  const auto keys = plc::network_keys({"port"});
  if (const Status known = plc::known_keys(config, whose, keys); !known) return known.error();
  unsigned port = first_network_port;
  bool run = true;
  plc::ConfigReader reader(config, std::string(whose));
  reader.whole("port", 65535u, port);
  reader.either("mode", "run", "stop", run);
  if (reader.error()) return *reader.error();
  if (const Status right = check_network_port(port); !right)
    return fail(fmt::format("cannot read {}: {}", whose, right.error().message));
  Result<std::unique_ptr<plc::Plc>> plc = plc::make_plc(definition.plc->name, config);
  if (!plc) return plc.error();
  auto server = std::make_unique<UserFrameServer>(definition, (*plc)->memory(),
                                                  static_cast<std::uint16_t>(port), run);
  if (const Status added = (*plc)->add(std::move(server)); !added) return added.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::move(*plc));
}

}  // namespace fieldproof::user_frames
