#include "src/modbus/tcp_server.hpp"

#include <algorithm>
#include <utility>

#include "src/modbus/frame.hpp"
#include "src/modbus/pdu.hpp"

namespace fieldproof::modbus {

void ModbusTcpServer::receive(const Burst& burst) {
  now_ = std::max(now_, burst.start);
  switch (burst.event) {
    case LinkEvent::opened:
      if (connections_.size() >= config_.connections) return end(burst.link);
      connections_[burst.link].asked_at = now_;
      return;
    case LinkEvent::data: return hear(burst);
    case LinkEvent::closed: return end(burst.link);
    case LinkEvent::reset: connections_.erase(burst.link); return;
    case LinkEvent::datagram: return;
  }
}

void ModbusTcpServer::hear(const Burst& burst) {
  const auto connection = connections_.find(burst.link);
  if (connection == connections_.end()) return end(burst.link);
  speaks_ = &*connection;
  broken_ = false;
  connection->second.receiver.receive(burst, *this);
  if (broken_) end(burst.link);
}

void ModbusTcpServer::on_frame(ByteView bytes, Time) {
  const ModbusFrame frame = decode_modbus_frame(ModbusMode::tcp, bytes);
  if (frame.fault != plc::service_status::normal) return counters_.count_error(frame.fault);
  speaks_->second.asked_at = now_;
  const Bytes reply =
      execute_modbus_request(parse_modbus_request(frame.pdu, tcp_write_limit), *data_);
  doings_.push_back(
      {.bytes = encode_modbus_frame(ModbusMode::tcp, frame.station, reply, frame.transaction),
       .start = now_,
       .link = speaks_->first});
  counters_.count_service();
}

void ModbusTcpServer::on_broken_frame(std::uint16_t why) {
  counters_.count_error(why);
  broken_ = true;
}

/// By RST, also of a connection that is not known: taken beyond the limit, or before the power
/// went.
void ModbusTcpServer::end(LinkId link) {
  connections_.erase(link);
  doings_.push_back({.bytes = {}, .start = now_, .link = link, .event = LinkEvent::reset});
}

std::optional<Time> ModbusTcpServer::wake_at() const {
  if (!doings_.empty()) return now_;
  if (config_.waiting_time == Duration::zero() || connections_.empty()) return std::nullopt;
  const auto longest = std::ranges::min_element(
      connections_, {}, [](const auto& connection) { return connection.second.asked_at; });
  return longest->second.asked_at + config_.waiting_time;
}

std::vector<Burst> ModbusTcpServer::advance(Time now) {
  now_ = std::max(now_, now);
  if (config_.waiting_time > Duration::zero()) {
    std::vector<LinkId> over;
    for (const auto& [link, connection] : connections_)
      if (now_ >= connection.asked_at + config_.waiting_time) over.push_back(link);
    for (const LinkId link : over) end(link);
  }
  return std::exchange(doings_, {});
}

void ModbusTcpServer::power_cycle() {
  connections_.clear();
  doings_.clear();
  counters_ = {};
}

}  // namespace fieldproof::modbus
