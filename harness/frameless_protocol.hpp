// A protocol of which no manual prints a frame: it is tested on a model. Cases set, do, wait and
// look; nothing is sent, so nobody asks for a frame.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::harness {

class FramelessProtocol : public Protocol {
 public:
  bool has_frames() const override { return false; }
  Bytes station_bytes(int station) const override { return {static_cast<Byte>(station)}; }
  bool is_text() const override { return false; }
  bool has_frame_ends() const override { return false; }
  std::optional<std::size_t> frame_length(ByteView) const override { return std::nullopt; }
  std::vector<Field> explain(ByteView) const override { return {}; }
  std::vector<Written> written_by(ByteView) const override { return {}; }
};

}  // namespace fieldproof::harness
