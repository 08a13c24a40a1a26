#include "src/xnet/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "src/base/bytes.hpp"

namespace fieldproof::xnet {

namespace {
std::size_t digits_of(const Area& area) { return area.bits ? 2 : 4; }

struct Run {
  Component first{};
  std::uint32_t count = 1;
};

/// What `digits` hex digits at a name cover; 0: one component.
Result<Run> find_run(std::string_view verb, std::string_view name, std::size_t digits,
                     const Memory& memory) {
  const std::optional<Component> component = memory.find(name);
  if (!component)
    return fail(fmt::format(
        "cannot {} {}: a XINJE PLC has no such component; write D100, HD0, M10 or, in octal, X17",
        verb, name));
  if (digits == 0) return Run{*component};
  const std::size_t each = digits_of(*component->area);
  if (digits % each != 0)
    return fail(
        fmt::format("cannot {} {}: {} digits are not a whole number of components; give {} "
                    "digits for each",
                    verb, name, digits, each));
  const std::size_t count = digits / each;
  const std::uint32_t room = memory.room_from(*component);
  if (count > room)
    return fail(fmt::format("cannot {} {} components from {} on: {} ends at {}", verb, count, name,
                            component->area->name,
                            to_string({component->area, component->number + room - 1})));
  return Run{*component, static_cast<std::uint32_t>(count)};
}
}  // namespace

Memory::Memory(Series series, std::uint32_t registers_d)
    : series_(series), registers_d_(registers_d ? registers_d : area_named("D").size) {
  std::size_t size = 0;
  for (const Area& area : areas()) {
    std::vector<Stored>& stored = stored_.emplace_back();
    for (const Range& range : ranges_of(area, series)) {
      stored.push_back({range, size});
      size += range.count;
    }
  }
  values_ = Zeroed<std::uint16_t>(size);
}

std::optional<Component> Memory::find(std::string_view name) const {
  const std::optional<Component> found = find_component(name, series_);
  return found && room_from(*found) > 0 ? found : std::nullopt;
}

std::uint32_t Memory::room_from(const Component& component) const {
  const std::uint32_t room = xnet::room_from(component, series_);
  if (component.area->name != "D") return room;
  return component.number < registers_d_ ? std::min(room, registers_d_ - component.number) : 0;
}

std::size_t Memory::place(const Component& component) const {
  const auto area = static_cast<std::size_t>(component.area - areas().data());
  for (const auto& [range, at] : stored_[area])
    if (component.number >= range.first && component.number - range.first < range.count)
      return at + component.number - range.first;
  throw std::out_of_range("xnet::Memory: component outside its area");
}

std::uint16_t* Memory::body(const Area& area) { return &values_[place({&area, 0})]; }

std::uint16_t Memory::read(const Component& component) const { return values_[place(component)]; }

void Memory::write(const Component& component, unsigned value) {
  values_[place(component)] = static_cast<std::uint16_t>(component.area->bits ? value & 1 : value);
}

Status Memory::set(std::string_view name, std::string_view hex) {
  if (hex.empty())
    return fail(fmt::format("cannot set {}: there is no value; give its hex digits", name));
  const Result<Run> run = find_run("set", name, hex.size(), *this);
  if (!run) return run.error();
  const std::size_t each = digits_of(*run->first.area);
  std::vector<unsigned> values;
  for (std::size_t at = 0; at < hex.size(); at += each) {
    unsigned value = 0;
    for (const char c : hex.substr(at, each)) {
      if (hex_digit(c) < 0)
        return fail(fmt::format("cannot set {} to {}: '{}' is not a hex digit", name, hex, c));
      value = value << 4 | static_cast<unsigned>(hex_digit(c));
    }
    if (run->first.area->bits && value > 1)
      return fail(fmt::format("cannot set {} to {}: a bit is 00 or 01", name, hex));
    values.push_back(value);
  }
  touch();
  for (std::uint32_t i = 0; i < run->count; ++i)
    write({run->first.area, run->first.number + i}, values[i]);
  return ok();
}

Result<std::string> Memory::get(std::string_view name, std::size_t digits) const {
  const Result<Run> run = find_run("get", name, digits, *this);
  if (!run) return run.error();
  std::string hex;
  for (std::uint32_t i = 0; i < run->count; ++i)
    hex += hex_number(read({run->first.area, run->first.number + i}),
                      static_cast<int>(digits_of(*run->first.area)));
  return hex;
}

}  // namespace fieldproof::xnet
