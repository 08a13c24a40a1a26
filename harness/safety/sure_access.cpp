#include "harness/safety/sure_access.hpp"

#include <fmt/format.h>
#include <utility>

#include "harness/exchange/sanity.hpp"

namespace fieldproof::safety {

using Kind = Reading::Kind;

namespace {

constexpr int attempts = 6;  // at one place
constexpr int patience_with_silence = 2;

bool is_sound(const Reading& reading) {
  return reading.kind == Kind::digits || reading.kind == Kind::refused;
}
bool agree(const Reading& one, const Reading& other) {
  return one.kind == other.kind && one.digits == other.digits;
}

}  // namespace

SureAccess::SureAccess(exchange::Channel device, Duration patience)
    : device_(device),
      memory_(device, patience),
      may_go_unchecked_(device.endpoint->capabilities().can_power_cycle) {}

/// Each request once. A refusal ends it.
Reading SureAccess::once(const Requests& requests, std::size_t digits) {
  Reading reading{Kind::digits, "", {}};
  for (const Bytes& request : requests) {
    const Result<Bytes> reply = memory_.ask(request);
    if (!reply) return {Kind::port, "", reply.error()};
    if (const Status sound = device_.protocol->sound_reply(request, *reply); !sound)
      return {reply->empty() ? Kind::unanswered : Kind::unsure, "", sound.error()};
    const Result<std::string> part = device_.protocol->read_reply(*reply);
    if (!part) return {Kind::refused, "", part.error()};
    reading.digits += *part;
  }
  if (reading.digits.size() < digits)
    return {Kind::unsure, "",
            fail(fmt::format("{} digits came, {} are due", reading.digits.size(), digits))};
  reading.digits.resize(digits);
  return reading;
}

/// What is damaged may be followed by more of it. (After silence MemoryAccess waits by itself.)
/// False: by more than the longest frame has. On a network more of it belongs to a connection that
/// is no more.
bool SureAccess::settle() {
  memory_.leave();
  if (device_.endpoint->capabilities().connections) return true;
  const Duration silence = exchange::ExchangeTiming().late_watch;
  const Result<bool> silent =
      exchange::settle(*device_.endpoint, silence,
                       silence + exchange::longest_reply(device_.protocol->longest_frame(),
                                                         device_.endpoint->character_time()));
  // A port that fails here fails in the next request, too, which then says so.
  return !silent || *silent;
}

Reading SureAccess::ask(const Requests& requests, std::size_t digits, bool twice) {
  std::optional<Reading> last;
  Error why = fail("two answers in a row were never the same");
  int silences = 0;
  bool damaged = false;
  const int most = hopeless_ ? patience_with_silence : attempts;
  for (int i = 0; i < most; ++i) {
    Reading reading = once(requests, digits);
    const bool sound = is_sound(reading);
    damaged_ += sound && damaged;
    damaged = reading.kind == Kind::unsure || reading.kind == Kind::unanswered;
    if (reading.kind == Kind::port) return reading;
    const bool enough = !twice && reading.kind == Kind::digits;
    if (sound) hopeless_ = false;
    if (sound && (enough || (last && agree(*last, reading)))) return reading;
    if (!sound) why = reading.why;
    if ((reading.kind == Kind::unsure || last) && !settle())
      return {Kind::endless, "", fail(std::string(exchange::without_end))};
    if (reading.kind == Kind::unanswered && ++silences == patience_with_silence) return reading;
    last.reset();
    if (sound) last = std::move(reading);
  }
  hopeless_ = true;
  return {Kind::unsure, "", fail(fmt::format("{} ({} attempts)", why.message, most))};
}

/// In a mode without checks: a device that the bench has started may have no other. One that has
/// answered with checks, and is silent now, is not asked again.
void SureAccess::ask_without_checks(const Requests& checked, std::size_t digits, Reading& reading) {
  const bool lost = reading.kind == Kind::port || reading.kind == Kind::endless ||
                    (reading.kind == Kind::unanswered && answers_ && !unchecked_);
  if (!may_go_unchecked_ || reading.kind == Kind::digits || lost) return;
  Requests plain;
  for (const Bytes& request : checked)
    plain.push_back(device_.protocol->memory()->without_check(request));
  if (plain.front().empty()) return;
  Reading other = ask(plain, digits, true);
  unchecked_ = unchecked_ || other.kind == Kind::digits;
  if (unchecked_ || is_sound(other)) reading = std::move(other);
}

Reading SureAccess::until_sure(const std::string& address, std::size_t digits, bool twice) {
  const Result<Requests> checked =
      device_.protocol->read_requests(device_.station, address, digits);
  if (!checked)
    return {Kind::no_request, "",
            fail(fmt::format("cannot read {}: {}", address, checked.error().message))};
  Reading reading;
  if (!unchecked_) {
    const bool has_check = device_.protocol->memory()->is_checked(checked->front());
    reading = ask(*checked, digits, twice || !has_check);
    answers_ = answers_ || is_sound(reading);
  }
  ask_without_checks(*checked, digits, reading);
  if (reading.kind != Kind::digits)
    reading.why.message = fmt::format("cannot read {}: {}", address, reading.why.message);
  return reading;
}

Reading SureAccess::read(const std::string& address, std::size_t digits) {
  return until_sure(address, digits, true);
}

Reading SureAccess::look(const std::string& address, std::size_t digits) {
  return until_sure(address, digits, false);
}

Status SureAccess::write_one(const std::string& address, ByteView request) {
  Error why = fail("");
  int refusals = 0;
  for (int i = 0; i < attempts && refusals < 2; ++i) {
    const Result<Bytes> reply = memory_.ask(request);
    if (!reply) return reply.error();
    const Status sound = device_.protocol->sound_reply(request, *reply);
    const Status done = sound ? device_.protocol->write_reply(*reply) : sound;
    if (done) return ok();
    why = done.error();
    refusals += bool(sound);
    if (!sound && !reply->empty() && !settle())
      return fail(fmt::format("cannot set {}: {}", address, exchange::without_end));
  }
  refused_ = refusals == 2;
  return fail(fmt::format("cannot set {}: {}", address, why.message));
}

Status SureAccess::write(const std::string& address, const std::string& hex) {
  refused_ = false;
  const Result<Requests> requests = device_.protocol->write_requests(device_.station, address, hex);
  if (!requests) return requests.error();
  for (const Bytes& request : *requests) {
    const Bytes plain = unchecked_ ? device_.protocol->memory()->without_check(request) : Bytes{};
    if (const Status done = write_one(address, plain.empty() ? request : plain); !done) return done;
  }
  return ok();
}

}  // namespace fieldproof::safety
