// An emulated device that plays a real one on a bad line, on simulated time: it keeps its memory
// from case to case, and nothing but its protocol reaches it. For tests.
#pragma once

#include <deque>
#include <random>
#include <set>

#include "harness/endpoints/emulator.hpp"

namespace fieldproof::noise {

/// How bad the line is. Of the bursts of one direction, so many in a hundred are damaged: a bit of
/// one byte flips, a byte is lost, or comes twice.
struct Badness {
  unsigned requests = 0, replies = 0;  // percent
  unsigned late = 0;                   // replies that come up to `lateness` later, percent
  Duration lateness{};
  int cut_after = -1;  // transmissions until the port fails; -1: never
};

class NoisyEndpoint : public endpoints::Endpoint {
 public:
  NoisyEndpoint(endpoints::Endpoint& device, const Badness& badness, std::uint64_t seed);
  /// What the device still had to answer comes, and nobody hears it; it gives up the connections
  /// that nobody has closed.
  ~NoisyEndpoint() override;

  /// The device as it is, for who looks at it past the line.
  endpoints::Endpoint& device() { return device_; }
  /// The line is as good as new.
  void mend() { badness_ = {}; }

  const endpoints::Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override { return "noisy line"; }
  Time now() const override { return device_.now(); }
  Duration character_time() const override { return device_.character_time(); }
  /// A real device is what it is.
  Status begin(const nlohmann::json&) override { return ok(); }
  Result<LinkId> open(Transport transport, std::uint16_t port) override;
  Status close(LinkId link, Closing how) override;
  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId link) override;
  Result<Burst> receive(Time deadline) override;

 private:
  bool chance(unsigned percent) { return random_() % 100 < percent; }
  Bytes damaged(ByteView bytes);
  Status count_transmission();
  void take(Burst burst);

  endpoints::Endpoint& device_;
  Badness badness_;
  endpoints::Capabilities capabilities_;
  std::mt19937_64 random_;
  std::deque<Burst> late_;  // in the order in which they come
  std::set<LinkId> open_;
};

}  // namespace fieldproof::noise
