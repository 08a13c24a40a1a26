#include "src/udata/modem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/plc/config_reader.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof::udata {

namespace {

constexpr char carriage_return = 0x0D;
constexpr std::size_t longest_command = 1024;  // one UDATA instruction
constexpr std::string_view dial = "ATDT", deliver = "deliver ";

bool dials(std::string_view command) {
  return command.starts_with(dial) && command.size() > dial.size() &&
         std::ranges::all_of(command.substr(dial.size()),
                             [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_modem(const nlohmann::json& config) {
  const std::string what = "the modem's configuration";
  const auto keys =
      plc::port_keys({"dtr", "modem", "network", "network_ms", "reply_end", "rts", "sms"});
  if (const Status known = plc::known_keys(config, what, keys); !known) return known.error();
  ModemConfig modem;
  plc::PortConfig port;
  plc::ConfigReader reader(config, what);
  plc::read_port_config(reader, port);
  reader.either("modem", "rcu-890", "bsm-856r", modem.rcu_890);
  reader.text("sms", modem.sms);
  reader.boolean("network", modem.network);
  reader.milliseconds("network_ms", modem.network_time);
  reader.text("reply_end", modem.reply_end);
  reader.boolean("dtr", modem.dtr);
  reader.boolean("rts", modem.rts);
  if (reader.error()) return *reader.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::make_unique<Modem>(std::move(modem)));
}

void Modem::receive(const Burst& burst) {
  if (dtr_ && rts_) burst.for_each([&](Byte b, Time end) { take(b, end); });
  now_ = std::max(now_, burst.end());
}

void Modem::take(Byte b, Time now) {
  if (connected_) return passed_on_.push_back(b);
  if (b == carriage_return) return take_command(now);
  if (command_.size() < longest_command) command_.push_back(static_cast<char>(b));
}

void Modem::take_command(Time now) {
  const std::string command = std::exchange(command_, {});
  if (!command.starts_with("AT")) return counters_.count_error(plc::service_status::head);
  counters_.count_service();
  if (!config_.sms.empty() && command.starts_with(config_.sms)) return take_sms(now);
  connected_ = !config_.rcu_890 && dials(command);
  reply(now, (connected_ ? "CONNECT" : "OK") + config_.reply_end);
}

void Modem::take_sms(Time now) {
  const std::string& end = config_.reply_end;
  if (config_.rcu_890) {
    reply(now, "*SKT*PRIMO:0" + end + "OK" + end);
    report(now, (config_.network ? "*SKT*MOACK:0,1" : "*SKT*MOACK:0,0") + end);
    return;
  }
  reply(now, "OK" + end);
  if (config_.network) report(now, "$006" + end);
}

std::optional<Time> Modem::wake_at() const {
  return replies_.wake_at(reports_.wake_at(std::nullopt));
}

Bytes Modem::advance(Time now) {
  now_ = std::max(now_, now);
  Bytes bytes = replies_.take(now);
  return bytes.empty() ? reports_.take(now) : bytes;
}

const bool* Modem::switch_at(std::string_view address) const {
  if (address == "@dtr") return &dtr_;
  if (address == "@rts") return &rts_;
  return address == "@network" ? &config_.network : nullptr;
}

Status Modem::set(std::string_view address, std::string_view hex) {
  bool* const one = const_cast<bool*>(switch_at(address));
  if (!one)
    return fail(
        fmt::format("cannot set {}: a modem has no memory; use @dtr, @rts or @network", address));
  if (hex != "00" && hex != "01")
    return fail(fmt::format("cannot set {} to {}: it is 00 or 01", address, hex));
  *one = hex == "01";
  return ok();
}

Result<std::string> Modem::get(std::string_view address, std::size_t digits) const {
  if (const bool* const one = switch_at(address))
    return hex_number(*one, static_cast<int>(digits == 0 ? 2 : digits));
  if (address != "@data") return plc::get_counter(counters_, address, digits);
  std::string hex;
  for (const Byte b : passed_on_) hex += hex_number(b, 2);
  return hex;
}

Status Modem::act(std::string_view action) {
  if (action.starts_with(deliver)) {
    if (!connected_)
      return fail("cannot deliver: no modem is connected; dial with ATDT and a number first");
    reply(now_, std::string(action.substr(deliver.size())));
    return ok();
  }
  if (action != "power_cycle")
    return fail(fmt::format("cannot do '{}': use power_cycle or deliver TEXT", action));
  connected_ = false;
  command_.clear();
  passed_on_.clear();
  replies_.clear();
  reports_.clear();
  counters_ = {};
  return ok();
}

}  // namespace fieldproof::udata
