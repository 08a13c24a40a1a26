#include "suites/services/broken/faults.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/monitored_device.hpp"

namespace fieldproof::services_broken {

using plc::EmulatedDevice;
using vectors::Case;

const std::vector<Fault>& faults() {
  static const std::vector<Fault> table = broken::gather<Fault>(
      {line_faults, counter_faults, monitor_faults, shared_faults, modem_faults});
  return table;
}

MakeBehaviour edge(broken::Edge edge) {
  return [=] { return Behaviour{.edge = edge}; };
}

MakeBehaviour shows(std::string name, std::vector<std::string> from, std::string to) {
  return edge({.shows = [=](std::string_view address, std::string right) {
    const bool other = address == name && std::ranges::find(from, right) != from.end();
    return other ? to : right;
  }});
}

namespace {

/// What only this device shows: the counters of a server, what a loss of power ends.
bool looks_behind(const vectors::Step& step) {
  constexpr std::string_view counters[] = {"@services", "@errors", "@status"};
  return step.action == "power_cycle" || std::ranges::any_of(step.memory, [&](const auto& one) {
           return std::ranges::find(counters, one.first) != std::end(counters);
         });
}

/// The services beside the main one belong to another device.
class ApartDevice : public EmulatedDevice {
 public:
  ApartDevice(std::unique_ptr<EmulatedDevice> main, std::unique_ptr<EmulatedDevice> other)
      : main_(std::move(main)), other_(std::move(other)) {}

  line::Device* line(unsigned channel = 0) override {
    return channel == 0 && !main_->network() ? main_->line() : other_->line(channel);
  }
  net::Host* network() override { return main_->network(); }
  Status set(std::string_view address, std::string_view hex) override {
    const Status done = main_->set(address, hex);
    return done ? other_->set(address, hex) : done;
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return main_->get(address, digits);
  }
  Status act(std::string_view action) override {
    const Status done = main_->act(action);
    return done ? other_->act(action) : done;
  }

 private:
  std::unique_ptr<EmulatedDevice> main_, other_;
};

}  // namespace

bool concerns(const Case& one) {
  if (one.protocol == "udata") return !one.config.contains("instructions");
  const auto has = [&](const char* key) { return one.config.contains(key); };
  if (has("services") || has("bench_line") || one.config.value("monitor", false)) return true;
  if (vectors::is_client_case(one) || !one.on_model.empty()) return false;
  return has("delay_ms") || has("line") || std::ranges::any_of(one.steps, looks_behind);
}

Case set_up(const Behaviour& behaviour, Case one) {
  if (behaviour.set_up) behaviour.set_up(one.config);
  return one;
}

Result<std::unique_ptr<EmulatedDevice>> make_broken_plc(const Behaviour& behaviour,
                                                        const harness::Protocol& protocol,
                                                        std::string_view model,
                                                        const nlohmann::json& config) {
  const std::string of = model.empty() ? protocol.models().front() : std::string(model);
  nlohmann::json own = config;
  if (behaviour.takes) behaviour.takes(own);
  const auto right = [&] { return harness::make_monitored_device(protocol, of, own); };
  Result<std::unique_ptr<EmulatedDevice>> device = right();
  if (!device) return device;
  if (behaviour.memory_apart)
    device = std::unique_ptr<EmulatedDevice>(
        std::make_unique<ApartDevice>(std::move(*device), std::move(*right())));
  return std::unique_ptr<EmulatedDevice>(
      std::make_unique<broken::EdgeDevice>(std::move(*device), behaviour.edge));
}

}  // namespace fieldproof::services_broken
