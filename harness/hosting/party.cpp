#include "harness/hosting/party.hpp"

#include <algorithm>
#include <iterator>

namespace fieldproof::hosting {

namespace {

class OnLine final : public Party {
 public:
  explicit OnLine(line::Device& device) : device_(device) {}
  void receive(const Burst& burst) override { device_.receive(burst); }
  std::optional<Time> wake_at() const override { return device_.wake_at(); }
  std::vector<Burst> advance(Time now) override {
    Bytes bytes = device_.advance(now);
    if (bytes.empty()) return {};
    return {Burst{.bytes = std::move(bytes), .start = now}};
  }
  bool listens(Transport, std::uint16_t) const override { return false; }

 private:
  line::Device& device_;
};

class OnNetwork final : public Party {
 public:
  explicit OnNetwork(net::Host& device) : device_(device) {}
  void receive(const Burst& burst) override { device_.receive(burst); }
  std::optional<Time> wake_at() const override { return device_.wake_at(); }
  std::vector<Burst> advance(Time now) override { return device_.advance(now); }
  bool listens(Transport transport, std::uint16_t port) const override {
    return device_.listens(transport, port);
  }

 private:
  net::Host& device_;
};

class OnBoth final : public Party {
 public:
  OnBoth(net::Host& network, line::Device& line) : network_(network), line_(line) {}
  void receive(const Burst& burst) override {
    burst.link == line_link ? line_.receive(burst) : network_.receive(burst);
  }
  std::optional<Time> wake_at() const override {
    const std::optional<Time> one = network_.wake_at(), other = line_.wake_at();
    return one && other ? std::min(*one, *other) : one ? one : other;
  }
  std::vector<Burst> advance(Time now) override {
    std::vector<Burst> all = network_.advance(now);
    std::ranges::move(line_.advance(now), std::back_inserter(all));
    return all;
  }
  bool listens(Transport transport, std::uint16_t port) const override {
    return network_.listens(transport, port);
  }

 private:
  OnNetwork network_;
  OnLine line_;
};

constexpr unsigned most_channels = 2;

}  // namespace

line::Device* line_of(plc::EmulatedDevice& device) {
  for (unsigned channel = 0; channel <= most_channels; ++channel)
    if (line::Device* const line = device.line(channel)) return line;
  return nullptr;
}

std::unique_ptr<Party> party_of(plc::EmulatedDevice& device, bool network, bool line) {
  net::Host* const host = network ? device.network() : nullptr;
  line::Device* const own = !line ? nullptr : network ? line_of(device) : device.line();
  if ((network && !host) || (line && !own)) return nullptr;
  if (network && line) return std::make_unique<OnBoth>(*host, *own);
  if (network) return std::make_unique<OnNetwork>(*host);
  return std::make_unique<OnLine>(*own);
}

}  // namespace fieldproof::hosting
