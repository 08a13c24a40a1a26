// The P2P service of one channel (Cnet EN and KO 6.2-6.4, Appendix 2.1, 3.3): when which block is
// asked, and what comes of it. How a request looks is the driver's affair.
//
// A block fires at the rising edge of its flag, or of its clock: clocks count from power-on, the
// first edge comes after one whole period. One transaction at a time: the blocks that have fired
// when the channel is free make a round, in block order; what fires meanwhile waits for the next
// round. An edge of a block that is wanted or under way is lost, and so is one in STOP or with the
// link disabled. A flag that is already on when the PLC goes to RUN has not risen.
//
// A block ends normally (NDR), or with an error code (ERR, STATUS); each clears the other. The
// time-out runs from the last byte sent; there is no retry. What has no header does not end the
// wait, but makes the error of the time-out 01.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "src/line/device.hpp"
#include "src/p2p/driver.hpp"
#include "src/p2p/registers.hpp"
#include "src/plc/service.hpp"

namespace fieldproof::p2p {

class P2pClient : public plc::LineService, private plc::FrameSink {
 public:
  struct Timing {
    Duration time_out{};  // after the last byte sent
    Duration delay{};  // silence on the line before a request (Cnet EN 11.2.3: RS-485 delay time)
    Duration character_time{};  // of its own line
  };

  /// The blocks of `parameters` that are of `channel`, checked with `driver` (parameters.hpp).
  /// `memory` outlives the client; `saved` is called when it has changed memory. It is off until
  /// `set_run` or `set_active`.
  P2pClient(plc::PlcMemory& memory, const P2pParameters& parameters, unsigned channel,
            std::unique_ptr<P2pDriver> driver, const Timing& timing, std::function<void()> saved);

  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  /// Looks at the flags.
  void scan() override;
  /// RUN and link enabled. Otherwise it is silent, and what is under way is given up without a
  /// result.
  void set_active(bool active);
  void set_run(bool run) override;
  /// "link on", "link off" (Cnet EN 6.2.6); the parameter says how it begins.
  std::vector<std::string> actions() const override { return {"link on", "link off"}; }
  std::optional<Status> act(std::string_view action) override;
  /// Counters, and what is under way, are lost; clocks begin anew.
  void power_cycle() override;
  /// Of all blocks. The status is that of the P2P service, Cnet EN 11.1.4: 4 station, 5 time-out,
  /// FFFE no such request; where it has no code, that of Appendix 3.3.
  const plc::ServiceCounters& counters() const override { return counters_; }

  // Where it is behind a connection (network_client.hpp):
  /// `end` is called when the connection is of no use any more: a reply has not come in time, or
  /// what came cannot be followed. What was half received is kept from one request to the next.
  void behind_connection(std::function<void()> end) { end_connection_ = std::move(end); }
  void connection_opened() { driver_->reset(); }
  /// No reply to what is under way can come any more: it ends with STATUS 07.
  void connection_lost();

 private:
  using BlockSet = std::uint32_t;  // bit i: block i of blocks_
  struct Clock {
    Duration period{};
    BlockSet blocks = 0;
    Time next{};
  };

  void on_frame(ByteView frame, Time end) override;
  void on_broken_frame(std::uint16_t why) override;

  void start_clocks();
  void tick();
  void fire(BlockSet blocks);
  std::optional<std::size_t> take_next();
  Bytes request(std::size_t block);
  void finish(std::size_t block, std::uint16_t error);
  Time free_at() const { return heard_until_ + timing_.delay; }

  plc::PlcMemory& memory_;
  std::vector<P2pBlock> blocks_;
  std::vector<P2pResultFlags> results_;
  std::unique_ptr<P2pDriver> driver_;
  Timing timing_;
  std::function<void()> saved_, end_connection_;
  std::vector<Clock> clocks_;
  bool clocks_run_ = false;
  bool run_ = false, link_;
  bool active_ = false;
  BlockSet receivers_ = 0;
  BlockSet flags_on_ = 0;
  BlockSet wanted_ = 0, round_ = 0;
  std::optional<std::size_t> busy_;  // the block under way
  bool awaits_reply_ = false;        // of it; else it is done when it is sent
  Time deadline_{};
  bool noise_ = false;  // bytes without a header came while waiting
  Time heard_until_{};  // or sent
  Time now_{};
  plc::ServiceCounters counters_;
};

}  // namespace fieldproof::p2p
