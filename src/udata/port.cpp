#include "src/udata/port.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace fieldproof::udata {

namespace {
constexpr std::size_t most_held = 16;  // DECISIONS.md udata/held
}  // namespace

std::unique_ptr<plc::Plc> make_udata_plc(const UdataConfig& config) {
  auto plc = std::make_unique<plc::Plc>(*config.plc, config.port.run);
  (void)plc->add(1, std::make_unique<UdataPort>(config, plc->memory()));  // the channel is free
  return plc;
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_udata_port(std::string_view model,
                                                             const nlohmann::json& config) {
  const Result<UdataConfig> parsed = parse_udata_config(model, config);
  if (!parsed) return parsed.error();
  return std::unique_ptr<plc::EmulatedDevice>(make_udata_plc(*parsed));
}

UdataPort::UdataPort(const UdataConfig& config, plc::PlcMemory& memory)
    : memory_(memory),
      module_(config.module),
      program_(config.instructions, config.module),
      silence_(config.port.gap()) {}

void UdataPort::receive(const Burst& burst) {
  if (burst.bytes.empty()) return;
  silence_.heard(burst);
  now_ = std::max(now_, burst.end());
  if (!hears()) return;
  for (const Byte b : burst.bytes) {
    heard_.push_back(b);
    if (heard_.size() == udata_max) end_datum();
  }
}

void UdataPort::end_datum() {
  if (heard_.empty()) return;
  if (received_.size() < most_held) {
    received_.push_back(std::move(heard_));
    counters_.count_service();
  } else {
    counters_.count_error(plc::service_status::too_long);
  }
  heard_.clear();
}

std::optional<Time> UdataPort::wake_at() const {
  std::optional<Time> first = program_.wake_at();
  if (!heard_.empty()) first = std::min(first.value_or(Time::max()), silence_.over_at());
  return queue_.wake_at(first);
}

Bytes UdataPort::advance(Time now) {
  now_ = std::max(now_, now);
  if (!heard_.empty() && now >= silence_.over_at()) end_datum();
  if (program_.advance(now_, memory_)) scan();
  return queue_.take(now);
}

void UdataPort::scan() {
  if (run_)
    program_.scan(memory_, *this);
  else
    program_.look(memory_);
}

void UdataPort::send(Bytes data) {
  counters_.count_service();
  queue_.put(now_, std::move(data));
}

std::optional<Bytes> UdataPort::take_received() {
  if (received_.empty()) return std::nullopt;
  Bytes oldest = std::move(received_.front());
  received_.pop_front();
  return oldest;
}

Result<std::string> UdataPort::get(std::string_view name, std::size_t digits) const {
  const auto level = [digits](bool on) {
    return hex_number(on, static_cast<int>(digits == 0 ? 2 : digits));
  };
  if (name == "@dtr") return level(dtr_);
  if (name == "@rts") return level(rts_);
  return plc::get_counter(counters_, name, digits);
}

void UdataPort::set_run(bool run) {
  run_ = run;
  if (!run) forget();
}

void UdataPort::power_cycle() {
  counters_ = {};
  dtr_ = rts_ = false;
  received_.clear();
  program_.reset();
  program_.look(memory_);
  forget();
}

void UdataPort::forget() {
  heard_.clear();
  queue_.clear();
}

}  // namespace fieldproof::udata
