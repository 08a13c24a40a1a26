#include "harness/exchange/memory_access.hpp"

#include <fmt/format.h>

#include "harness/exchange/timing.hpp"
#include "harness/notation/beginning.hpp"
#include "harness/notation/notation.hpp"

namespace fieldproof::exchange {

namespace {

constexpr int repeats = 2;  // of a request whose answer is damaged

}  // namespace

PlaceName place_name(std::string_view address) {
  const bool named = address.size() > 2 && address[1] == ':';
  return named ? PlaceName{address.substr(0, 1), address.substr(2)} : PlaceName{{}, address};
}

MemoryAccess::MemoryAccess(Channel device, Duration patience, Channel aux, Arming* arming,
                           Visit::Elsewhere elsewhere)
    : device_(device),
      patience_(patience),
      aux_(aux),
      arming_(arming),
      visit_(device, std::move(elsewhere)) {
  if (aux_) aux_visit_.emplace(aux_);
}

void MemoryAccess::leave() {
  visit_.leave();
  if (aux_visit_) aux_visit_->leave();
}

Visit& MemoryAccess::visit_of(const Channel& server) {
  return aux_ && server.endpoint == aux_.endpoint ? *aux_visit_ : visit_;
}

Result<Bytes> MemoryAccess::ask(const Channel& server, ByteView request) {
  Visit& visit = visit_of(server);
  const endpoints::Endpoint& endpoint = *server.endpoint;
  if (const Duration gap = server.protocol->frame_gap(endpoint.character_time());
      gap > 0ns && endpoint.capabilities().wire)
    if (const Result<Burst> quiet = visit.receive(endpoint.now() + gap); !quiet)
      return quiet.error();
  const Result<Sent> sent = visit.send(request);
  if (!sent) return sent.error();
  Bytes reply;
  while (!server.protocol->frame_length(reply) && reply.size() <= flood_limit) {
    const Result<Burst> burst = visit.receive(sent->end + patience_);
    if (!burst) return burst.error();
    if (burst->bytes.empty()) break;
    reply.insert(reply.end(), burst->bytes.begin(), burst->bytes.end());
  }
  silent_ = reply.empty();
  endless_ = reply.size() > flood_limit;
  // An answer that is only late must not be taken for one to what is asked next.
  if (silent_)
    if (const Status over = let_pass(server, ExchangeTiming().late_watch); !over)
      return over.error();
  asked_.assign(request.begin(), request.end());
  answered_ = reply;
  return reply;
}

std::string MemoryAccess::why(const Error& error) const {
  return endless_ ? std::string(without_end) : error.message;
}

std::string MemoryAccess::said() const {
  return fmt::format("sent {}, {}", notation::print_bytes(asked_),
                     silent_ ? "nothing came" : "received " + notation::print_beginning(answered_));
}

/// Takes what comes in so long, and what follows it without a pause; no longer than a frame lasts.
Status MemoryAccess::let_pass(const Channel& server, Duration silence) {
  const endpoints::Endpoint& endpoint = *server.endpoint;
  const Time give_up = endpoint.now() + silence +
                       longest_reply(server.protocol->longest_frame(), endpoint.character_time());
  Time until = endpoint.now() + silence;
  for (std::size_t heard = 0; heard <= flood_limit && endpoint.now() < give_up;) {
    const Result<Burst> burst = visit_of(server).receive(until);
    if (!burst) return burst.error();
    if (burst->bytes.empty()) return ok();
    heard += burst->bytes.size();
    until = burst->end() + ExchangeTiming().pause;
  }
  endless_ = true;
  return ok();
}

/// Once more where the line has damaged the answer.
Result<Bytes> MemoryAccess::ask_again(const Channel& server, ByteView request) {
  Result<Bytes> reply = ask(server, request);
  return sound(server, request, std::move(reply));
}

/// The same, and once more where the answer was lost: what sets memory does the same twice. Who was
/// silent both times is asked once from then on, until it answers.
Result<Bytes> MemoryAccess::set_again(const Channel& server, ByteView request) {
  Result<Bytes> reply = ask(server, request);
  if (reply && silent_ && !mute_) reply = ask(server, request);
  mute_ = silent_;
  return sound(server, request, std::move(reply));
}

/// That answer, or what came in its place when it was asked for again.
Result<Bytes> MemoryAccess::sound(const Channel& server, ByteView request, Result<Bytes> reply) {
  for (int i = 0; i < repeats && reply && !reply->empty() && !unsound_; ++i) {
    if (server.protocol->sound_reply(request, *reply)) break;
    if (const Status over = let_pass(server, ExchangeTiming().pause); !over) return over.error();
    if (endless_) break;
    reply = ask(server, request);
  }
  unserved_ = !reply || !server.protocol->sound_reply(request, *reply);
  if (!reply || !unserved_) return reply;
  unsound_ = !reply->empty();  // it is the device, not the line: its form is for the cases to judge
  return reply;
}

/// Where what comes is not `taken`, the same once more in a mode without checks.
Result<Bytes> MemoryAccess::ask_in_any_mode(const Channel& server, ByteView request,
                                            const std::function<bool(ByteView)>& taken) {
  Result<Bytes> reply = ask_again(server, request);
  if (!reply || lost() || taken(*reply)) return reply;
  const Bytes plain = server.protocol->memory()->without_check(request);
  if (plain.empty()) return reply;
  Result<Bytes> other = ask(server, plain);
  return other && !taken(*other) ? reply : other;
}

Status MemoryAccess::write(const Channel& server, const std::string& address,
                           const std::string& hex) {
  const Result<std::vector<Bytes>> requests =
      server.protocol->write_requests(server.station, address, hex);
  if (!requests) return requests.error();
  // What is written without a check may go elsewhere: only to a device that forgets all with its
  // process.
  const bool in_any_mode = server.endpoint->capabilities().can_power_cycle;
  const auto taken = [&](ByteView reply) { return bool(server.protocol->write_reply(reply)); };
  for (const Bytes& request : *requests) {
    const Result<Bytes> reply =
        in_any_mode ? ask_in_any_mode(server, request, taken) : set_again(server, request);
    if (!reply) return reply.error();
    const Status accepted = server.protocol->write_reply(*reply);
    refused_ = !accepted;
    if (!accepted) return fail("cannot set " + address + ": " + why(accepted.error()));
  }
  return ok();
}

Result<std::string> MemoryAccess::read(const Channel& server, const std::string& address,
                                       std::size_t digits) {
  const Result<std::vector<Bytes>> requests =
      server.protocol->read_requests(server.station, address, digits);
  if (!requests) return requests.error();
  const auto taken = [&](ByteView reply) { return bool(server.protocol->read_reply(reply)); };
  std::string value;
  for (const Bytes& request : *requests) {
    const Result<Bytes> reply = ask_in_any_mode(server, request, taken);
    if (!reply) return reply.error();
    const Result<std::string> part = server.protocol->read_reply(*reply);
    refused_ = !part;
    if (!part) return fail("cannot read " + address + ": " + why(part.error()));
    value += *part;
  }
  return value.substr(0, digits);
}

/// The bench reaches one.
Result<Channel> MemoryAccess::partner(const PlaceName& name) const {
  if (name.partner == "B" && aux_) return aux_;
  return fail(fmt::format("cannot reach {} of {}: {}", name.address, name.partner,
                          aux_ ? "--aux leads to B alone" : "give --aux a port of that PLC"));
}

Status MemoryAccess::partner_of(const std::string& address) const {
  const PlaceName name = place_name(address);
  if (name.partner.empty()) return ok();
  const Result<Channel> there = partner(name);
  return there ? ok() : Status(there.error());
}

Status MemoryAccess::set(const PreparedCase& prepared, const std::string& address,
                         const std::string& hex) {
  refused_ = false;
  if (device_.endpoint->capabilities().back_door) return device_.endpoint->set(address, hex);
  if (const PlaceName name = place_name(address); !name.partner.empty()) {
    const Result<Channel> other = partner(name);
    return other ? write(*other, std::string(name.address), hex) : Status(other.error());
  }
  if (!prepared.is_client()) {
    const bool by_itself =
        bool(device_.protocol->write_requests(prepared.station, address, hex)) &&
        !(prepared.goes_past_the_wire() && device_.endpoint->capabilities().control);
    if (!by_itself && device_.endpoint->capabilities().control)
      return device_.endpoint->set(address, hex);
    return write(by_itself || !aux_ ? own(prepared) : aux_, address, hex);
  }
  if (aux_) {
    const Status written = write(aux_, address, hex);
    refused_ = false;  // a second channel that fails is trouble of the bench
    if (!written) return fail("--aux: " + written.error().message);
  }
  return arming_ ? arming_->set(address, hex) : ok();
}

Status MemoryAccess::set(const PreparedCase& prepared, MemoryRun run) {
  const auto [first, all] = as_one(run);
  Status done = set(prepared, first, all);
  const bool as_words = !done && refused_ && !lost() && run.size() > 1;
  if (!as_words) return done;
  for (const auto& [address, hex] : run)
    if (done = set(prepared, address, hex); !done) break;
  return done;
}

std::vector<MemoryRun> MemoryAccess::runs(const PreparedCase& prepared,
                                          const MemoryValues& values) const {
  const bool asked = !device_.endpoint->capabilities().back_door && !prepared.is_client();
  return asked ? runs_of(values, *device_.protocol) : each_of(values);
}

bool MemoryAccess::can_read(const PreparedCase& prepared, const std::string& address) const {
  if (!prepared.is_client() || device_.endpoint->capabilities().back_door) return true;
  return aux_ && !address.starts_with('@');
}

Result<std::string> MemoryAccess::get(const PreparedCase& prepared, const std::string& address,
                                      std::size_t digits) {
  refused_ = false;
  if (device_.endpoint->capabilities().back_door) return device_.endpoint->get(address, digits);
  if (const PlaceName name = place_name(address); !name.partner.empty()) {
    const Result<Channel> other = partner(name);
    return other ? read(*other, std::string(name.address), digits)
                 : Result<std::string>(other.error());
  }
  const bool readable =
      bool(device_.protocol->read_requests(prepared.station, address, digits)) &&
      !(prepared.goes_past_the_wire() && device_.endpoint->capabilities().control);
  if (!prepared.is_client() && !readable && device_.endpoint->capabilities().control)
    return device_.endpoint->get(address, digits);
  const bool by_itself = !prepared.is_client() && (!aux_ || readable);
  Result<std::string> value =
      by_itself ? read(own(prepared), address, digits) : read(aux_, address, digits);
  if (by_itself) return value;
  refused_ = false;
  return value ? value : Result<std::string>(fail("--aux: " + value.error().message));
}

}  // namespace fieldproof::exchange
