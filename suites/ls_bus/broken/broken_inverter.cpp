#include "suites/ls_bus/broken/broken_inverter.hpp"

#include <fmt/format.h>

#include "src/base/spelling.hpp"
#include "src/ls_bus/inverter.hpp"
#include "suites/ls_bus/broken/faults.hpp"

namespace fieldproof::ls_bus_broken {

namespace {

class BrokenInverter : public plc::SerialDevice {
 public:
  BrokenInverter(Behaviour behaviour, GoodInverter inverter)
      : behaviour_(std::move(behaviour)), inverter_(std::move(inverter)) {}

  void receive(const Burst& burst) override {
    Bytes heard = burst.bytes;
    if (behaviour_.hear) behaviour_.hear(heard);
    bool together = false;
    for (const Byte b : heard) {
      if (!receiver_.take(b)) continue;
      const Bytes frame(receiver_.frame().begin(), receiver_.frame().end());
      pending_.put(behaviour_.answer ? behaviour_.answer(frame, together, inverter_)
                                     : broken::Sendings{{inverter_.answer(frame)}},
                   burst.end());
      together = true;
    }
  }
  std::optional<Time> wake_at() const override { return pending_.wake_at(std::nullopt); }
  Bytes advance(Time now) override { return pending_.take(now); }

  Status set(std::string_view address, std::string_view hex) override {
    return inverter_.memory().set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return inverter_.memory().get(address, digits);
  }
  Status act(std::string_view action) override {
    const Status done = inverter_.memory().act(action);
    if (!done || action != "power_cycle") return done;
    receiver_.reset();
    pending_.clear();
    return done;
  }

 private:
  Behaviour behaviour_;
  GoodInverter inverter_;
  ls_bus::LsReceiver receiver_;
  broken::SendQueue pending_;
};

Error unknown(std::string_view fault) {
  std::vector<std::string_view> names{"none"};
  for (const auto* table : {&faults(), &back_door_faults()})
    for (const Fault& one : *table) names.push_back(one.name);
  return fail(
      fmt::format("cannot break an inverter by '{}': there is no such fault; --list shows them{}",
                  fault, suggestion(fault, names)));
}

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_inverter(std::string_view fault,
                                                                  const nlohmann::json& config) {
  const Fault* known = find_fault(fault);
  if (!known && fault != "none") return unknown(fault);
  const Result<ls_bus::InverterConfig> parsed = ls_bus::parse_inverter_config(config);
  if (!parsed) return parsed.error();
  GoodInverter good(std::make_unique<ls_bus::Inverter>(*parsed), parsed->station);
  return std::unique_ptr<plc::EmulatedDevice>(
      std::make_unique<BrokenInverter>(known ? known->make() : Behaviour{}, std::move(good)));
}

}  // namespace fieldproof::ls_bus_broken
