#include "src/modbus/server.hpp"

#include "src/modbus/frame.hpp"
#include "src/modbus/pdu.hpp"

namespace fieldproof::modbus {

Bytes ModbusServer::advance(Time now) {
  receiver_->advance(now, *this);
  return replies_.take(now);
}

void ModbusServer::power_cycle() {
  counters_ = {};
  replies_.clear();
  receiver_->reset();
}

void ModbusServer::on_frame(ByteView bytes, Time end) {
  const ModbusFrame frame = decode_modbus_frame(mode_, bytes);
  if (frame.fault != plc::service_status::normal) return counters_.count_error(frame.fault);
  if (frame.station != station_) return counters_.count_error(plc::service_status::station);
  const Bytes reply = execute_modbus_request(parse_modbus_request(frame.pdu), *data_);
  replies_.put(end + delay_, encode_modbus_frame(mode_, frame.station, reply));
  counters_.count_service();
}

}  // namespace fieldproof::modbus
