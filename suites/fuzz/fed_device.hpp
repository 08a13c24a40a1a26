// One emulated device on given time that is fed bytes, and what it sends.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "harness/protocol.hpp"

namespace fieldproof::fuzz {

/// By then every time-out of a device is over.
inline constexpr Duration quiet = 60s;

class FedDevice {
 public:
  FedDevice(const harness::Protocol& protocol, std::unique_ptr<plc::EmulatedDevice> device)
      : protocol_(protocol), device_(std::move(device)) {}

  /// A connection to it; before, it is reached on its line or on those that it makes.
  void connect();
  void disconnect();
  void feed(ByteView bytes);
  void pause(Duration time) { run(now_ + time); }

  /// Pieces: a byte for the length of each, one for the pause behind it, then so many bytes and one
  /// more.
  void feed_pieces(ByteView pieces);

  /// Has it sent anything since this was asked?
  bool has_sent() { return std::exchange(sent_, false); }
  plc::EmulatedDevice& device() { return *device_; }

 private:
  void tell(LinkEvent event);
  net::Host* network() { return protocol_.on_network() ? device_->network() : nullptr; }
  std::optional<Time> wake();
  void note(const Burst& burst);
  void run(Time until);

  const harness::Protocol& protocol_;
  std::unique_ptr<plc::EmulatedDevice> device_;
  Time now_{};
  LinkId link_ = 0, connections_ = 0;
  LinkEvent carries_ = LinkEvent::data;  // or datagrams
  bool sent_ = false;
};

}  // namespace fieldproof::fuzz
