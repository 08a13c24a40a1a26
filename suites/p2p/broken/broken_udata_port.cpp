#include <nlohmann/json.hpp>

#include "src/udata/port.hpp"
#include "suites/p2p/broken/broken_client.hpp"

namespace fieldproof::p2p_broken {

namespace {

/// The good port, which hears or says other bytes.
class BrokenUdataPort : public plc::SerialDevice {
 public:
  BrokenUdataPort(const udata::UdataConfig& config, Behaviour behaviour)
      : port_(udata::make_udata_plc(config)), behaviour_(std::move(behaviour)) {}

  void receive(const Burst& burst) override {
    Burst heard = burst;
    if (behaviour_.hears) behaviour_.hears(heard.bytes);
    port_->line()->receive(heard);
  }
  std::optional<Time> wake_at() const override { return port_->line()->wake_at(); }
  Bytes advance(Time now) override {
    Bytes bytes = port_->line()->advance(now);
    if (behaviour_.says && !bytes.empty()) behaviour_.says(bytes);
    return bytes;
  }
  Status set(std::string_view address, std::string_view hex) override {
    return port_->set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return port_->get(address, digits);
  }
  Status act(std::string_view action) override {
    return action == behaviour_.deaf_to ? ok() : port_->act(action);
  }

 private:
  std::unique_ptr<plc::Plc> port_;
  Behaviour behaviour_;
};

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_udata_port(const Behaviour& behaviour,
                                                                    std::string_view model,
                                                                    const nlohmann::json& config) {
  Result<udata::UdataConfig> parsed = udata::parse_udata_config(model, config);
  if (!parsed) return parsed.error();
  if (behaviour.deaf_to == "stop") parsed->port.run = true;
  if (behaviour.works_with_udata) behaviour.works_with_udata(*parsed);
  return std::unique_ptr<plc::EmulatedDevice>(
      std::make_unique<BrokenUdataPort>(*parsed, behaviour));
}

}  // namespace fieldproof::p2p_broken
