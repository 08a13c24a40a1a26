#include "suites/xnet/over_modbus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "src/xnet/areas.hpp"
#include "suites/modbus/framing.hpp"
#include "suites/modbus/functions.hpp"
#include "suites/modbus/protocol.hpp"
#include "suites/xnet/axes.hpp"
#include "suites/xnet/ladder.hpp"
#include "suites/xnet/protocol.hpp"

namespace fieldproof::xnet_suite {

namespace {

using harness::Protocol;
using modbus_suite::Framing;
using xnet::Component;
using xnet::Series;

constexpr Byte read_coils = 0x01, read_registers = 0x03, write_coils = 0x0F, write_registers = 0x10;
constexpr std::size_t coils_at_once = 64, registers_at_once = 32;

std::size_t digits_of(const Component& one) { return one.area->bits ? 2 : 4; }

/// Consecutive components, as one request reaches them.
struct Slice {
  Component first;
  std::size_t count = 0;
  std::uint32_t data_address() const { return first.area->modbus + first.number; }
};

/// What a request sets, and the PLC does not take, or takes for something else.
std::string not_settable(std::string_view area) {
  if (area == "X" || area == "ID") return "is an input; switch it where it is wired";
  if (area.starts_with("HSC")) return "counts pulses; send them to its input";
  if (area == "SFD" || area == "FD" || area == "FS")
    return "is read at power-on; set it in XINJEConfig, and switch the PLC off and on";
  return {};
}

class OverModbus : public Protocol, public harness::Probing, public harness::MemoryRequests {
 public:
  OverModbus(const Protocol& carrier, const Framing& framing, Series series, Ladder ladder)
      : carrier_(carrier), framing_(framing), series_(series), ladder_(std::move(ladder)) {}

  std::string_view name() const override { return "xnet"; }
  std::vector<std::string> models() const override { return protocol().models(); }
  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const override {
    return carrier_.make_device(model, config);
  }
  std::uint16_t default_port() const override { return carrier_.default_port(); }
  Bytes station_bytes(int station) const override { return carrier_.station_bytes(station); }
  bool is_text() const override { return carrier_.is_text(); }
  notation::Checks checks() const override { return carrier_.checks(); }
  std::size_t longest_frame() const override { return carrier_.longest_frame(); }
  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    return carrier_.frame_length(bytes);
  }
  std::vector<harness::Field> explain(ByteView frame) const override {
    return carrier_.explain(frame);
  }
  Duration frame_gap(Duration character_time) const override {
    return carrier_.frame_gap(character_time);
  }

  const harness::Probing* probing() const override { return this; }
  const harness::MemoryRequests* memory() const override { return this; }
  const harness::Tables* tables() const override { return protocol().tables(); }
  Bytes probing_request(int station, ByteView tested) const override {
    return carrier_.probe(station, tested);
  }
  bool answers_probe(ByteView probe, ByteView reply) const override {
    return carrier_.is_reply_to_probe(probe, reply);
  }

  Result<std::unique_ptr<Protocol>> configured(std::string_view model,
                                               const nlohmann::json& config) const override {
    Result<Ladder> ladder = Ladder::read(config);
    if (!ladder) return ladder.error();
    const bool small = model == "xd2" || model == "xd3" || model == "xl3";
    return std::unique_ptr<Protocol>(std::make_unique<OverModbus>(
        carrier_, framing_, small ? Series::xd3 : Series::xd5, std::move(*ladder)));
  }

  Result<std::vector<Bytes>> requests_to_write(int station, std::string_view address,
                                               std::string_view hex) const override;
  Result<std::vector<Bytes>> requests_to_read(int station, std::string_view address,
                                              std::size_t digits) const override;
  Status acknowledged(ByteView reply) const override { return carrier_.write_reply(reply); }
  Result<std::string> digits_in(ByteView reply) const override;
  bool answers(ByteView request, ByteView reply) const override {
    return bool(carrier_.sound_reply(request, reply));
  }

