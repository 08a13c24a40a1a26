#include "suites/p2p/broken/broken_client.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "suites/p2p/broken/broken_core.hpp"
#include "suites/p2p/broken/drivers.hpp"

namespace fieldproof::p2p_broken {

using p2p::P2pClient;
using p2p::P2pParameters;

namespace {

/// On a serial line.
class BrokenLineClient : public plc::SerialDevice {
 public:
  BrokenLineClient(const plc::PlcModel& model, const P2pParameters& parameters, bool run,
                   const P2pClient::Timing& timing, const Behaviour& behaviour,
                   const BrokenCore::MakeDriver& driver)
      : core_(model, parameters, run, behaviour) {
    core_.make_engines(timing, driver, [this](std::unique_ptr<P2pClient> engine, unsigned) {
      engines_.push_back(std::move(engine));
      return [client = engines_.back().get()] { client->power_cycle(); };
    });
  }

  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  Status set(std::string_view address, std::string_view hex) override {
    return core_.set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return core_.get(address, digits);
  }
  Status act(std::string_view action) override { return core_.act(action); }

 private:
  BrokenCore core_;
  std::vector<std::unique_ptr<P2pClient>> engines_;
  std::vector<Burst> late_;
};

void BrokenLineClient::receive(const Burst& burst) {
  core_.remember();
  if (core_.behaviour().keeps_late_replies && !core_.is_busy()) late_.push_back(burst);
  for (const auto& engine : engines_) engine->receive(burst);
}

std::optional<Time> BrokenLineClient::wake_at() const {
  std::optional<Time> first;
  for (const auto& engine : engines_) {
    const std::optional<Time> wake = engine->wake_at();
    if (wake && (!first || *wake < *first)) first = wake;
  }
  return first;
}

Bytes BrokenLineClient::advance(Time now) {
  core_.remember();
  Bytes bytes;
  for (const auto& engine : engines_) {
    const Bytes more = engine->advance(now);
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  if (bytes.empty()) return bytes;
  for (Burst& burst : std::exchange(late_, {})) {
    burst.start = now;
    for (const auto& engine : engines_) engine->receive(burst);
  }
  return bytes;
}

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_client(const Behaviour& behaviour,
                                                                std::string_view protocol,
                                                                std::string_view model,
                                                                const nlohmann::json& config) {
  if (protocol == "udata") return make_broken_udata_port(behaviour, model, config);
  if (protocol == "xgt-fenet" || protocol == "modbus-tcp" || protocol == "user-frames-net")
    return make_broken_network_client(behaviour, protocol, model, config);
  plc::PortConfig port;
  if (plc::find_plc_model(model)) port.model = model;
  unsigned time_out = 1;
  plc::ConfigReader reader(config, "the P2P client's configuration");
  plc::read_port_config(reader, port);
  reader.whole("time_out", 50, time_out);
  if (reader.error()) return *reader.error();
  const Result<const plc::PlcModel*> plc = plc::check_port_config(port);
  if (!plc) return plc.error();
  const Result<P2pParameters> parameters = p2p::parse_p2p_parameters(config.at("p2p"), **plc);
  if (!parameters) return parameters.error();
  const auto good = [&] { return make_driver(protocol, port, config, model, *parameters); };
  if (const auto first = good(); !first) return first.error();
  const P2pClient::Timing timing{100ms * (time_out + 1), port.reply_delay(),
                                 port.line.character_time()};
  return std::unique_ptr<plc::EmulatedDevice>(std::make_unique<BrokenLineClient>(
      **plc, *parameters, port.run, timing, behaviour, [&](BrokenDriver::Asked asked, unsigned) {
        return std::make_unique<BrokenDriver>(std::move(*good()), behaviour, std::move(asked));
      }));
}

}  // namespace fieldproof::p2p_broken
