// User-defined frames over TCP and UDP, as server (FEnet EN 7.7.4; DECISIONS.md fenet/user-frames):
// the port of port.hpp behind the connections of several partners, and datagrams. An answer goes to
// whom the frame came from, a SEND to the partner who has connected, or sent, last.
//
// A frame whose end nothing marks ends with its datagram, or a second behind its last byte. Bytes
// of no frame are passed over; no partner is thrown out.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "src/plc/plc.hpp"
#include "src/user_frames/port.hpp"

namespace fieldproof::user_frames {

/// FEnet EN table 7-3, H400: the first port that user-defined frames may have.
constexpr std::uint16_t first_network_port = 1024;

/// Silence that ends a frame without an end on a connection.
constexpr Duration network_gap = 1s;

/// 1024 and up, but those of the module's own services (502, 2002 to 2006).
Status check_network_port(unsigned port);

class UserFrameServer : public plc::NetworkService {
 public:
  /// Listens on `port` for connections and datagrams. `memory` is that of the definition's PLC, and
  /// outlives the server.
  UserFrameServer(const FrameDefinition& definition, plc::PlcMemory& memory, std::uint16_t port,
                  bool run);

  std::vector<Port> ports() const override {
    return {{Transport::tcp, port_}, {Transport::udp, port_}};
  }
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  std::vector<Burst> advance(Time now) override;

  const plc::ServiceCounters& counters() const override { return counters_; }
  /// All connections are lost; who goes on with an old one gets RST.
  void power_cycle() override;
  void set_run(bool run) override;
  /// "send GROUP.FRAME"; without a partner it is lost.
  std::vector<std::string> actions() const override { return {"send GROUP.FRAME"}; }
  std::optional<Status> act(std::string_view action) override;

 private:
  struct Partner {
    std::unique_ptr<UserFramePort> port;
    bool datagrams = false;
  };
  using Partners = std::map<LinkId, Partner>;

  Partner& partner(LinkId link, bool datagrams);
  std::unique_ptr<UserFramePort> new_port(bool datagrams) const;
  void speak(LinkId link, Partner& partner, Time until);
  void end(LinkId link);
  /// Adds what the port of a partner has counted in `work`.
  template <typename Work>
  void counting(UserFramePort& port, Work work);

  const FrameDefinition definition_;
  plc::PlcMemory& memory_;
  std::uint16_t port_;
  bool run_;
  Partners partners_;
  LinkId last_ = line_link;
  std::vector<Burst> doings_;
  Time now_{};
  plc::ServiceCounters counters_;
};

/// A PLC with that server, in its power-on state. `config`: mode, station and role (which change
/// nothing), `port` (1024). Errors name the key.
Result<std::unique_ptr<plc::EmulatedDevice>> make_user_frame_server(
    const FrameDefinition& definition, const nlohmann::json& config);

}  // namespace fieldproof::user_frames
