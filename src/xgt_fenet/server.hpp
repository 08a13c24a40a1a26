// The XGT dedicated server of an Ethernet module (FEnet EN 5.2, 6.3; DECISIONS.md 'XGT FEnet').
// Connections are those of src/plc/dedicated_server.hpp; a datagram is one frame, no more, no less.
// It answers in RUN and STOP, and what it cannot serve it refuses. Silence is the answer to a
// datagram shorter than a header alone.
#pragma once

#include <memory>
#include <vector>

#include "src/plc/dedicated_server.hpp"
#include "src/plc/memory.hpp"
#include "src/xgt_fenet/header.hpp"
#include "src/xgt_fenet/request.hpp"

namespace fieldproof::xgt_fenet {

constexpr std::uint16_t tcp_port = 2004, udp_port = 2005;  // table 5-2

/// What is done with the check of a request (DECISIONS.md fenet/header-check).
enum class CheckPolicy { ignore, zero_or_valid, strict };

struct ServerConfig {
  plc::DedicatedConfig dedicated{
      .tcp_port = tcp_port, .udp_port = udp_port, .connections = 4, .waiting_time = 100s};
  CheckPolicy check = CheckPolicy::ignore;
  unsigned base = 0, slot = 1;  // where the module sits
  bool cpu_error = false;
};

class FenetServer : public plc::DedicatedServer {
 public:
  /// `memory` outlives the server.
  FenetServer(plc::PlcMemory& memory, const ServerConfig& config)
      : DedicatedServer(config.dedicated), memory_(memory), config_(config) {}

  void set_run(bool run) override { run_ = run; }

 private:
  using Addresses = std::vector<plc::DeviceAddress>;

  std::unique_ptr<plc::StreamSplitter> new_splitter() const override;
  std::optional<Bytes> answer(ByteView frame, std::uint16_t& why) override;

  std::uint16_t fault_of(const Header& header, ByteView frame) const;
  std::uint16_t find_addresses(const Request& request, Addresses& addresses) const;
  std::uint16_t find_address(const Request& request, const Request::Block& block,
                             plc::DeviceAddress& address) const;
  Bytes execute(const Request& request);
  Bytes read(const plc::DeviceAddress& first, unsigned elements) const;
  void write(const plc::DeviceAddress& first, ByteView data);
  Bytes reply_frame(const Header& request, ByteView body) const;
  std::uint16_t plc_info() const;

  plc::PlcMemory& memory_;
  ServerConfig config_;
  bool run_ = true;
};

}  // namespace fieldproof::xgt_fenet
