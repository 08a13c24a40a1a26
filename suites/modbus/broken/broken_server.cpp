#include "suites/modbus/broken/broken_server.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/base/spelling.hpp"
#include "src/modbus/modbus_plc.hpp"
#include "src/plc/port_config.hpp"
#include "suites/modbus/broken/faults.hpp"

namespace fieldproof::modbus_broken {

namespace {

class BrokenServer : public plc::SerialDevice, private plc::FrameSink {
 public:
  BrokenServer(Behaviour behaviour, GoodModbus plc, Duration gap)
      : behaviour_(std::move(behaviour)),
        plc_(std::move(plc)),
        receiver_(behaviour_.receiver ? behaviour_.receiver(plc_.mode(), gap)
                                      : modbus::make_modbus_receiver(plc_.mode(), gap)) {}

  void receive(const Burst& burst) override {
    Burst heard = burst;
    if (behaviour_.hear) behaviour_.hear(heard.bytes);
    receiver_->receive(heard, *this);
  }
  std::optional<Time> wake_at() const override { return pending_.wake_at(receiver_->wake_at()); }
  Bytes advance(Time now) override {
    receiver_->advance(now, *this);
    return pending_.take(now);
  }

  Status set(std::string_view address, std::string_view hex) override {
    return plc_.memory().set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return plc_.memory().get(address, digits);
  }
  Status act(std::string_view action) override {
    const Status done = plc_.memory().act(action);
    if (!done || action != "power_cycle") return done;
    receiver_->reset();
    pending_.clear();
    return done;
  }

 private:
  void on_frame(ByteView bytes, Time end) override {
    const Bytes frame(bytes.begin(), bytes.end());
    pending_.put(
        behaviour_.answer ? behaviour_.answer(frame, plc_) : broken::Sendings{{plc_.answer(frame)}},
        end);
  }
  void on_broken_frame(std::uint16_t) override {}

  Behaviour behaviour_;
  GoodModbus plc_;
  std::unique_ptr<modbus::ModbusReceiver> receiver_;
  broken::SendQueue pending_;
};

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_server(std::string_view mode,
                                                                std::string_view fault,
                                                                const nlohmann::json& config) {
  if (mode != "rtu" && mode != "ascii")
    return fail(fmt::format("cannot serve Modbus '{}': the modes are rtu and ascii", mode));
  const Fault* known = find_fault(fault);
  if (!known && fault != "none") {
    std::vector<std::string_view> names{"none"};
    for (const Fault& one : faults()) names.push_back(one.name);
    return fail(
        fmt::format("cannot break a server by '{}': there is no such fault; --list shows them{}",
                    fault, suggestion(fault, names)));
  }
  const modbus::ModbusMode modbus_mode =
      mode == "rtu" ? modbus::ModbusMode::rtu : modbus::ModbusMode::ascii;
  Result<std::unique_ptr<plc::EmulatedDevice>> device =
      modbus::make_modbus_plc(modbus_mode, config.at("model").get<std::string>(), config);
  if (!device) return device.error();
  plc::ConfigReader reader(config, "the broken server's configuration");
  plc::PortConfig port;
  plc::read_port_config(reader, port);
  if (reader.error()) return *reader.error();
  GoodModbus good(modbus_mode, std::move(*device), static_cast<Byte>(port.station));
  return std::unique_ptr<plc::EmulatedDevice>(
      new BrokenServer(known ? known->make() : Behaviour{}, std::move(good), port.gap()));
}

}  // namespace fieldproof::modbus_broken
