// An emulated XGB port that works with user-defined frames (Cnet EN 6.2.5, Cnet KO 6.5).
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "src/plc/counters.hpp"
#include "src/plc/emulated_device.hpp"
#include "src/plc/memory.hpp"
#include "src/plc/port_config.hpp"
#include "src/plc/reply_queue.hpp"
#include "src/user_frames/finder.hpp"
#include "src/user_frames/frame.hpp"

namespace fieldproof::user_frames {

class UserFramePort : public plc::EmulatedDevice, private FrameFinder::Sink {
 public:
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  /// Memory of the definition's PLC.
  Status set(std::string_view address, std::string_view hex) override;
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  /// Also "send GROUP.FRAME". power_cycle: what was half received and the counters are lost; memory
  /// and mode stay.
  Status act(std::string_view action) override;

 private:
  friend Result<std::unique_ptr<plc::EmulatedDevice>> make_user_frame_device(const FrameDefinition&,
                                                                             const nlohmann::json&);
  UserFramePort(const FrameDefinition& definition, const plc::PortConfig& config);

  void on_user_frame(const UserFrame& frame, const FrameMatch& match, ByteView bytes,
                     Time end) override;
  void on_no_frame(std::uint16_t why) override { counters_.count_error(why); }
  Status send(std::string_view name);

  const FrameDefinition definition_;
  plc::PlcMemory memory_;
  Duration delay_;
  bool run_;
  FrameFinder finder_;
  Time now_{};
  plc::ReplyQueue queue_;
  plc::ServiceCounters counters_;
};

/// In its power-on state. `config`: port_config.hpp; station and role change nothing. Errors name
/// the key.
Result<std::unique_ptr<plc::EmulatedDevice>> make_user_frame_device(
    const FrameDefinition& definition, const nlohmann::json& config);

}  // namespace fieldproof::user_frames
