#include "harness/exchange/partner.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <optional>

namespace fieldproof::exchange {

using harness::Field;
using harness::Protocol;
using notation::find_check;
using plc::EmulatedDevice;

namespace {

constexpr Byte foreign = '*';            // stands in no frame of these protocols
constexpr Duration longest_think = 10s;  // no device answers later

bool is_hex(ByteView bytes) {
  return !bytes.empty() &&
         std::ranges::all_of(bytes, [](Byte b) { return hex_digit(static_cast<char>(b)) >= 0; });
}

/// A frame that can be changed field by field; its check follows.
class Editor {
 public:
  Editor(ByteView frame, const Protocol& protocol)
      : bytes_(frame.begin(), frame.end()),
        fields_(protocol.explain(frame)),
        checks_(protocol.checks()) {}

  const Field* find(std::string_view name) const {
    const auto found = std::ranges::find(fields_, name, &Field::name);
    return found == fields_.end() ? nullptr : &*found;
  }
  /// That of the content: no length.
  const Field* check() const {
    const auto found = std::ranges::find_if(fields_, [&](const Field& field) {
      const notation::Check* check = find_check(checks_, field.name);
      return check && !check->counts;
    });
    return found == fields_.end() ? nullptr : &*found;
  }
  /// The last field that carries something: no frame part and no station.
  const Field* content() const {
    const auto carries = [&](const Field& field) {
      return field.size > 0 && field.name != "header" && field.name != "station" &&
             field.name != "tail" && !find_check(checks_, field.name);
    };
    const auto found = std::find_if(fields_.rbegin(), fields_.rend(), carries);
    return found == fields_.rend() ? nullptr : &*found;
  }
  ByteView part(const Field& field) const {
    return ByteView(bytes_).subspan(field.offset, field.size);
  }
  std::vector<Field>& fields() { return fields_; }

  void replace(std::size_t at, std::size_t size, ByteView with) {
    const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(at);
    const auto place = bytes_.erase(begin, begin + static_cast<std::ptrdiff_t>(size));
    bytes_.insert(place, with.begin(), with.end());
    for (Field& field : fields_)
      if (field.offset >= at + size) field.offset = field.offset + with.size() - size;
  }

  /// What the check covers.
  ByteView covered(const Field& check) const {
    const bool behind = find_check(checks_, check.name)->behind;
    return behind ? ByteView(bytes_).subspan(check.offset + check.size)
                  : ByteView(bytes_).first(check.offset);
  }

  /// Lengths and checks follow, in the order of the frame.
  Bytes finish() {
    for (const Field& field : fields_) {
      const notation::Check* check = find_check(checks_, field.name);
      if (!check) continue;
      const Bytes right = check->over(covered(field));
      std::ranges::copy(right, bytes_.begin() + static_cast<std::ptrdiff_t>(field.offset));
    }
    return std::move(bytes_);
  }

