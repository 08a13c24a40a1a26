// User-defined frames as data (Cnet EN 6.2.5, Cnet KO 6.5): segments of a frame, frames of a
// definition. Made by parse_frame_definition (definition.hpp) alone, which keeps the limits.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/bytes.hpp"
#include "src/plc/address.hpp"
#include "src/plc/model.hpp"
#include "src/user_frames/checks.hpp"

namespace fieldproof::user_frames {

constexpr std::size_t max_frame = 1024;   // bytes (Cnet KO 6.5.1)
constexpr std::size_t max_constant = 10;  // bytes
constexpr std::size_t max_variables = 4;  // of a frame

enum class Area { head, body, tail };
std::string_view to_string(Area area);

enum class Convert { none, hex_to_ascii, ascii_to_hex };

struct Segment {
  enum class Kind {
    constant,  // `bytes`
    data,      // `size` bytes of the frame, from or to memory
    rest,  // as many bytes as come before the tail; the last of the body. Sent: as many as the P2P
           // block says
    check  // `size` bytes: `method` over segments `first` to `last`
  };

  Kind kind = Kind::constant;
  Area area = Area::body;
  std::size_t index = 0;  // within its area
  std::string name;       // "body 2", or what the definition calls it
  std::size_t size = 0;   // bytes in the frame; 0: rest

  Bytes bytes;  // constant

  std::optional<plc::DeviceAddress> memory;  // data, rest; none: any bytes, which are forgotten
  std::string address;                       // the same as written: "%MW200"
  bool in_block = false;                     // a P2P block gives the memory
  Convert convert = Convert::none;
  std::size_t swap = 1;  // bytes that are turned round: 2, 4, 8; 1: none

  CheckMethod method = CheckMethod::byte_sum;
  CheckOptions options;
  std::size_t first = 0, last = 0;  // positions in UserFrame::segments, both covered

  bool operator==(const Segment&) const = default;
};

struct UserFrame {
  std::string name;               // "DRS_RECE.RECE_DRS"
  bool sent = false;              // by the device; else received
  std::vector<Segment> segments;  // head, body, tail
  std::string answer;             // of a received frame: name of the sent frame; may be empty

  bool operator==(const UserFrame&) const = default;
};

struct FrameDefinition {
  std::string title;
  const plc::PlcModel* plc = nullptr;
  std::vector<UserFrame> frames;   // in the order of the file
  std::string probe, probe_reply;  // names of frames; empty: there is no probe

  /// nullptr when unknown.
  const UserFrame* find(std::string_view name) const;
};

/// The frames that the device receives, in the order of the file; they are those of `definition`.
std::vector<const UserFrame*> received_frames(const FrameDefinition& definition);

/// Bytes that a variable of `in_frame` bytes takes in memory.
std::size_t bytes_in_memory(const UserFrame& frame, const Segment& variable, std::size_t in_frame);

}  // namespace fieldproof::user_frames
