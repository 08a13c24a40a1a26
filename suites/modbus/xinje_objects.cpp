#include "suites/modbus/xinje_objects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/xnet/plc.hpp"
#include "src/xnet_motion/axis_registers.hpp"
#include "src/xnet_network/configuration.hpp"
#include "suites/modbus/functions.hpp"
#include "suites/modbus/memory_requests.hpp"
#include "suites/modbus/message.hpp"

namespace fieldproof::modbus_suite {

using harness::Protocol;
using xnet::Component;

namespace {

constexpr Byte read_coils = 0x01, read_registers = 0x03, write_coils = 0x0F, write_registers = 0x10;
constexpr std::size_t coils_at_once = 64, registers_at_once = 32;

std::size_t digits_of(const Component& one) { return one.area->bits ? 2 : 4; }

/// What a request sets, and the PLC does not take, or takes for something else.
std::string not_settable(std::string_view area) {
  if (area == "X" || area == "ID") return "is an input; switch it where it is wired";
  if (area.starts_with("HSC")) return "counts pulses; send them to its input";
  if (area == "SFD" || area == "FD" || area == "FS")
    return "is read at power-on; set it in XINJEConfig, and switch the PLC off and on";
  return {};
}

Protocol::Written objects_from(const Component& first, std::uint32_t count) {
  return {std::string(first.area->name), first.number, first.number + count - 1, to_string(first),
          first.area->bits};
}

/// The bits that fill the last byte up are nobody's: the object behind may be of another axis.
std::uint32_t reached(const WriteMessage& one) {
  const bool filled = one.function->bits && one.count == (one.asked + 7) / 8 * 8;
  return filled ? one.asked : one.count;
}

/// Clients use them for objects; no manual says how (DECISIONS.md xnet/third-party-functions).
bool may_write_objects(Byte function) { return function >= 0x1E && function <= 0x21; }

/// A device may go on where an area ends.
void add_written(bool bits, std::uint32_t address, std::uint32_t count,
                 std::vector<Protocol::Written>& result) {
  while (count > 0) {
    const std::optional<Component> first = xnet::component_at(bits, address);
    const std::uint32_t here = first ? std::min(count, first->area->shown - first->number) : 1;
    if (first)
      result.push_back(objects_from(*first, here));
    else if (result.empty() || result.back().area != "?")
      result.push_back({"?", 0, ~0u, fmt::format("data address {:04X}", address)});
    address += here;
    count -= here;
  }
}

}  // namespace

bool is_xinje_model(std::string_view model) {
  return model == xnet::xd || xnet::find_model(model) != nullptr;
}

XinjeObjects::XinjeObjects(const Framing& framing, std::string_view model) : XinjeObjects(framing) {
  if (const xnet::Model* const known = xnet::find_model(model)) series_ = known->series;
}

Result<std::vector<XinjeObjects::Slice>> XinjeObjects::slices(std::string_view address,
                                                              std::size_t digits) const {
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

Result<std::vector<Bytes>> XinjeObjects::read_requests(int station, std::string_view address,
                                                       std::size_t digits) const {
  const Result<std::vector<Slice>> all = slices(address, digits);
  if (!all) return all.error();
  std::vector<Bytes> requests;
  for (const Slice& one : *all) {
    Bytes message{static_cast<Byte>(station), one.first.area->bits ? read_coils : read_registers};
    put_word(message, one.data_address());
    put_word(message, one.count);
    requests.push_back(framing_.wrap(message));
  }
  return requests;
}

Result<std::vector<Bytes>> XinjeObjects::write_requests(int station, std::string_view address,
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
    put_word(message, one.data_address());
    put_word(message, one.count);
    message.push_back(static_cast<Byte>(data.size()));
    message.insert(message.end(), data.begin(), data.end());
    requests.push_back(framing_.wrap(message));
  }
  return requests;
}

Result<std::string> XinjeObjects::digits_in(ByteView reply) const {
  Result<std::string> hex = read_reply(framing_, reply);
  const Bytes message = framing_.unwrap(reply);
  if (!hex || message.size() < 2 || message[1] != read_coils) return hex;
  std::string bits;
  for (std::size_t i = 3; i < message.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) bits += message[i] >> bit & 1 ? "01" : "00";
  return bits;
}

std::vector<Protocol::Written> XinjeObjects::written_by(ByteView request) const {
  std::vector<Protocol::Written> result;
  for (const WriteMessage& one : writes_in(framing_, request))
    if (one.function)
      add_written(one.function->bits, one.address, reached(one), result);
    else
      result.push_back({"?", 0, ~0u, "an unknown place"});
  for (const Bytes& message : framing_.messages(request))
    if (message.size() > 1 && may_write_objects(message[1]))
      result.push_back({"?", 0, ~0u, "an unknown place"});
  return result;
}

std::vector<Protocol::Place> XinjeObjects::places(const Protocol::Written& written) const {
  std::vector<Protocol::Place> result;
  if (written.unknown()) return result;
  const Component first = xnet::component_in(written.area, written.first_word);
  const std::uint32_t most = first.area->bits ? coils_at_once : registers_at_once;
  for (std::uint32_t at = written.first_word; at <= written.last_word; at += most) {
    const std::uint32_t count = std::min(most, written.last_word - at + 1);
    result.push_back({to_string(Component{first.area, at}), count * digits_of(first)});
  }
  return result;
}

std::optional<Protocol::Written> XinjeObjects::named(std::string_view address,
                                                     std::size_t digits) const {
  const std::optional<Component> first = xnet::find_component(address, series_);
  if (!first) return std::nullopt;
  Protocol::Written named =
      objects_from(*first, static_cast<std::uint32_t>(digits / digits_of(*first)));
  named.address = address;
  return named;
}

std::uint32_t XinjeObjects::words_of(std::string_view area) const {
  const auto found = std::ranges::find(xnet::areas(), area, &xnet::Area::name);
  if (found == xnet::areas().end()) return 0;
  return std::min(found->shown, series_ == xnet::Series::xd3 ? found->xd3 : found->size);
}

std::optional<Protocol::WordName> read_xinje_word(std::string_view text) {
  const bool whole = text.find_first_of("0123456789") == text.npos;
  const auto found = xnet::find_component(whole ? std::string(text) + "0" : std::string(text));
  if (!found) return std::nullopt;
  return Protocol::WordName{std::string(found->area->name),
                            whole ? std::nullopt : std::optional(found->number)};
}

std::string spell_xinje(std::string_view area, std::uint32_t word) {
  return to_string(xnet::component_in(area, word));
}

std::string xinje_axis(const Component& object) {
  std::uint32_t begin = ~0u;  // of the block of axis 1
  for (const xnet::Register& one : xnet::axis_registers())
    if (one.area == object.area->name) begin = std::min(begin, one.first);
  const std::uint32_t stride = xnet::stride_of(object.area->name);
  const bool inside = object.number >= begin && object.number - begin < xnet::last_axis * stride;
  return inside ? std::to_string((object.number - begin) / stride + 1) : "";
}

}  // namespace fieldproof::modbus_suite