  std::vector<Written> written_by(ByteView request) const override;
  std::optional<WordName> read_word(std::string_view text) const override {
    return protocol().read_word(text);
  }
  std::string spell(std::string_view area, std::uint32_t word) const override {
    return to_string(xnet::component_in(area, word));
  }
  std::vector<Place> places(const Written& written) const override;
  std::optional<Written> named(std::string_view address, std::size_t digits) const override;
  std::string_view output_areas() const override { return protocol().output_areas(); }

  Result<std::vector<Setting>> set_off_by(std::string_view action) const override {
    return ladder_.set_off(action);
  }
  std::vector<Setting> written_by_action(std::string_view action) const override {
    return ladder_.written_by(action, series_);
  }
  std::vector<Setting> premises(std::string_view axis) const override { return at_rest(axis); }
  bool wants_moments(const std::vector<std::vector<Setting>>& looks) const override;
  std::string moves(std::string_view action) const override { return axis_of_action(action); }
  std::string moved_by(std::string_view address) const override {
    const std::optional<Component> one = xnet::find_component(address, series_);
    if (!one) return {};
    const std::string axis = axis_of(*one);
    return axis.empty() ? ladder_.axis_behind(to_string(*one)) : axis;
  }

 private:
  Result<std::vector<Slice>> slices(std::string_view address, std::size_t digits) const;

