// Frames of the XGT dedicated protocol as values (Cnet EN and KO chapter 7).
//
//   request  ENQ station command type   content EOT [BCC]     RSS RSB WSS WSB
//            ENQ station command number content EOT [BCC]     X Y
//   ACK      ACK station command type|number content ETX [BCC]
//   NAK      NAK station command type|number code ETX [BCC]
//
// Numbers are hex digits, most significant first; BCC follows a lower-case command: the low byte of
// the sum from header to tail. Values hold views into the frame that they were parsed from. Parsing
// never fails and never reads past the frame: `fault` says what is wrong first, in the order of
// DECISIONS.md cnet/order-of-checks.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "src/base/bytes.hpp"
#include "src/base/letters.hpp"

namespace fieldproof::xgt_cnet {

constexpr Byte xgt_enq = 0x05, xgt_ack = 0x06, xgt_nak = 0x15, xgt_eot = 0x04, xgt_etx = 0x03;

constexpr unsigned xgt_max_blocks = 16;
constexpr unsigned xgt_max_name = 16;  // characters
constexpr unsigned xgt_max_run = 120;  // bytes of RSB and WSB: 60 words
constexpr unsigned xgt_registrations = 16;

/// Error codes of the server (Appendix 3.1).
namespace xgt_error {
constexpr std::uint16_t blocks = 0x0003, name_length = 0x0004, type = 0x0007, data = 0x0011,
                        not_registered = 0x0090, execute_number = 0x0190, register_number = 0x0290,
                        area = 0x1132, size = 0x1232, surplus = 0x1234, mixed_types = 0x1332,
                        not_hex = 0x1432, range = 0x7132;
}

/// What a frame is checked for, in this order. A fault before `registration_number` draws silence,
/// not NAK.
enum class XgtCheck : std::uint8_t {
  head,
  tail,
  bcc,
  station,
  command,
  registration_number,
  registered,
  registration_content,
  block_count,
  name_length,
  percent,
  area,
  type,
  equal_types,
  number_form,
  count,
  range,
  data,
  bit_value,
  surplus,
  none,
};

/// The first thing that is wrong.
struct XgtFault {
  XgtCheck check = XgtCheck::none;
  std::uint16_t code = 0;  // server error code; 0 where the server is silent, and in replies

  explicit operator bool() const { return check != XgtCheck::none; }
  /// Takes `other` if it is looked at before this one.
  void note(const XgtFault& other) {
    if (other.check < check) *this = other;
  }
};

enum class XgtService : std::uint8_t {
  unknown,
  read_blocks,
  read_run,
  write_blocks,
  write_run,
  register_monitor,
  run_monitor
};

/// Of R and W with a type SS or SB, each in either case.
XgtService service_of(char command, std::string_view type);

struct XgtBlock {
  std::string_view name{};  // "%MW100"
  std::string_view data{};  // hex digits; writes
};

struct XgtRequest {
  unsigned station = 0;
  char command = 0;         // r R w W x X y Y, as sent
  std::string_view kind{};  // type or registration number, as sent: "SS", "sb", "09"
  XgtService service = XgtService::unknown;
  XgtService content = XgtService::unknown;  // what is read or written; of X: what is registered
  unsigned registration = 0;
  unsigned blocks = 0;  // as parsed
  std::array<XgtBlock, xgt_max_blocks> block{};
  unsigned count = 0;  // elements of RSB and WSB
  XgtFault fault{};    // names are looked at as far as their type letter: areas depend on the model

  bool has_bcc() const { return is_lower(command); }
};

/// Bytes behind the frame are not looked at.
XgtRequest parse_request(ByteView frame);
/// Appends the frame. Takes everything as it stands: block names, `kind`, counts, too long or not.
void encode_request(const XgtRequest& request, Bytes& out);

struct XgtReply {
  bool ack = true;
  unsigned station = 0;
  char command = 0;
  std::string_view kind{};
  std::uint16_t error = 0;        // of a NAK
  bool with_block_count = false;  // RSS, RSB, and Y of an SS registration
  unsigned blocks = 0;
  std::array<std::string_view, xgt_max_blocks> data{};  // hex digits of each block
  XgtFault fault{};

  bool has_bcc() const { return is_lower(command); }
};

/// The reply to Y is printed with and without a block count; it is read as the one whose lengths
/// add up.
XgtReply parse_reply(ByteView frame);
void encode_reply(const XgtReply& reply, Bytes& out);

/// Low byte of the sum.
Byte xgt_bcc(ByteView header_to_tail);

/// The value of 1 to 15 hex digits in either case, or -1.
std::int64_t hex_value(std::string_view digits);
/// The value of the data of one element: 2 to 16 digits, all of them hex.
std::uint64_t data_value(std::string_view digits);

}  // namespace fieldproof::xgt_cnet
