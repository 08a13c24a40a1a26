#include "harness/hosting/party.hpp"

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

}  // namespace

std::unique_ptr<Party> party_of(plc::EmulatedDevice& device, bool network) {
  if (network) {
    net::Host* const host = device.network();
    return host ? std::make_unique<OnNetwork>(*host) : nullptr;
  }
  line::Device* const line = device.line();
  return line ? std::make_unique<OnLine>(*line) : nullptr;
}

}  // namespace fieldproof::hosting
