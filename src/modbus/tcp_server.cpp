#include "src/modbus/tcp_server.hpp"

#include <utility>

#include "src/modbus/frame.hpp"
#include "src/modbus/mbap_receiver.hpp"
#include "src/modbus/pdu.hpp"

namespace fieldproof::modbus {

namespace {
class MbapSplitter : public plc::StreamSplitter {
 public:
  void receive(const Burst& burst, plc::FrameSink& sink) override {
    receiver_.receive(burst, sink);
  }

 private:
  MbapReceiver receiver_;
};

TcpServerConfig on_its_port(TcpServerConfig config) {
  config.tcp_port = tcp_port;
  return config;
}
}  // namespace

ModbusTcpServer::ModbusTcpServer(std::unique_ptr<DataSpace> data, TcpServerConfig config)
    : DedicatedServer(on_its_port(config)), data_(std::move(data)) {}

std::unique_ptr<plc::StreamSplitter> ModbusTcpServer::new_splitter() const {
  return std::make_unique<MbapSplitter>();
}

std::optional<Bytes> ModbusTcpServer::answer(ByteView bytes, std::uint16_t& why) {
  const ModbusFrame frame = decode_modbus_frame(ModbusMode::tcp, bytes);
  why = frame.fault;
  if (frame.fault != plc::service_status::normal) return std::nullopt;
  const Bytes reply =
      execute_modbus_request(parse_modbus_request(frame.pdu, tcp_write_limit), *data_);
  return encode_modbus_frame(ModbusMode::tcp, frame.station, reply, frame.transaction);
}

}  // namespace fieldproof::modbus
