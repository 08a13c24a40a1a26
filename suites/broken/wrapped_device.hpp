// A broken device around the right one: what a fault does not touch, the right one does.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "src/plc/emulated_device.hpp"

namespace fieldproof::broken {

class WrappedDevice : public plc::SerialDevice {
 public:
  explicit WrappedDevice(std::unique_ptr<plc::EmulatedDevice> right) : right_(std::move(right)) {}

  void receive(const Burst& burst) override { right_->line()->receive(burst); }
  std::optional<Time> wake_at() const override { return right_->line()->wake_at(); }
  Bytes advance(Time now) override { return right_->line()->advance(now); }

  Status set(std::string_view address, std::string_view hex) override {
    return right_->set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return right_->get(address, digits);
  }
  Status act(std::string_view action) override { return right_->act(action); }
  Trace trace() const override { return right_->trace(); }

 protected:
  plc::EmulatedDevice& right() const { return *right_; }
  /// One after the other, up to the first that fails.
  Status act_all(const std::vector<std::string>& actions) {
    Status done = ok();
    for (const std::string& one : actions)
      if (done) done = right_->act(one);
    return done;
  }

 private:
  std::unique_ptr<plc::EmulatedDevice> right_;
};

}  // namespace fieldproof::broken
