// The Modbus TCP server of an Ethernet module (FEnet EN 5.3, 6.1.3, 6.4; X-NET 3-4-2).
//
// A request may come in any pieces, several may come at once; they are answered in order, each at
// the moment it is complete. Transaction and unit are copied, any unit is served. A frame of
// another protocol than 0 draws no answer, and the stream goes on behind it; a length that no frame
// has ends the connection by RST (mbap.hpp); one that the PDU contradicts is exception 03.
//
// At most `connections` at once: one more is taken and reset, and the others do not notice. A
// client that closes gets RST, not FIN (figure 6-7), and what it has begun is dropped; its
// connection is free then, as after RST, and when no request has come for the reception waiting
// time (6.2.2: 'assumes that the upper system has some problems, and then ends the connection'; by
// RST).
#pragma once

#include <map>
#include <memory>

#include "src/modbus/data_space.hpp"
#include "src/modbus/mbap_receiver.hpp"
#include "src/plc/service.hpp"

namespace fieldproof::modbus {

struct TcpServerConfig {
  std::uint16_t port = 502;
  unsigned connections = 4;
  Duration waiting_time{};  // without a request; 0: for ever
};

class ModbusTcpServer : public plc::NetworkService, private plc::FrameSink {
 public:
  ModbusTcpServer(std::unique_ptr<DataSpace> data, const TcpServerConfig& config)
      : data_(std::move(data)), config_(config) {}

  std::vector<Port> ports() const override { return {{Transport::tcp, config_.port}}; }
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  std::vector<Burst> advance(Time now) override;

  /// Answered requests are services, an exception is one, too. What draws no answer is an error:
  /// another protocol, an impossible length.
  const plc::ServiceCounters& counters() const override { return counters_; }
  /// All connections and counters are lost. Who goes on with an old connection gets RST.
  void power_cycle() override;

 private:
  struct Connection {
    MbapReceiver receiver{};
    Time asked_at{};  // the last request; before it, the connection
  };
  using Connections = std::map<LinkId, Connection>;

  void hear(const Burst& burst);
  void on_frame(ByteView frame, Time end) override;
  void on_broken_frame(std::uint16_t why) override;
  void end(LinkId link);

  std::unique_ptr<DataSpace> data_;
  TcpServerConfig config_;
  Connections connections_;
  Connections::value_type* speaks_ = nullptr;  // whose bytes are looked at
  bool broken_ = false;                        // they cannot be followed
  std::vector<Burst> doings_;
  Time now_{};
  plc::ServiceCounters counters_;
};

}  // namespace fieldproof::modbus
