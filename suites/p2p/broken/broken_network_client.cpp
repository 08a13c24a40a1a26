#include <nlohmann/json.hpp>
#include <utility>

#include "src/modbus/p2p_driver.hpp"
#include "src/modbus/tcp_server.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/plc/ethernet.hpp"
#include "src/user_frames/network_server.hpp"
#include "src/user_frames/p2p_driver.hpp"
#include "src/xgt_fenet/p2p_driver.hpp"
#include "src/xgt_fenet/server.hpp"
#include "suites/p2p/broken/broken_core.hpp"
#include "suites/user_frames/definition_files.hpp"

namespace fieldproof::p2p_broken {

using p2p::NetworkClient;
using p2p::NetworkPartner;
using p2p::P2pClient;
using p2p::P2pParameters;

namespace {

constexpr std::string_view of_frames = "user-frames-net";

using MakeGood = std::function<std::unique_ptr<p2p::P2pDriver>()>;

/// `model` names the frames.
Result<MakeGood> good_driver(std::string_view protocol, std::string_view model,
                             const P2pParameters& parameters) {
  if (protocol == "modbus-tcp")
    return MakeGood([] { return modbus::make_modbus_p2p_driver(modbus::ModbusMode::tcp); });
  if (protocol != of_frames)
    return MakeGood([] { return std::make_unique<xgt_fenet::FenetP2pDriver>(); });
  const auto frames =
      user_frames_suite::load_definition(model, user_frames_suite::definitions_folder());
  if (!frames) return frames.error();
  return MakeGood([definition = frames->definition, blocks = parameters.blocks] {
    return user_frames::make_user_frame_network_driver(definition, blocks,
                                                       user_frames::network_gap);
  });
}

NetworkPartner partner_of(std::string_view protocol, const p2p::P2pChannel& channel) {
  const bool datagrams = channel.transport == Transport::udp;
  const std::uint16_t fenet = datagrams ? xgt_fenet::udp_port : xgt_fenet::tcp_port;
  const std::uint16_t usual = protocol == "modbus-tcp" ? modbus::tcp_port
                              : protocol == of_frames  ? user_frames::first_network_port
                                                       : fenet;
  return {channel.partner, channel.port != 0 ? static_cast<std::uint16_t>(channel.port) : usual,
          channel.transport};
}

/// Behind connections, or datagrams.
class BrokenNetworkClient : public plc::EmulatedDevice, public net::Host {
 public:
  BrokenNetworkClient(const plc::PlcModel& model, const P2pParameters& parameters, bool run,
                      const Behaviour& behaviour, std::string_view protocol,
                      const std::function<MakeGood(std::string_view)>& good)
      : core_(model, parameters, run, behaviour) {
    const auto spoken = [&](unsigned channel) {
      const std::string own = core_.parameters().settings_of(channel).protocol;
      return own.empty() ? std::string(protocol) : own;
    };
    const auto driver = [&](BrokenDriver::Asked asked, unsigned channel) {
      auto made =
          std::make_unique<BrokenDriver>(good(spoken(channel))(), behaviour, std::move(asked));
      drivers_.push_back(made.get());
      return made;
    };
    const auto place = [&](std::unique_ptr<P2pClient> engine, unsigned channel) {
      NetworkPartner partner = partner_of(spoken(channel), core_.parameters().settings_of(channel));
      if (behaviour.partner) behaviour.partner(partner);
      clients_.push_back(
          std::make_unique<NetworkClient>(std::move(engine), partner, ethernet_.own_links()));
      (void)ethernet_.add(*clients_.back());
      return [client = clients_.back().get()] { client->power_cycle(); };
    };
    core_.make_engines({.time_out = 5s}, driver, place);
  }

  net::Host* network() override { return this; }
  bool listens(Transport, std::uint16_t) const override { return false; }
  void receive(const Burst& burst) override {
    core_.remember();
    Burst heard = burst;
    if (core_.behaviour().hears_link && !core_.behaviour().hears_link(heard)) return;
    const bool busy = core_.is_busy();
    ethernet_.receive(heard);
    if (core_.behaviour().saves_late && !busy)
      for (const BrokenDriver* driver : drivers_) driver->take_late(heard.bytes, core_.memory());
    hang_up(burst.start, busy && !core_.is_busy());
  }
  std::optional<Time> wake_at() const override { return ethernet_.wake_at(); }
  std::vector<Burst> advance(Time now) override {
    core_.remember();
    std::vector<Burst> doings = ethernet_.advance(now);
    for (const Burst& one : doings)
      if (one.event == LinkEvent::opened) link_ = one.link;
    if (core_.behaviour().does) core_.behaviour().does(doings);
    return doings;
  }

  Status set(std::string_view address, std::string_view hex) override {
    return core_.set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return core_.get(address, digits);
  }
  Status act(std::string_view action) override { return core_.act(action); }

 private:
  /// As if the partner had.
  void hang_up(Time now, bool served) {
    if (!core_.behaviour().hangs_up || !served) return;
    ethernet_.receive({.bytes = {}, .start = now, .link = link_, .event = LinkEvent::closed});
  }

  BrokenCore core_;
  plc::Ethernet ethernet_;
  std::vector<BrokenDriver*> drivers_;
  std::vector<std::unique_ptr<NetworkClient>> clients_;
  LinkId link_ = line_link;  // opened last
};

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_network_client(
    const Behaviour& behaviour, std::string_view protocol, std::string_view model,
    const nlohmann::json& config) {
  const std::string_view of = protocol == of_frames ? "xbc-h" : model;
  const Result<const plc::PlcModel*> plc = plc::known_plc_model(of);
  if (!plc) return plc.error();
  p2p::P2pRules rules = p2p::network_p2p_rules();
  bool run = true;
  plc::ConfigReader reader(config, "the P2P client's configuration");
  reader.whole("station", 255, rules.station);
  reader.either("mode", "run", "stop", run);
  if (reader.error()) return *reader.error();
  const Result<P2pParameters> parameters =
      p2p::parse_p2p_parameters(config.at("p2p"), **plc, rules);
  if (!parameters) return parameters.error();
  const Result<MakeGood> good = good_driver(protocol, model, *parameters);
  if (!good) return good.error();
  const auto of_channel = [&](std::string_view spoken) {
    return spoken == protocol ? *good : *good_driver(spoken, model, *parameters);
  };
  return std::unique_ptr<plc::EmulatedDevice>(std::make_unique<BrokenNetworkClient>(
      **plc, *parameters, run, behaviour, protocol, of_channel));
}

}  // namespace fieldproof::p2p_broken
