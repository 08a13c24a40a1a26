#include "suites/fuzz/wire_targets.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/endpoints/serial_ports/rfc2217_telnet.hpp"
#include "suites/fuzz/chosen.hpp"
#include "suites/fuzz/fed_device.hpp"
#include "suites/fuzz/rule.hpp"

namespace fieldproof::fuzz {

namespace {

using harness::Protocol;

constexpr std::size_t most_frames = 64;

void look_at(const Protocol& protocol, ByteView frame) {
  for (const std::vector<harness::Field>& fields :
       {protocol.explain(frame), protocol.explain_as(frame, true),
        protocol.explain_as(frame, false)})
    for (const harness::Field& field : fields)
      rule(field.offset + field.size <= frame.size(), "a field lies inside its frame");
  for (const bool reply : {true, false})
    for (const Protocol::AddressField& field : protocol.address_fields(frame, reply)) {
      rule(field.offset + field.size <= frame.size(), "an address lies inside its frame");
      if (field.size > 0) protocol.moved_field(frame, field, 1);
    }
  for (const Protocol::Written& written : protocol.written_by(frame)) {
    rule(written.first_word <= written.last_word, "what is written has a beginning and an end");
    if (!written.unknown() && written.last_word - written.first_word < 0x10000)
      protocol.places(written);
  }
  protocol.reply_repeats(frame);
  rule(protocol.in_plain_letters(frame).size() == frame.size(), "letters change no length");
  for (const bool client : {true, false})
    for (const bool sent : {true, false}) protocol.monitor_result(frame, client, sent);
  if (protocol.memory()) {
    [[maybe_unused]] const Status written = protocol.write_reply(frame);
    [[maybe_unused]] const Result<std::string> digits = protocol.read_reply(frame);
    [[maybe_unused]] const Status sound = protocol.sound_reply(frame, frame);
  }
  const Bytes probe = protocol.probe(1, frame);
  if (!probe.empty()) protocol.is_reply_to_probe(probe, frame);
}

/// Does it answer as a fresh one would?
void must_live(FedDevice& device, const Protocol& protocol) {
  const Bytes probe = protocol.probe(1, {});
  if (probe.empty()) return;
  device.pause(quiet);
  device.disconnect();
  device.connect();
  device.has_sent();
  device.feed(probe);
  device.pause(2s);
  rule(device.has_sent(), "a device lives on, whatever came");
}

void take_data(const endpoints::telnet::Message& message, Bytes& data) {
  if (const auto* more = std::get_if<Bytes>(&message))
    data.insert(data.end(), more->begin(), more->end());
}

}  // namespace

void feed_frames(ByteView input) {
  if (input.empty()) return;
  const Protocol& protocol = protocol_of(input.front());
  ByteView stream = input.subspan(1);
  look_at(protocol, stream);
  for (std::size_t i = 0; i < most_frames && !stream.empty(); ++i) {
    const std::optional<std::size_t> length = protocol.frame_length(stream);
    if (!length) return;
    rule(*length > 0 && *length <= stream.size(), "a frame has a length, and is there");
    look_at(protocol, stream.first(*length));
    stream = stream.subspan(*length);
  }
}

void feed_device(ByteView input) {
  if (input.empty()) return;
  const Protocol& protocol = protocol_of(input.front());
  if (!protocol.has_frames()) return;
  Result<std::unique_ptr<plc::EmulatedDevice>> made =
      protocol.make_device(protocol.models().front(), {{"station", 1}});
  rule(bool(made), "there is a device of each protocol");
  FedDevice device(protocol, std::move(*made));
  device.connect();
  device.feed_pieces(input.subspan(1));
  must_live(device, protocol);
}

void feed_memory(ByteView input) {
  if (input.empty()) return;
  const Protocol& protocol = protocol_of(input.front());
  const std::string text = to_text(input.subspan(1));
  const std::string address = text.substr(0, text.find('='));
  const std::string hex = text.substr(std::min(address.size() + 1, text.size()));
  [[maybe_unused]] const auto writes = protocol.write_requests(1, address, hex);
  [[maybe_unused]] const auto reads = protocol.read_requests(1, address, hex.size());
  protocol.named(address, hex.size());
  protocol.moved(address, 1);
}

std::vector<Bytes> memory_of_vectors() {
  std::set<Bytes> all;
  for (const vectors::Case& one : cases_of_vectors())
    for (const auto& [address, hex] : one.memory)
      if (const auto number = number_of(one.protocol); number && hex.size() < 200)
        all.insert(behind(*number, to_bytes(address + '=' + hex)));
  return {all.begin(), all.end()};
}

void feed_telnet(ByteView input) {
  if (input.empty()) return;
  const ByteView stream = input.subspan(1);
  endpoints::telnet::Decoder cut, whole;
  endpoints::telnet::Negotiator negotiator;
  Bytes in_pieces, at_once;
  for (const endpoints::telnet::Message& one : whole.decode(stream)) take_data(one, at_once);
  for (ByteView rest = stream; !rest.empty();) {
    const ByteView piece = rest.first(std::min<std::size_t>(input[0] + 1, rest.size()));
    for (const endpoints::telnet::Message& one : cut.decode(piece)) {
      take_data(one, in_pieces);
      if (const auto* said = std::get_if<endpoints::telnet::Negotiation>(&one))
        negotiator.answer(*said);
    }
    rest = rest.subspan(piece.size());
  }
  rule(in_pieces == at_once, "a stream says the same however it is cut");
  endpoints::telnet::Decoder other;
  Bytes back;
  for (const endpoints::telnet::Message& one : other.decode(endpoints::telnet::escaped(stream)))
    take_data(one, back);
  rule(std::ranges::equal(back, stream), "data comes out as it went in");
}

std::vector<Bytes> good_telnet() {
  using namespace endpoints::telnet;
  Bytes all = Negotiator::opening();
  for (const Bytes& more :
       {command(answer + set_baud_rate, Bytes{0, 0, 0x25, 0x80}), escaped(Bytes{5, 0xFF, 4}),
        command(answer + notify_line_state, Bytes{parity_error}), negotiation(dont, com_port)})
    all.insert(all.end(), more.begin(), more.end());
  return {behind(0, all), behind(6, all)};
}

std::vector<Bytes> frames_of_vectors() {
  std::set<Bytes> frames;
  for (const vectors::Case& one : cases_of_vectors()) {
    const std::optional<Byte> number = number_of(one.protocol);
    for (const vectors::Step& step : one.steps)
      for (const Bytes& bytes : wires_of(step))
        if (number) frames.insert(behind(*number, bytes));
  }
  return {frames.begin(), frames.end()};
}

std::vector<Bytes> streams_of_vectors() {
  constexpr Byte pause = 250;  // a frame has ended by then
  std::vector<Bytes> all = frames_of_vectors();
  std::erase_if(all, [](const Bytes& one) { return one.size() > 256; });
  for (Bytes& one : all) {
    const Bytes head{static_cast<Byte>(one.size() - 2), pause};
    one.insert(one.begin() + 1, head.begin(), head.end());
  }
  return all;
}

}  // namespace fieldproof::fuzz
