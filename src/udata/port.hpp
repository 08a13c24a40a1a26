// An emulated XGB port that works with UDATA instructions (Cnet KO 6.6): its module buffers what
// arrives, and the program of the PLC takes it, sends, and moves DTR and RTS.
#pragma once

#include <deque>
#include <memory>

#include "src/line/silence.hpp"
#include "src/plc/plc.hpp"
#include "src/plc/reply_queue.hpp"
#include "src/udata/config.hpp"
#include "src/udata/program.hpp"

namespace fieldproof::udata {

class UdataPort : public plc::LineService, private UdataChannel {
 public:
  /// `memory` outlives the port.
  UdataPort(const UdataConfig& config, plc::PlcMemory& memory);

  /// A datum ends when the line is silent for the inter-character time (Cnet KO 4.3.1), or is 1024
  /// bytes long.
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  /// Each datum sent or received is a service, one that is lost because nothing takes them an
  /// error.
  const plc::ServiceCounters& counters() const override { return counters_; }
  /// Also "@dtr" and "@rts": 01 while the control line is set.
  Result<std::string> get(std::string_view name, std::size_t digits) const override;
  /// What was received, the counters and the control lines are lost.
  void power_cycle() override;
  void set_run(bool run) override;
  /// The program of the PLC runs.
  void scan() override;

 private:
  void send(Bytes data) override;
  std::optional<Bytes> take_received() override;
  void set_dtr(bool on) override { dtr_ = on; }
  void set_rts(bool on) override { rts_ = on; }

  bool hears() const { return run_ && module_.cnet && module_.user_frames && module_.link; }
  void end_datum();
  void forget();

  plc::PlcMemory& memory_;
  UdataModule module_;
  UdataProgram program_;
  line::Silence silence_;
  bool run_ = true;
  bool dtr_ = false, rts_ = false;
  Bytes heard_;                 // of the datum that arrives
  std::deque<Bytes> received_;  // oldest first
  Time now_{};
  plc::ReplyQueue queue_;
  plc::ServiceCounters counters_;
};

/// A PLC with that port, in its power-on state.
std::unique_ptr<plc::Plc> make_udata_plc(const UdataConfig& config);
/// The same of a configuration in JSON. Errors: parse_udata_config.
Result<std::unique_ptr<plc::EmulatedDevice>> make_udata_port(std::string_view model,
                                                             const nlohmann::json& config);

}  // namespace fieldproof::udata
