// Devices for tests of the endpoints: one answers "abc." with "<abc>", its memory is what was set;
// one on a network echoes.
#pragma once

#include <cstdlib>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "harness/hosting/device_host.hpp"
#include "src/net/test_echo_host.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::hosting::test {

/// Keys of the configuration: model (tiny, xbc-h), station, delay_ms (of the reply),
/// inter_character_floor_ms: a longer gap drops an unfinished frame. Addresses: any; @config is the
/// configuration, @dropped counts dropped frames.
class TinyDevice final : public plc::SerialDevice {
 public:
  explicit TinyDevice(const nlohmann::json& config)
      : config_(config),
        delay_(std::chrono::milliseconds(config.value("delay_ms", 0))),
        gap_(std::chrono::milliseconds(config.value("inter_character_floor_ms", 0))) {}

  void receive(const Burst& burst) override {
    for (const Byte byte : burst.bytes) {
      if (byte != '.') {
        frame_ += static_cast<char>(byte);
        continue;
      }
      reply_ += '<' + frame_ + '>';
      frame_.clear();
      reply_at_ = burst.end() + delay_;
    }
    heard_at_ = burst.end();
  }

  std::optional<Time> wake_at() const override {
    if (!reply_.empty()) return reply_at_;
    if (!frame_.empty()) return heard_at_ + gap_ + 1ns;
    return std::nullopt;
  }

  Bytes advance(Time now) override {
    if (!frame_.empty() && now > heard_at_ + gap_) {
      frame_.clear();
      ++dropped_;
    }
    if (reply_.empty() || now < reply_at_) return {};
    return to_bytes(std::exchange(reply_, {}));
  }

  Status set(std::string_view address, std::string_view hex) override {
    if (address.empty()) return fail("cannot set '': no address");
    memory_[std::string(address)] = hex;
    return ok();
  }

  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    if (address == "@config") return config_.dump();
    if (address == "@dropped") return std::to_string(dropped_);
    const auto found = memory_.find(std::string(address));
    if (found == memory_.end())
      return fail("cannot get " + std::string(address) + ": nothing was set");
    return digits ? found->second.substr(0, digits) : found->second;
  }

  Status act(std::string_view action) override {
    if (action == "die") std::_Exit(9);
    if (action != "power_cycle") return fail("cannot do '" + std::string(action) + "'");
    memory_.clear();
    return ok();
  }

 private:
  nlohmann::json config_;
  Duration delay_;
  Duration gap_;
  std::map<std::string, std::string> memory_;
  std::string frame_, reply_;
  Time heard_at_{}, reply_at_{};
  int dropped_ = 0;
};

/// A device on a network, and on no line: echoes on port 7, see EchoHost. It has no back door.
class EchoDevice final : public plc::EmulatedDevice {
 public:
  net::Host* network() override { return &host_; }
  Status set(std::string_view, std::string_view) override { return fail("no memory"); }
  Result<std::string> get(std::string_view, std::size_t) const override {
    return fail("no memory");
  }
  Status act(std::string_view) override { return fail("no switch"); }

 private:
  net::test::EchoHost host_;
};

inline Result<std::unique_ptr<plc::EmulatedDevice>> make_echo_device(const nlohmann::json&) {
  return std::unique_ptr<plc::EmulatedDevice>(std::make_unique<EchoDevice>());
}

inline Result<std::unique_ptr<plc::EmulatedDevice>> make_tiny_device(const nlohmann::json& config) {
  const std::string model = config.value("model", "xbc-h");
  if (model != "tiny" && model != "xbc-h")
    return fail("cannot make a device '" + model + "': the models are tiny and xbc-h");
  return std::unique_ptr<plc::EmulatedDevice>(std::make_unique<TinyDevice>(config));
}

}  // namespace fieldproof::hosting::test
