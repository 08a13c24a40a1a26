#include "harness/exchange/memory_access.hpp"

#include <fmt/format.h>

#include "harness/exchange/sanity.hpp"
#include "harness/notation/notation.hpp"

namespace fieldproof::exchange {

namespace {

constexpr int repeats = 2;  // of a request whose answer is damaged

}  // namespace

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

Result<Bytes> MemoryAccess::ask(const Channel& server, ByteView request) {
  Visit& visit = aux_ && server.endpoint == aux_.endpoint ? *aux_visit_ : visit_;
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
  // An answer that is only late must not be taken for one to what is asked next.
  if (silent_)
    if (const Status over = let_pass(visit, endpoint.now() + ExchangeTiming().late_watch); !over)
      return over.error();
  said_ = fmt::format("sent {}, {}", notation::print_bytes(request),
                      silent_ ? "nothing came" : "received " + notation::print_bytes(reply));
  return reply;
}

/// Takes what comes until then, and what follows it.
Status MemoryAccess::let_pass(Visit& visit, Time until) {
  for (std::size_t heard = 0; heard <= flood_limit;) {
    const Result<Burst> burst = visit.receive(until);
    if (!burst) return burst.error();
    if (burst->bytes.empty()) return ok();
    heard += burst->bytes.size();
    until = burst->end() + ExchangeTiming().quiet;
  }
  return ok();
}

/// Once more where the line has damaged the answer; in a mode without checks where a device that
/// forgets all with its process takes no other.
Result<Bytes> MemoryAccess::ask_again(const Channel& server, ByteView request) {
  Result<Bytes> reply = ask(server, request);
  for (int i = 0; i < repeats && reply && !reply->empty() && !unsound_; ++i) {
    if (server.protocol->sound_reply(request, *reply)) break;
    if (const Status quiet = settle(*server.endpoint, ExchangeTiming().quiet); !quiet)
      return quiet.error();
    reply = ask(server, request);
  }
  unserved_ = !reply || !server.protocol->sound_reply(request, *reply);
  if (!reply || !unserved_) return reply;
  unsound_ = !reply->empty();  // it is the device, not the line: its form is for the cases to judge
  return reply;
}

Status MemoryAccess::write(const Channel& server, const std::string& address,
                           const std::string& hex) {
  const Result<std::vector<Bytes>> requests =
      server.protocol->write_requests(server.station, address, hex);
  if (!requests) return requests.error();
  for (const Bytes& request : *requests) {
    Result<Bytes> reply = ask_again(server, request);
    if (!reply) return reply.error();
    Status accepted = server.protocol->write_reply(*reply);
    const Bytes plain = server.protocol->memory()->without_check(request);
    if (!accepted && !silent_ && !plain.empty() &&
        server.endpoint->capabilities().can_power_cycle) {
      reply = ask(server, plain);
      if (!reply) return reply.error();
      if (server.protocol->write_reply(*reply)) accepted = ok();
    }
    refused_ = !accepted;
    if (!accepted) return fail("cannot set " + address + ": " + accepted.error().message);
  }
  return ok();
}

Result<std::string> MemoryAccess::read(const Channel& server, const std::string& address,
                                       std::size_t digits) {
  const Result<std::vector<Bytes>> requests =
      server.protocol->read_requests(server.station, address, digits);
  if (!requests) return requests.error();
  std::string value;
  for (const Bytes& request : *requests) {
    Result<Bytes> reply = ask_again(server, request);
    if (!reply) return reply.error();
    Result<std::string> part = server.protocol->read_reply(*reply);
    const Bytes plain = server.protocol->memory()->without_check(request);
    if (!part && !silent_ && !plain.empty()) {
      reply = ask(server, plain);
      if (!reply) return reply.error();
      if (Result<std::string> other = server.protocol->read_reply(*reply)) part = std::move(other);
    }
    refused_ = !part;
    if (!part) return fail("cannot read " + address + ": " + part.error().message);
    value += *part;
  }
  return value.substr(0, digits);
}

Status MemoryAccess::set(int station, const std::string& address, const std::string& hex) {
  refused_ = false;
  return write({device_.endpoint, device_.protocol, station}, address, hex);
}

Result<std::string> MemoryAccess::get(int station, const std::string& address, std::size_t digits) {
  refused_ = false;
  return read({device_.endpoint, device_.protocol, station}, address, digits);
}

Status MemoryAccess::set(const PreparedCase& prepared, const std::string& address,
                         const std::string& hex) {
  refused_ = false;
  if (device_.endpoint->capabilities().back_door) return device_.endpoint->set(address, hex);
  if (!prepared.is_client()) {
    if (!aux_ || device_.protocol->write_requests(prepared.station, address, hex))
      return write(own(prepared), address, hex);
    return write(aux_, address, hex);
  }
  if (aux_) {
    const Status written = write(aux_, address, hex);
    refused_ = false;  // a second channel that fails is trouble of the bench
    if (!written) return fail("--aux: " + written.error().message);
  }
  return arming_ ? arming_->set(address, hex) : ok();
}

bool MemoryAccess::can_read(const PreparedCase& prepared, const std::string& address) const {
  if (!prepared.is_client() || device_.endpoint->capabilities().back_door) return true;
  return aux_ && !address.starts_with('@');
}

Result<std::string> MemoryAccess::get(const PreparedCase& prepared, const std::string& address,
                                      std::size_t digits) {
  refused_ = false;
  if (device_.endpoint->capabilities().back_door) return device_.endpoint->get(address, digits);
  const bool by_itself = !prepared.is_client() && (!aux_ || device_.protocol->read_requests(
                                                                prepared.station, address, digits));
  Result<std::string> value =
      by_itself ? read(own(prepared), address, digits) : read(aux_, address, digits);
  if (by_itself) return value;
  refused_ = false;
  return value ? value : Result<std::string>(fail("--aux: " + value.error().message));
}

}  // namespace fieldproof::exchange
