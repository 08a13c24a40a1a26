#include "suites/noise/noisy_endpoint.hpp"

#include <algorithm>

#include "harness/exchange/channel.hpp"
#include "harness/exchange/sanity.hpp"

namespace fieldproof::noise {

NoisyEndpoint::NoisyEndpoint(endpoints::Endpoint& device, const Badness& badness,
                             std::uint64_t seed)
    : device_(device), badness_(badness), capabilities_(device.capabilities()), random_(seed) {
  capabilities_.back_door = capabilities_.can_power_cycle = false;
  capabilities_.real_device = true;
}

Status NoisyEndpoint::count_transmission() {
  if (badness_.cut_after == 0) return fail("the cable was pulled out");
  if (badness_.cut_after > 0) --badness_.cut_after;
  return ok();
}

Result<LinkId> NoisyEndpoint::open(Transport transport, std::uint16_t port) {
  if (const Status there = count_transmission(); !there) return there.error();
  const Result<LinkId> link = device_.open(transport, port);
  if (link) open_.insert(*link);
  return link;
}

Status NoisyEndpoint::close(LinkId link, Closing how) {
  open_.erase(link);
  return device_.close(link, how);
}

NoisyEndpoint::~NoisyEndpoint() {
  [[maybe_unused]] const Result<bool> silent = exchange::settle(device_, 1s);
  for (const LinkId link : open_)
    [[maybe_unused]] const Status closed = device_.close(link, Closing::rst);
}

Bytes NoisyEndpoint::damaged(ByteView bytes) {
  Bytes result(bytes.begin(), bytes.end());
  const auto at = static_cast<std::ptrdiff_t>(random_() % result.size());
  switch (random_() % 3) {
    case 0: result[static_cast<std::size_t>(at)] ^= static_cast<Byte>(1u << (random_() % 8)); break;
    case 1: result.erase(result.begin() + at); break;
    default: result.insert(result.begin() + at, result[static_cast<std::size_t>(at)]); break;
  }
  return result;
}

Result<Sent> NoisyEndpoint::send(ByteView bytes, LinkId link) {
  if (const Status there = count_transmission(); !there) return there.error();
  if (bytes.empty() || !chance(badness_.requests)) return device_.send(bytes, link);
  return device_.send(damaged(bytes), link);
}

void NoisyEndpoint::take(Burst burst) {
  if (!burst.bytes.empty() && chance(badness_.replies)) burst.bytes = damaged(burst.bytes);
  // Replies keep their order, as on any line.
  if (chance(badness_.late))
    burst.start += Duration(static_cast<Duration::rep>(
        random_() % static_cast<std::uint64_t>(badness_.lateness.count() + 1)));
  if (!late_.empty()) burst.start = std::max(burst.start, late_.back().end());
  late_.push_back(std::move(burst));
}

Result<Burst> NoisyEndpoint::receive(Time deadline) {
  if (badness_.cut_after == 0) return fail("the cable was pulled out");
  while (true) {
    const Time until = late_.empty() ? deadline : std::min(deadline, late_.front().end());
    const Result<Burst> burst = device_.receive(until);
    if (!burst) return burst;
    if (exchange::is_nothing(*burst)) {
      if (late_.empty() || late_.front().end() > device_.now()) {
        if (device_.now() >= deadline) return burst;
        continue;
      }
      Burst due = std::move(late_.front());
      late_.pop_front();
      return due;
    }
    take(*burst);
    if (late_.front().end() > deadline && device_.now() >= deadline) return Burst{};
  }
}

}  // namespace fieldproof::noise
