#include "src/ls_bus/inverter.hpp"

#include <fmt/format.h>

#include <array>

#include "src/plc/config_reader.hpp"
#include "src/plc/device_action.hpp"

namespace fieldproof::ls_bus {

namespace {
/// The parameter at the back door's `address`, if `words` words exist from there on.
Result<unsigned> find_parameter(const InverterParameters& parameters, std::string_view address,
                                std::size_t words) {
  const std::optional<unsigned> first = parse_ls_address(address);
  if (!first)
    return fail(
        fmt::format("cannot find parameter '{}': it is not four hex digits such as 1230", address));
  if (parameters.exist(*first, static_cast<unsigned>(words))) return *first;
  std::string known;
  for (const ParameterRange& range : inverter_ranges())
    known += fmt::format("{}{:04X}-{:04X}", known.empty() ? "" : ", ", range.first, range.last);
  return fail(fmt::format("cannot find {} word{} at parameter {}: the inverter has {}", words,
                          words == 1 ? "" : "s", address, known));
}
}  // namespace

void Inverter::receive(const Burst& burst) {
  burst.for_each([&](Byte b, Time end) {
    if (!receiver_.take(b)) return;
    Bytes reply = answer(receiver_.frame());
    if (!reply.empty()) replies_.put(end + config_.delay, std::move(reply));
  });
}

LsFault Inverter::check(const LsRequest& request) const {
  if (request.fault != LsFault::none) return request.fault;
  if (!parameters_.exist(request.address, request.count)) return LsFault::range;
  if (request.command == 'W' && !parameters_.writable(request.address, request.count))
    return LsFault::rights;
  return LsFault::none;
}

Bytes Inverter::answer(ByteView frame) {
  const LsRequest request = parse_ls_request(frame, config_.write_order);
  if (request.station != config_.station) return {};
  if (const LsFault fault = check(request); fault != LsFault::none)
    return encode_ls_nak(config_.station, request.command, ls_error_code(fault));
  std::array<std::uint16_t, ls_max_words> words{};
  for (unsigned i = 0; i < request.count; ++i) {
    if (request.command == 'W') parameters_.write(request.address + i, request.data[i]);
    words[i] = parameters_.read(request.address + i);
  }
  return encode_ls_ack(config_.station, request.command, std::span(words).first(request.count));
}

Status Inverter::set(std::string_view address, std::string_view hex) {
  const Bytes digits = to_bytes(hex);
  const std::optional<std::vector<std::uint16_t>> words = ls_words(digits);
  if (!words)
    return fail(
        fmt::format("cannot set parameter {} to '{}': write four hex digits a word", address, hex));
  if (words->empty())
    return fail(fmt::format(
        "cannot set parameter {}: there is no value; write four hex digits a word", address));
  const Result<unsigned> first = find_parameter(parameters_, address, words->size());
  if (!first) return first.error();
  for (unsigned i = 0; i < words->size(); ++i) parameters_.write(*first + i, (*words)[i]);
  return ok();
}

Result<std::string> Inverter::get(std::string_view address, std::size_t digits) const {
  if (address.starts_with('@'))
    return fail(fmt::format("cannot get {}: an inverter has no counters", address));
  const std::size_t wanted = digits == 0 ? digits_of_a_word : digits;
  if (wanted % digits_of_a_word != 0)
    return fail(
        fmt::format("cannot get {} digits at parameter {}: a word has four", wanted, address));
  const std::size_t words = wanted / digits_of_a_word;
  const Result<unsigned> first = find_parameter(parameters_, address, words);
  if (!first) return first.error();
  std::string value;
  for (unsigned i = 0; i < words; ++i)
    value += hex_number(parameters_.read(*first + i), digits_of_a_word);
  return value;
}

Status Inverter::act(std::string_view action) {
  const Result<plc::DeviceAction> parsed = plc::parse_device_action(action);
  if (!parsed) return parsed.error();
  if (*parsed != plc::DeviceAction::power_cycle) return ok();
  receiver_.reset();
  replies_.clear();
  return ok();
}

Result<InverterConfig> parse_inverter_config(const nlohmann::json& config) {
  constexpr std::array<std::string_view, 10> keys{
      "bench_line", "delay_ms", "inter_character_floor_ms",
      "line",       "model",    "neighbours",
      "protocol",   "rs485",    "station",
      "write_order"};
  constexpr const char* what = "the inverter's configuration";
  if (const Status known = plc::known_keys(config, what, keys); !known) return known.error();
  InverterConfig inverter;
  line::LineSettings line;
  bool address_first = true;
  plc::ConfigReader reader(config, what);
  reader.whole("station", 255, inverter.station);
  reader.either("write_order", "address_first", "count_first", address_first);
  reader.milliseconds("delay_ms", inverter.delay);
  reader.line("line", line);
  if (reader.error()) return *reader.error();
  inverter.write_order = address_first ? LsWriteOrder::address_first : LsWriteOrder::count_first;
  return inverter;
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_inverter(const nlohmann::json& config) {
  const Result<InverterConfig> parsed = parse_inverter_config(config);
  if (!parsed) return parsed.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::make_unique<Inverter>(*parsed));
}

}  // namespace fieldproof::ls_bus
