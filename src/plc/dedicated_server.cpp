#include "src/plc/dedicated_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/plc/config_reader.hpp"

namespace fieldproof::plc {

namespace {
constexpr unsigned most_connections = 4, longest_wait = 255, shortest_wait = 2;
}  // namespace

Status read_dedicated_config(const nlohmann::json& config, std::string_view whose,
                             DedicatedConfig& to) {
  unsigned wait = static_cast<unsigned>(to.waiting_time / 1s);
  ConfigReader reader(config, std::string(whose));
  reader.whole("connections", most_connections, to.connections);
  reader.whole("waiting_time", longest_wait, wait);
  if (reader.error()) return *reader.error();
  if (to.connections == 0)
    return fail(
        fmt::format("cannot read {}: connections is 0; give 1 to {}", whose, most_connections));
  if (config.contains("waiting_time") && wait < shortest_wait)
    return fail(fmt::format("cannot read {}: waiting_time is {}; give {} to {} seconds", whose,
                            wait, shortest_wait, longest_wait));
  to.waiting_time = std::chrono::seconds(wait);
  return ok();
}

Result<std::string> DedicatedServer::get(std::string_view name, std::size_t digits) const {
  if (name == "@sent") return counter_text(counters_.services, digits);
  if (name == "@received") return counter_text(counters_.services + counters_.errors, digits);
  if (name == "@state")
    return counter_text(static_cast<std::uint32_t>(connections_.size()), digits, 2);
  if (name == "@driver") return counter_text(config_.tcp_port, digits);
  return get_counter(counters_, name, digits);
}

std::vector<NetworkService::Port> DedicatedServer::ports() const {
  std::vector<Port> ports{{Transport::tcp, config_.tcp_port}};
  if (config_.udp_port != 0) ports.push_back({Transport::udp, config_.udp_port});
  return ports;
}

void DedicatedServer::receive(const Burst& burst) {
  now_ = std::max(now_, burst.start);
  switch (burst.event) {
    case LinkEvent::opened:
      if (connections_.size() >= config_.connections) return end(burst.link);
      connections_[burst.link] = {new_splitter(), now_};
      return;
    case LinkEvent::data: return hear(burst);
    case LinkEvent::closed: return end(burst.link);
    case LinkEvent::reset: connections_.erase(burst.link); return;
    case LinkEvent::datagram: return hear_datagram(burst);
  }
}

void DedicatedServer::hear(const Burst& burst) {
  const auto connection = connections_.find(burst.link);
  if (connection == connections_.end()) return end(burst.link);
  speaks_ = &*connection;
  broken_ = false;
  connection->second.splitter->receive(burst, *this);
  if (broken_) end(burst.link);
}

void DedicatedServer::hear_datagram(const Burst& burst) {
  std::uint16_t why = service_status::head;
  std::optional<Bytes> reply = answer(burst.bytes, why);
  if (!reply) return counters_.count_error(why);
  doings_.push_back({.bytes = std::move(*reply),
                     .start = now_,
                     .link = burst.link,
                     .event = LinkEvent::datagram});
  counters_.count_service();
}

void DedicatedServer::on_frame(ByteView frame, Time) {
  std::uint16_t why = service_status::head;
  std::optional<Bytes> reply = answer(frame, why);
  if (!reply) return counters_.count_error(why);
  speaks_->second.asked_at = now_;
  doings_.push_back({.bytes = std::move(*reply), .start = now_, .link = speaks_->first});
  counters_.count_service();
}

void DedicatedServer::on_broken_frame(std::uint16_t why) {
  counters_.count_error(why);
  broken_ = true;
}

/// By RST, also of a connection that is not known: taken beyond the limit, or before the power
/// went.
void DedicatedServer::end(LinkId link) {
  connections_.erase(link);
  doings_.push_back({.bytes = {}, .start = now_, .link = link, .event = LinkEvent::reset});
}

std::optional<Time> DedicatedServer::wake_at() const {
  if (!doings_.empty()) return now_;
  if (config_.waiting_time == Duration::zero() || connections_.empty()) return std::nullopt;
  const auto longest = std::ranges::min_element(
      connections_, {}, [](const auto& connection) { return connection.second.asked_at; });
  return longest->second.asked_at + config_.waiting_time;
}

std::vector<Burst> DedicatedServer::advance(Time now) {
  now_ = std::max(now_, now);
  if (config_.waiting_time > Duration::zero()) {
    std::vector<LinkId> over;
    for (const auto& [link, connection] : connections_)
      if (now_ >= connection.asked_at + config_.waiting_time) over.push_back(link);
    for (const LinkId link : over) end(link);
  }
  return std::exchange(doings_, {});
}

void DedicatedServer::power_cycle() {
  connections_.clear();
  doings_.clear();
  counters_ = {};
}

}  // namespace fieldproof::plc
