// A right device with a fault at its edge: in what comes to it and what goes out, on lines and on
// the network, and in what its back door shows.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/plc/emulated_device.hpp"

namespace fieldproof::broken {

/// One fault at work. What is empty is done right.
struct Edge {
  /// On the line of a channel, 0 the main one; false: not heard.
  std::function<bool(Burst& burst, unsigned channel)> hears{};
  std::function<void(Bytes& bytes, unsigned channel)> says{};
  std::function<bool(Burst& burst)> hears_link{};
  std::function<void(std::vector<Burst>& doings)> does{};  // on links
  /// What is shown at an address of the back door.
  std::function<std::string(std::string_view address, std::string right)> shows{};
  /// What is set there instead.
  std::function<std::string(std::string_view address, std::string hex)> sets{};
  std::string deaf_to{};  // an action that changes nothing
};

class EdgeDevice : public plc::EmulatedDevice, public net::Host {
 public:
  EdgeDevice(std::unique_ptr<plc::EmulatedDevice> right, Edge edge);
  ~EdgeDevice() override;

  line::Device* line(unsigned channel = 0) override;
  net::Host* network() override { return right_->network() ? this : nullptr; }
  plc::BusEnd* bus_end() override { return right_->bus_end(); }

  bool listens(Transport transport, std::uint16_t port) const override {
    return right_->network()->listens(transport, port);
  }
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override { return right_->network()->wake_at(); }
  std::vector<Burst> advance(Time now) override;

  Status set(std::string_view address, std::string_view hex) override {
    return edge_.sets ? right_->set(address, edge_.sets(address, std::string(hex)))
                      : right_->set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  Status act(std::string_view action) override {
    return action == edge_.deaf_to ? ok() : right_->act(action);
  }
  Trace trace() const override { return right_->trace(); }

 private:
  class Line;

  std::unique_ptr<plc::EmulatedDevice> right_;
  Edge edge_;
  std::map<line::Device*, std::unique_ptr<Line>> lines_;
};

}  // namespace fieldproof::broken
