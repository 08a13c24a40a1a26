// A PLC with one known fault, so that the suite can be shown to find it.
#pragma once

#include <memory>
#include <string_view>

#include "src/plc/emulated_device.hpp"
#include "src/xgt_cnet/receiver.hpp"
#include "suites/xgt_cnet/broken/faults.hpp"

namespace fieldproof::xgt_cnet_broken {

class BrokenPlc : public plc::SerialDevice, private plc::FrameSink {
 public:
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  Status set(std::string_view address, std::string_view hex) override {
    return plc_.memory().set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  Status act(std::string_view action) override;

 private:
  friend Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_plc(std::string_view,
                                                                      const plc::PortConfig&,
                                                                      Storage&);
  BrokenPlc(Behaviour behaviour, GoodPlc plc, Duration gap);

  void on_frame(ByteView frame, Time end) override;
  void on_broken_frame(std::uint16_t why) override;
  void remember(ByteView bytes);

  Behaviour behaviour_;
  GoodPlc plc_;
  xgt_cnet::FrameReceiver receiver_;
  Bytes since_head_;  // of the frame that is arriving
  Time now_{};
  bool in_silence_ = false;
  unsigned frames_in_burst_ = 0;
  broken::SendQueue pending_;
};

/// A server with the fault of that name, or without ("none"). `storage` outlives it. Errors name
/// the fault or the parameter.
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_plc(std::string_view fault,
                                                             const plc::PortConfig& config,
                                                             Storage& storage);

}  // namespace fieldproof::xgt_cnet_broken
