// How a message travels: RTU (Cnet EN 9.3.2), ASCII (Cnet EN 9.3.1) and TCP (FEnet EN 5.3.3).
#pragma once

#include <optional>
#include <vector>

#include "harness/protocol.hpp"
#include "suites/modbus/message.hpp"

namespace fieldproof::modbus_suite {

class Framing {
 public:
  virtual ~Framing() = default;

  virtual std::string_view protocol_name() const = 0;
  virtual Bytes station_bytes(int station) const = 0;
  /// How many characters stand before the message in its frame, and for one byte of it.
  struct Spelling {
    std::size_t before = 0, each = 1;
  };
  virtual Spelling spelling() const { return {}; }

  /// A message with start, check and end around it.
  virtual Bytes wrap(ByteView message) const = 0;
  /// The message of a frame; its check is not judged. Empty where it holds none.
  virtual Bytes unwrap(ByteView frame) const = 0;

  /// Length of the first complete frame, request or reply. Bytes that begin no frame count as a
  /// piece of their own.
  virtual std::optional<std::size_t> frame_length(ByteView bytes) const = 0;
  virtual std::vector<harness::Field> explain(ByteView frame, Way way) const = 0;
  virtual const notation::Dressing& dressing() const = 0;
  /// Does a frame carry a check?
  virtual bool has_check() const { return true; }
  /// Can this be the reply to that request by what the framing alone says of them?
  virtual bool pairs([[maybe_unused]] ByteView request, [[maybe_unused]] ByteView reply) const {
    return true;
  }
  virtual Duration frame_gap(Duration character_time) const = 0;

  /// Every message that a device could read in these bytes, whole or damaged: several frames, a
  /// frame after noise.
  virtual std::vector<Bytes> messages(ByteView bytes) const = 0;
};

const Framing& rtu_framing();
const Framing& ascii_framing();
const Framing& tcp_framing();

}  // namespace fieldproof::modbus_suite
