// A dedicated server of an Ethernet module (FEnet EN 5.1.2, 6.1.3, 6.2.2): how it deals with the
// connections and datagrams of its clients, whatever it speaks.
//
// A request may come in any pieces, several may come at once; they are answered in order, each at
// the moment it is complete. At most `connections` at once: one more is taken and reset, and the
// others do not notice. A client that closes gets RST, not FIN (figures 6-6, 6-7), and what it has
// begun is dropped; its connection is free then, as after RST, and when no request has come for
// the reception waiting time ('assumes that the upper system has some problems, and then ends the
// connection'; by RST). A datagram is a request of its own, answered to where it came from.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>

#include "src/plc/frame_sink.hpp"
#include "src/plc/service.hpp"

namespace fieldproof::plc {

struct DedicatedConfig {
  std::uint16_t tcp_port = 0;
  std::uint16_t udp_port = 0;  // 0: none
  unsigned connections = 4;
  Duration waiting_time{};  // without a request; 0: for ever
};

/// Reads connections (1-4, FEnet EN table 6-1) and waiting_time (seconds, 2-255; FEnet EN 6.2.2).
/// One that is absent leaves `to` as it is. Errors name the key, and `whose` configuration it is.
Status read_dedicated_config(const nlohmann::json& config, std::string_view whose,
                             DedicatedConfig& to);

/// Finds frames in the stream of one connection.
class StreamSplitter {
 public:
  virtual ~StreamSplitter() = default;
  /// A broken frame is one that nothing can be found behind.
  virtual void receive(const Burst& burst, FrameSink& sink) = 0;
};

class DedicatedServer : public NetworkService, private FrameSink {
 public:
  explicit DedicatedServer(const DedicatedConfig& config) : config_(config) {}

  std::vector<Port> ports() const override;
  bool is_driver() const override { return true; }
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  std::vector<Burst> advance(Time now) override;

  /// Answered requests are services, a refusal is one, too. What draws no answer is an error.
  const ServiceCounters& counters() const override { return counters_; }
  /// What XG5000 shows of it (table 2-8): frames "@sent" and "@received", "@state", its connections
  /// that are taken, "@driver", the port of the one that is set; and the counters of all services.
  Result<std::string> get(std::string_view name, std::size_t digits) const override;
  /// All connections and counters are lost. Who goes on with an old connection gets RST.
  void power_cycle() override;

 protected:
  virtual std::unique_ptr<StreamSplitter> new_splitter() const = 0;
  /// The reply to a frame out of a stream, or to a datagram; none: it draws no answer, which `why`
  /// (service_status) then says.
  virtual std::optional<Bytes> answer(ByteView frame, std::uint16_t& why) = 0;

 private:
  struct Connection {
    std::unique_ptr<StreamSplitter> splitter{};
    Time asked_at{};  // the last request; before it, the connection
  };
  using Connections = std::map<LinkId, Connection>;

  void hear(const Burst& burst);
  void hear_datagram(const Burst& burst);
  void on_frame(ByteView frame, Time end) override;
  void on_broken_frame(std::uint16_t why) override;
  void end(LinkId link);

  DedicatedConfig config_;
  Connections connections_;
  Connections::value_type* speaks_ = nullptr;  // whose bytes are looked at
  bool broken_ = false;                        // they cannot be followed
  std::vector<Burst> doings_;
  Time now_{};
  ServiceCounters counters_;
};

}  // namespace fieldproof::plc
