#include "harness/bench/memory_access.hpp"

namespace fieldproof {

Result<Bytes> MemoryAccess::ask(ByteView request) {
  if (const Duration gap = protocol_.frame_gap(endpoint_.character_time()); gap > 0ns && endpoint_.capabilities().wire)
    if (const Result<Burst> quiet = endpoint_.receive(endpoint_.now() + gap); !quiet) return quiet.error();
  const Result<Sent> sent = endpoint_.send(request);
  if (!sent) return sent.error();
  Bytes reply;
  while (!protocol_.frame_length(reply)) {
    const Result<Burst> burst = endpoint_.receive(sent->end + patience_);
    if (!burst) return burst.error();
    if (burst->bytes.empty()) break;
    reply.insert(reply.end(), burst->bytes.begin(), burst->bytes.end());
  }
  silent_ = reply.empty();
  return reply;
}

Status MemoryAccess::set(int station, const std::string& address, const std::string& hex) {
  refused_ = false;
  if (endpoint_.capabilities().back_door) return endpoint_.set(address, hex);
  const Result<std::vector<Bytes>> requests = protocol_.write_requests(station, address, hex);
  if (!requests) return requests.error();
  for (const Bytes& request : *requests) {
    const Result<Bytes> reply = ask(request);
    if (!reply) return reply.error();
    const Status accepted = protocol_.write_reply(*reply);
    refused_ = !accepted;
    if (!accepted) return fail("cannot set " + address + ": " + accepted.error().message);
  }
  return ok();
}

Result<std::string> MemoryAccess::get(int station, const std::string& address, std::size_t digits) {
  refused_ = false;
  if (endpoint_.capabilities().back_door) return endpoint_.get(address, digits);
  const Result<std::vector<Bytes>> requests = protocol_.read_requests(station, address, digits);
  if (!requests) return requests.error();
  std::string value;
  for (const Bytes& request : *requests) {
    const Result<Bytes> reply = ask(request);
    if (!reply) return reply.error();
    const Result<std::string> part = protocol_.read_reply(*reply);
    refused_ = !part;
    if (!part) return fail("cannot read " + address + ": " + part.error().message);
    value += *part;
  }
  return value.substr(0, digits);
}

}  // namespace fieldproof