 private:
  Bytes bytes_;
  std::vector<Field> fields_;
  notation::Checks checks_;
};

Error lacks(std::string_view fault, const std::string& what) {
  return fail(fmt::format("cannot answer with {}: {}", fault, what));
}

/// A byte of the content less or more: two digits where it is written so.
Result<Bytes> resized(std::string_view fault, Editor frame, const Protocol& protocol) {
  const Field* content = frame.content();
  if (!content) return lacks(fault, "the answer has no content");
  const std::size_t byte = protocol.is_text() ? 2 : 1;
  const std::size_t end = content->offset + content->size;
  if (fault == "long")
    frame.replace(end, 0, protocol.is_text() ? Bytes{'0', '0'} : Bytes{0});
  else
    frame.replace(end - std::min(byte, content->size), std::min(byte, content->size), {});
  return frame.finish();
}

Result<Bytes> without_hex(Editor frame, const Protocol& protocol) {
  const Field* content = frame.content();
  if (!protocol.is_text())
    return lacks("not_hex", fmt::format("the frames of {} are binary", protocol.name()));
  if (!content || !is_hex(frame.part(*content)))
    return lacks("not_hex", "the answer has no hex digits but its station");
  frame.replace(content->offset, 1, Bytes{'G'});
  return frame.finish();
}

/// The request with addresses that no device has: it is refused in the form that the client waits
/// for.
Result<Bytes> unanswerable(ByteView request, const Protocol& protocol) {
  Editor frame(request, protocol);
  bool found = false;
  for (const Field& field : frame.fields()) {
    const bool name = field.name == "name" ||
                      (field.name.starts_with("name ") && !field.name.starts_with("name length"));
    if (!name && field.name != "address") continue;
    frame.replace(field.offset, field.size,
                  Bytes(field.size, protocol.is_text() ? Byte{'F'} : Byte{0xFF}));
    found = true;
  }
  if (!found) return lacks("nak", "the request has no address that could be refused");
  return frame.finish();
}

/// What the device says to the request, and when.
/// Over a connection of its own, which nobody closes: the device is asked by this partner alone.
Partner::Answer ask(net::Host& host, std::uint16_t port, Burst request) {
  constexpr LinkId link = 1;
  host.advance(request.end());
  host.receive({{}, request.end(), {}, link, LinkEvent::opened, port, "127.0.0.1:49152"});
  host.receive({request.bytes, request.end(), {}, link, LinkEvent::data, port, {}});
  const Time give_up = request.end() + longest_think;
  for (Time now = request.end();;) {
    for (Burst& burst : host.advance(now))
      if (burst.link == link && !burst.bytes.empty()) return {std::move(burst.bytes), now};
    const std::optional<Time> wake = host.wake_at();
    if (!wake || *wake > give_up) return {{}, now};
    now = std::max(now, *wake);
  }
}

Partner::Answer ask(EmulatedDevice& device, const Burst& request, const Protocol& protocol) {
  if (!device.line() && device.network())
    return ask(*device.network(), protocol.default_port(), request);
  line::Device& line = *device.line();
  line.advance(request.start);
  line.receive(request);
  const Time give_up = request.end() + longest_think;
  for (Time now = request.end();;) {
    if (Bytes bytes = line.advance(now); !bytes.empty()) return {std::move(bytes), now};
    const std::optional<Time> wake = line.wake_at();
    if (!wake || *wake > give_up) return {{}, now};
    now = std::max(now, *wake);
  }
}

}  // namespace

Result<Bytes> damaged(std::string_view fault, ByteView answer, int station,
                      const Protocol& protocol) {
  Editor frame(answer, protocol);
  if (fault == "short" || fault == "long") return resized(fault, std::move(frame), protocol);
  if (fault == "not_hex") return without_hex(std::move(frame), protocol);
  if (fault == "wrong_check") {
    const Field* check = frame.check();
    if (!check) return lacks(fault, "the answer has none");
    Bytes bytes(answer.begin(), answer.end());
    const Bytes wrong =
        find_check(protocol.checks(), check->name)->wrong_over(frame.covered(*check));
    std::ranges::copy(wrong, bytes.begin() + static_cast<std::ptrdiff_t>(check->offset));
    return bytes;
  }
  const std::string name = fault == "wrong_head"   ? "header"
                           : fault == "wrong_tail" ? "tail"
                                                   : "station";
  const Field* field = frame.find(name);
  if (!field) return lacks(fault, fmt::format("the answer has no {}", name));
  const Bytes other =
      name == "station" ? protocol.station_bytes((station + 1) % 256) : Bytes(field->size, foreign);
  frame.replace(field->offset, field->size, other);
  return frame.finish();
}

Result<EmulatedDevice*> Partner::device_for(const vectors::PartnerSpec& spec) {
  const std::string model = spec.model.empty() ? protocol_.models().front() : spec.model;
  std::unique_ptr<EmulatedDevice>& device = devices_[model + ' ' + spec.config.dump()];
  if (!device) {
    Result<std::unique_ptr<EmulatedDevice>> made = protocol_.make_device(model, spec.config);
    if (!made) return fail("cannot make the partner: " + made.error().message);
    device = std::move(*made);
  }
  for (const auto& [address, hex] : spec.memory)
    if (const Status set = device->set(address, hex); !set)
      return fail("cannot make the partner: " + set.error().message);
  return device.get();
}

Result<Bytes> Partner::faulty(const vectors::PartnerSpec& spec, EmulatedDevice& device,
                              const Burst& request, const Bytes& answer) const {
  if (spec.fault == "never") return Bytes{};
  if (spec.fault == "echo") return request.bytes;
  if (spec.fault == "garbage") return Bytes(std::max<std::size_t>(answer.size(), 1), foreign);
  if (spec.fault == "previous") {
    if (exchanged_.empty()) return lacks(spec.fault, "nothing was asked before in this case");
    return exchanged_.back().answer;
  }
  if (spec.fault == "other_block") {
    const auto other =
        std::find_if(exchanged_.rbegin(), exchanged_.rend(),
                     [&](const Exchanged& one) { return one.request != request.bytes; });
    if (other == exchanged_.rend())
      return lacks(spec.fault, "no other block has asked before in this case");
    return other->answer;
  }
  if (spec.fault == "nak") {
    const Result<Bytes> refused = unanswerable(request.bytes, protocol_);
    if (!refused) return refused.error();
    return ask(device, {*refused, request.end(), request.character_time}, protocol_).bytes;
  }
  if (answer.empty()) return lacks(spec.fault, "the partner does not answer this request");
  return damaged(spec.fault, answer, vectors::config_station(spec.config, 1).value_or(1),
                 protocol_);
}

Result<Partner::Answer> Partner::answer(const vectors::PartnerSpec& spec, const Burst& request,
                                        Time too_late) {
  const Result<EmulatedDevice*> device = device_for(spec);
  if (!device) return device.error();
  Answer answer = ask(**device, request, protocol_);
  const Bytes right = answer.bytes;
  if (spec.fault == "late") answer.moment = std::max(answer.moment, too_late);
  if (!spec.fault.empty() && spec.fault != "late") {
    Result<Bytes> bytes = faulty(spec, **device, request, right);
    if (!bytes) return bytes.error();
    answer.bytes = std::move(*bytes);
  }
  exchanged_.push_back({request.bytes, right});
  return answer;
}

}  // namespace fieldproof::exchange
