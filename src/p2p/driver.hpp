// A P2P driver (Cnet EN table 6.2.1): how the client of one channel asks, and reads what is
// answered. It keeps no schedule, counts nothing and sets no flag: P2pClient does. A protocol makes
// its emulated client of it with make_p2p_plc (p2p_plc.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "src/base/bytes.hpp"
#include "src/base/result.hpp"
#include "src/base/time.hpp"
#include "src/line/device.hpp"
#include "src/p2p/block.hpp"
#include "src/plc/frame_sink.hpp"
#include "src/plc/memory.hpp"

namespace fieldproof::p2p {

class P2pDriver {
 public:
  virtual ~P2pDriver() = default;

  /// As it stands in a P2P parameter: "xgt-client", "modbus-rtu-client", "modbus-ascii-client",
  /// "ls-bus-client", "user-frames".
  virtual std::string_view name() const = 0;

  /// What XG5000 refuses of this driver's blocks beyond the common rules: sizes, addresses of the
  /// partner, functions.
  virtual Status check(const P2pBlock& block, const plc::PlcModel& model) const = 0;

  /// The request of a block, with the values of a write taken from memory; the driver remembers it
  /// to tell its reply. An error: it cannot be sent (STATUS 07).
  virtual Result<Bytes> request(const P2pBlock& block, const plc::PlcMemory& memory) = 0;

  /// Does the request of such a block wait for a reply? A user frame that was sent is done.
  virtual bool awaits_reply(const P2pBlock& block) const = 0;

  /// Judges a complete frame against the request of `block` and saves what was read, all or
  /// nothing: the error code, 0 for a normal end. Nothing: the frame is none of this block's (a
  /// RECEIVE block of another frame).
  virtual std::optional<std::uint16_t> take(const P2pBlock& block, ByteView frame,
                                            plc::PlcMemory& memory) const = 0;

  /// Finds frames in what arrives: complete ones and broken ones (`why` is a service_status) go to
  /// the sink.
  virtual void receive(const Burst& burst, plc::FrameSink& sink) = 0;
  virtual std::optional<Time> wake_at() const = 0;
  virtual void advance(Time now, plc::FrameSink& sink) = 0;
  /// Forgets what was half received.
  virtual void reset() = 0;
};

}  // namespace fieldproof::p2p