  const Protocol& carrier_;
  const Framing& framing_;
  Series series_;
  Ladder ladder_;
};

/// Errors say what Modbus does not show.
Result<std::vector<Slice>> OverModbus::slices(std::string_view address, std::size_t digits) const {
  const auto wrong = [&](const std::string& why) {
    return fail(fmt::format("cannot reach {}: {}", address, why));
  };
  if (address.starts_with('@')) return wrong("it is seen in the model alone");
  const std::optional<Component> first = xnet::find_component(address, series_);
  if (!first) return wrong("this PLC has no such object");
  const std::size_t each = digits_of(*first);
  if (digits == 0 || digits % each != 0)
    return wrong(fmt::format("{} digits are no whole number of objects ({} each)", digits, each));
  const std::size_t count = digits / each;
  if (count > xnet::room_from(*first, series_)) return wrong("it goes past the end");
  if (first->number >= first->area->shown || count > first->area->shown - first->number)
    return wrong(first->area->shown == 0
                     ? fmt::format("Modbus does not show {}", first->area->name)
                     : fmt::format("Modbus shows {} to {}", to_string(Component{first->area, 0}),
                                   to_string(Component{first->area, first->area->shown - 1})));
  const std::size_t most = first->area->bits ? coils_at_once : registers_at_once;
  std::vector<Slice> all;
  for (std::size_t done = 0; done < count; done += most)
    all.push_back({{first->area, first->number + static_cast<std::uint32_t>(done)},
                   std::min(most, count - done)});
  return all;
}

Result<std::vector<Bytes>> OverModbus::requests_to_read(int station, std::string_view address,
                                                        std::size_t digits) const {
  const Result<std::vector<Slice>> all = slices(address, digits);
  if (!all) return all.error();
  std::vector<Bytes> requests;
  for (const Slice& one : *all) {
    Bytes message{static_cast<Byte>(station), one.first.area->bits ? read_coils : read_registers};
    modbus_suite::put_word(message, one.data_address());
    modbus_suite::put_word(message, one.count);
    requests.push_back(framing_.wrap(message));
  }
  return requests;
}

Result<std::vector<Bytes>> OverModbus::requests_to_write(int station, std::string_view address,
                                                         std::string_view hex) const {
  const Result<std::vector<Slice>> all = slices(address, hex.size());
  if (!all) return all.error();
  if (const std::string why = not_settable(all->front().first.area->name); !why.empty())
    return fail(fmt::format("{} {}", address, why));
  const std::optional<Bytes> values = from_hex(hex);
  if (!values) return fail(fmt::format("'{}' is not hex", hex));
  std::vector<Bytes> requests;
  std::size_t at = 0;  // of the values
  for (const Slice& one : *all) {
    const bool bits = one.first.area->bits;
    Bytes data(bits ? (one.count + 7) / 8 : 2 * one.count);
    for (std::size_t i = 0; i < (bits ? one.count : data.size()); ++i, ++at)
      if (bits)
        data[i / 8] |= static_cast<Byte>(((*values)[at] & 1) << (i % 8));
      else
        data[i] = (*values)[at];
    Bytes message{static_cast<Byte>(station), bits ? write_coils : write_registers};
    modbus_suite::put_word(message, one.data_address());
    modbus_suite::put_word(message, one.count);
    message.push_back(static_cast<Byte>(data.size()));
    message.insert(message.end(), data.begin(), data.end());
    requests.push_back(framing_.wrap(message));
  }
  return requests;
}

/// Coils have two digits each. What is behind the last one that was asked for is cut off by who
/// asked.
Result<std::string> OverModbus::digits_in(ByteView reply) const {
  Result<std::string> hex = carrier_.read_reply(reply);
  const Bytes message = framing_.unwrap(reply);
  if (!hex || message.size() < 2 || message[1] != read_coils) return hex;
  std::string bits;
  for (std::size_t i = 3; i < message.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) bits += message[i] >> bit & 1 ? "01" : "00";
  return bits;
}

std::vector<Protocol::Written> OverModbus::written_by(ByteView request) const {
  std::vector<Written> result;
  for (const Bytes& message : framing_.messages(request)) {
    if (message.size() < 6 || (message[1] != write_coils && message[1] != write_registers))
      continue;
    const std::optional<Component> first =
        xnet::component_at(message[1] == write_coils, modbus_suite::word_at(message, 2));
    if (!first) continue;
    const std::uint32_t count = modbus_suite::word_at(message, 4);
    result.push_back({std::string(first->area->name), first->number, first->number + count - 1,
                      to_string(*first), first->area->bits});
  }
  return result;
}

/// An axis that is under way, or whose objects change between two looks.
bool OverModbus::wants_moments(const std::vector<std::vector<Setting>>& looks) const {
  std::map<std::string, std::string> seen;
  for (const std::vector<Setting>& look : looks)
    for (const auto& [address, value] : look) {
      if (moved_by(address).empty()) continue;
      const std::optional<Component> one = xnet::find_component(address, series_);
      const bool running = one->area->bits && one->number % 20 == 1 && value == "01";
      const auto [before, fresh] = seen.try_emplace(address, value);
      if (running || (!fresh && before->second != value)) return true;
    }
  return false;
}

std::vector<Protocol::Place> OverModbus::places(const Written& written) const {
  std::vector<Place> result;
  const Component first = xnet::component_in(written.area, written.first_word);
  const std::uint32_t most = first.area->bits ? coils_at_once : registers_at_once;
  for (std::uint32_t at = written.first_word; at <= written.last_word; at += most) {
    const std::uint32_t count = std::min(most, written.last_word - at + 1);
    result.push_back({to_string(Component{first.area, at}), count * digits_of(first)});
  }
  return result;
}

std::optional<Protocol::Written> OverModbus::named(std::string_view address,
                                                   std::size_t digits) const {
  const std::optional<Component> first = xnet::find_component(address, series_);
  if (!first) return std::nullopt;
  const auto count = static_cast<std::uint32_t>(digits / digits_of(*first));
  return Written{std::string(first->area->name), first->number, first->number + count - 1,
                 std::string(address), first->area->bits};
}

}  // namespace

const Protocol& over_modbus_rtu() {
  static const OverModbus protocol(modbus_suite::rtu(), modbus_suite::rtu_framing(), Series::xd5,
                                   {});
  return protocol;
}

const Protocol& over_modbus_tcp() {
  static const OverModbus protocol(modbus_suite::tcp(), modbus_suite::tcp_framing(), Series::xd5,
                                   {});
  return protocol;
}

}  // namespace fieldproof::xnet_suite
