#include "src/modbus/modbus_plc.hpp"

#include <nlohmann/json.hpp>

#include "src/modbus/bases.hpp"
#include "src/modbus/frame.hpp"
#include "src/modbus/pdu.hpp"
#include "src/modbus/receiver.hpp"
#include "src/plc/counters.hpp"
#include "src/plc/device_action.hpp"
#include "src/plc/memory.hpp"
#include "src/plc/port_config.hpp"
#include "src/plc/reply_queue.hpp"

namespace fieldproof::modbus {

namespace {
class ModbusPlc : public plc::EmulatedDevice, private plc::FrameSink {
 public:
  ModbusPlc(ModbusMode mode, const plc::PlcModel& model, const plc::PortConfig& port,
            const ModbusTables& tables)
      : mode_(mode),
        station_(port.station),
        delay_(port.reply_delay()),
        memory_(model),
        tables_(tables),
        receiver_(make_modbus_receiver(mode, port.gap())) {}

  void receive(const Burst& burst) override { receiver_->receive(burst, *this); }
  std::optional<Time> wake_at() const override { return replies_.wake_at(receiver_->wake_at()); }
  Bytes advance(Time now) override {
    receiver_->advance(now, *this);
    return replies_.take(now);
  }

  Status set(std::string_view address, std::string_view hex) override {
    return plc::set_by_name(memory_, address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    if (address.starts_with('@')) return plc::get_counter(counters_, address, digits);
    return plc::get_by_name(memory_, address, digits);
  }
  /// power_cycle: counters, replies and frames in progress are lost; memory stays. A server answers
  /// in RUN and STOP.
  Status act(std::string_view action) override {
    const Result<plc::DeviceAction> known = plc::parse_device_action(action);
    if (!known) return known.error();
    if (*known == plc::DeviceAction::power_cycle) {
      counters_ = {};
      replies_.clear();
      receiver_->reset();
    }
    return ok();
  }

 private:
  void on_frame(ByteView bytes, Time end) override {
    const ModbusFrame frame = decode_modbus_frame(mode_, bytes);
    if (frame.fault != plc::service_status::normal) return counters_.count_error(frame.fault);
    if (frame.station != station_) return counters_.count_error(plc::service_status::station);
    const Bytes reply = execute_modbus_request(parse_modbus_request(frame.pdu), tables_, memory_);
    replies_.put(end + delay_, encode_modbus_frame(mode_, frame.station, reply));
    counters_.count_service();
  }
  void on_broken_frame(std::uint16_t why) override { counters_.count_error(why); }

  ModbusMode mode_;
  unsigned station_;
  Duration delay_;
  plc::PlcMemory memory_;
  ModbusTables tables_;
  std::unique_ptr<ModbusReceiver> receiver_;
  plc::ServiceCounters counters_;
  plc::ReplyQueue replies_;
};
}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_modbus_plc(ModbusMode mode,
                                                             std::string_view model,
                                                             const nlohmann::json& config) {
  constexpr std::string_view what = "the Modbus server's configuration";
  const auto keys =
      plc::port_keys({"bit_read_base", "bit_write_base", "word_read_base", "word_write_base"});
  if (config.is_object() && config.contains("role") && config["role"] == "client") {
    return fail("cannot make a Modbus server of role client; leave role out, or give server");
  }
  if (const Status status = plc::known_keys(config, what, keys); !status) return status.error();
  plc::PortConfig port;
  port.model = model;
  plc::ConfigReader reader(config, std::string(what));
  plc::read_port_config(reader, port);
  if (reader.error()) return *reader.error();
  const Result<const plc::PlcModel*> known = plc::check_port_config(port);
  if (!known) return known.error();
  ModbusBases bases = default_modbus_bases(**known);
  for (std::size_t i = 0; i < bases.size(); ++i)
    reader.text((std::string(modbus_base_names[i]) + "_base").c_str(), bases[i]);
  if (reader.error()) return *reader.error();
  const Result<ModbusTables> tables = place_modbus_tables(**known, bases);
  if (!tables) return tables.error();
  return std::unique_ptr<plc::EmulatedDevice>(
      std::make_unique<ModbusPlc>(mode, **known, port, *tables));
}

}  // namespace fieldproof::modbus
