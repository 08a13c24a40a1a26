// The Modbus TCP server of an Ethernet module (FEnet EN 5.3, 6.1.3, 6.4; X-NET 3-4-2). Connections
// are those of src/plc/dedicated_server.hpp.
//
// Transaction and unit are copied, any unit is served. A frame of another protocol than 0 draws no
// answer, and the stream goes on behind it; a length that no frame has ends the connection by RST
// (mbap.hpp); one that the PDU contradicts is exception 03.
#pragma once

#include <memory>

#include "src/modbus/data_space.hpp"
#include "src/plc/dedicated_server.hpp"

namespace fieldproof::modbus {

constexpr std::uint16_t tcp_port = 502;

/// The port is `tcp_port`, whatever it says.
using TcpServerConfig = plc::DedicatedConfig;

class ModbusTcpServer : public plc::DedicatedServer {
 public:
  ModbusTcpServer(std::unique_ptr<DataSpace> data, TcpServerConfig config);

 private:
  std::unique_ptr<plc::StreamSplitter> new_splitter() const override;
  /// None: another protocol.
  std::optional<Bytes> answer(ByteView frame, std::uint16_t& why) override;

  std::unique_ptr<DataSpace> data_;
};

}  // namespace fieldproof::modbus
