// An emulated XGB port that works with user-defined frames (Cnet EN 6.2.5, Cnet KO 6.5).
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "src/plc/plc.hpp"
#include "src/plc/port_config.hpp"
#include "src/plc/reply_queue.hpp"
#include "src/user_frames/finder.hpp"
#include "src/user_frames/frame.hpp"

namespace fieldproof::user_frames {

class UserFramePort : public plc::LineService, private FrameFinder::Sink {
 public:
  /// `memory` is that of the definition's PLC, and outlives the port.
  UserFramePort(const FrameDefinition& definition, plc::PlcMemory& memory,
                const plc::PortConfig& config);

  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  const plc::ServiceCounters& counters() const override { return counters_; }
  /// What was half received and the counters are lost.
  void power_cycle() override;
  /// P2P rests in STOP: what was half received is lost.
  void set_run(bool run) override;
  /// "send GROUP.FRAME".
  std::vector<std::string> actions() const override { return {"send GROUP.FRAME"}; }
  std::optional<Status> act(std::string_view action) override;

 private:
  void on_user_frame(const UserFrame& frame, const FrameMatch& match, ByteView bytes,
                     Time end) override;
  void on_no_frame(std::uint16_t why) override { counters_.count_error(why); }
  Status send(std::string_view name);
  void forget();

  const FrameDefinition definition_;
  plc::PlcMemory& memory_;
  Duration delay_;
  bool run_ = true;
  FrameFinder finder_;
  Time now_{};
  plc::ReplyQueue queue_;
  plc::ServiceCounters counters_;
};

/// A PLC with that port, in its power-on state. `config`: port_config.hpp; station and role change
/// nothing. Errors name the key.
Result<std::unique_ptr<plc::EmulatedDevice>> make_user_frame_device(
    const FrameDefinition& definition, const nlohmann::json& config);

}  // namespace fieldproof::user_frames
