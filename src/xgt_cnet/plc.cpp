#include "src/xgt_cnet/plc.hpp"

#include <fmt/format.h>

#include "src/plc/device_action.hpp"

namespace fieldproof {

namespace {
constexpr unsigned longest_time_out = 50;  // 000 4.3.1 dialog: 0-50

Result<DeviceAddress> own_address(const PlcModel& model, std::size_t block, std::string_view what, const std::string& name) {
  const ParsedAddress parsed = parse_address(model, name);
  if (parsed) return parsed.address;
  return fail(fmt::format("cannot set up p2p block {}: {} '{}' is wrong on {}: {}", block, what, name, model.name,
                          describe(parsed.fault)));
}

Result<P2pBlock> make_block(const PlcModel& model, std::size_t number, const P2pConfig& config) {
  const auto wrong = [number](const std::string& what) { return fail(fmt::format("cannot set up p2p block {}: {}", number, what)); };
  const Result<DeviceAddress> flag = own_address(model, number, "flag", config.flag);
  if (!flag) return flag.error();
  if (flag->type != 'X') return wrong("flag '" + config.flag + "' is no bit; name one such as %MX00000");
  const Result<DeviceAddress> save = own_address(model, number, "save", config.save);
  if (!save) return save.error();
  // The read name belongs to the partner, whose areas are not known here.
  const char type = config.read.size() > 3 && config.read[0] == '%' ? config.read[2] : '\0';
  if (type_bytes(type) == 0 || config.read.size() > xgt_max_name) {
    return wrong("read '" + config.read + "' is no device name such as %MW100");
  }
  if ((type & ~0x20) != save->type) return wrong("read and save are of different types; make them equal");
  if (config.station > 255) return wrong("station is not 0 to 255");
  const unsigned bytes = config.count * type_bytes(type);
  if (config.count == 0 || config.count > xgt_max_run || bytes > xgt_max_run) return wrong("count is not 1 to 60 words");
  if (config.count > 1 && save->type == 'X') return wrong("several bits cannot be read at once; use one block a bit");
  if (!fits(model, *save, config.count)) return wrong("the save area ends before the last value");
  return P2pBlock{*flag, unpadded_name(config.read), *save, config.station, config.count};
}

Status check(const PlcConfig& config) {
  const auto wrong = [](const std::string& what) { return fail("cannot make a PLC: " + what); };
  if (config.time_out > longest_time_out) return wrong("time_out is not 0 to 50");
  const bool client = config.role == PlcConfig::Role::client;
  if (client && config.p2p.empty()) return wrong("a client has no p2p blocks; give some, or role server");
  if (!client && !config.p2p.empty()) return wrong("a server has p2p blocks; remove them, or give role client");
  if (config.p2p.size() > p2p_max_blocks) return wrong("there are more than 32 p2p blocks");
  return ok();
}
}  // namespace

Plc::Plc(const PlcModel& model, const PlcConfig& config, std::vector<P2pBlock> blocks) : memory_(model) {
  if (config.role == PlcConfig::Role::server) {
    server_.emplace(memory_, config.station, config.gap(), config.reply_delay());
    return;
  }
  const XgtClient::Timing timing{config.gap(), 100ms * (config.time_out + 1), config.line.character_time()};
  client_.emplace(memory_, std::move(blocks), timing, config.run);
}

Result<std::unique_ptr<Plc>> make_plc(const PlcConfig& config) {
  const Result<const PlcModel*> known = check_port_config(config);
  if (!known) return known.error();
  const PlcModel& model = **known;
  if (const Status status = check(config); !status) return status.error();
  std::vector<P2pBlock> blocks;
  for (const P2pConfig& p2p : config.p2p) {
    Result<P2pBlock> block = make_block(model, blocks.size(), p2p);
    if (!block) return block.error();
    blocks.push_back(std::move(*block));
  }
  return std::unique_ptr<Plc>(new Plc(model, config, std::move(blocks)));
}

void Plc::receive(const Burst& burst) { server_ ? server_->receive(burst) : client_->receive(burst); }

std::optional<Time> Plc::wake_at() const { return server_ ? server_->wake_at() : client_->wake_at(); }

Bytes Plc::advance(Time now) { return server_ ? server_->advance(now) : client_->advance(now); }

Status Plc::set(std::string_view address, std::string_view hex) {
  const Status status = set_by_name(memory_, address, hex);
  if (status && client_) client_->scan();
  return status;
}

Result<std::string> Plc::get(std::string_view address, std::size_t digits) const {
  if (!address.starts_with('@')) return get_by_name(memory_, address, digits);
  return get_counter(counters(), address, digits);
}

Status Plc::act(std::string_view action) {
  const Result<DeviceAction> known = parse_device_action(action);
  if (!known) return known.error();
  if (*known == DeviceAction::power_cycle) {
    if (client_) client_->power_cycle();
    else server_->power_cycle();
  } else if (client_) {
    client_->set_running(*known == DeviceAction::run);
  }
  return ok();
}

}  // namespace fieldproof
