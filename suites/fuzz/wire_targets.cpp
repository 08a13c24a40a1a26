#include "suites/fuzz/wire_targets.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/paths.hpp"
#include "harness/vectors/loader.hpp"
#include "suites/fuzz/rule.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::fuzz {

namespace {

using harness::Protocol;

constexpr std::size_t most_frames = 64, most_wakes = 200'000;
constexpr Duration quiet = 60s;  // by then every time-out of a device is over

const Protocol& protocol_of(Byte number) {
  const harness::Protocols all = suites::protocols();
  return **(all.begin() + number % (all.end() - all.begin()));
}

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

/// One emulated device on given time, and all that it has sent.
class Fed {
 public:
  explicit Fed(const Protocol& protocol) : protocol_(protocol) {
    Result<std::unique_ptr<plc::EmulatedDevice>> made =
        protocol.make_device(protocol.models().front(), {{"station", 1}});
    rule(bool(made), "there is a device of each protocol");
    device_ = std::move(*made);
    tell(1, LinkEvent::opened);
  }

  void feed(ByteView bytes) {
    run(now_);
    Burst burst;
    burst.bytes.assign(bytes.begin(), bytes.end());
    burst.start = now_;
    if (net::Host* const host = network()) {
      burst.link = link_;
      host->receive(burst);
    } else if (line::Device* const line = device_->line()) {
      burst.character_time = 100us;
      line->receive(burst);
      now_ = burst.end();
    }
    run(now_);
  }
  void pause(Duration time) { run(now_ + time); }

  /// Does it answer as a fresh one would?
  void must_live() {
    const Bytes probe = protocol_.probe(1, {});
    if (probe.empty()) return;
    pause(quiet);
    tell(link_, LinkEvent::reset);
    tell(++link_, LinkEvent::opened);
    sent_.clear();
    feed(probe);
    pause(2s);
    rule(!sent_.empty(), "a device lives on, whatever came");
  }

 private:
  void tell(LinkId link, LinkEvent event) {
    net::Host* const host = network();
    if (!host) return;
    Burst burst;
    burst.start = now_;
    burst.link = link;
    burst.event = event;
    burst.port = protocol_.default_port();
    host->receive(burst);
    run(now_);
  }
  net::Host* network() { return protocol_.default_port() == 0 ? nullptr : device_->network(); }
  std::optional<Time> wake() {
    if (net::Host* const host = network()) return host->wake_at();
    line::Device* const line = device_->line();
    return line ? line->wake_at() : std::nullopt;
  }
  void take(ByteView bytes) { sent_.insert(sent_.end(), bytes.begin(), bytes.end()); }
  void run(Time until) {
    std::size_t wakes = 0;
    for (auto at = wake(); at && *at <= until; at = wake()) {
      rule(++wakes < most_wakes, "a device comes to rest");
      now_ = std::max(now_, *at);
      if (net::Host* const host = network())
        for (const Burst& burst : host->advance(now_)) take(burst.bytes);
      else
        take(device_->line()->advance(now_));
    }
    now_ = std::max(now_, until);
  }

  const Protocol& protocol_;
  std::unique_ptr<plc::EmulatedDevice> device_;
  Time now_{};
  LinkId link_ = 1;
  Bytes sent_;
};

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

/// Pieces: a byte for the length of each, and for the pause behind it.
void feed_device(ByteView input) {
  if (input.empty()) return;
  const Protocol& protocol = protocol_of(input.front());
  if (!protocol.has_frames()) return;
  Fed device(protocol);
  ByteView rest = input.subspan(1);
  while (rest.size() > 2) {
    const std::size_t count = std::min<std::size_t>(rest[0] + 1, rest.size() - 2);
    const Duration pause = rest[1] * 200us;
    device.feed(rest.subspan(2, count));
    device.pause(pause);
    rest = rest.subspan(2 + count);
  }
  device.must_live();
}

std::vector<Bytes> frames_of_vectors() {
  const harness::Protocols all = suites::protocols();
  vectors::VectorSet set = vectors::load_vectors(harness::find_data().vectors, {.protocols = all});
  vectors::load_wires(harness::find_data().vectors, set);
  std::vector<Bytes> frames;
  for (const vectors::Case& one : set.cases) {
    const Protocol* const protocol = all.find(one.protocol);
    if (!protocol) continue;
    const auto number = std::ranges::find(all.begin(), all.end(), protocol) - all.begin();
    for (const vectors::Step& step : one.steps)
      for (const vectors::Frame& frame : step.frames) {
        std::string hex = frame.wire.value_or("");
        std::ranges::replace(hex, '?', '0');
        std::optional<Bytes> bytes = from_hex(hex);
        if (!bytes || bytes->empty()) continue;
        bytes->insert(bytes->begin(), static_cast<Byte>(number));
        frames.push_back(std::move(*bytes));
      }
  }
  std::ranges::sort(frames);
  frames.erase(std::ranges::unique(frames).begin(), frames.end());
  return frames;
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
