// Frames of the LS Bus between an XGB and an inverter, as values (Cnet EN and KO chapter 8;
// DECISIONS.md 'LS Bus').
//
//   read   ENQ station R address count SUM EOT
//   write  ENQ station W address count data SUM EOT     address first, as inverter manuals have it
//          ENQ station W count address data SUM EOT     count first, as Cnet EN and KO 8.2.1 print
//          it
//   ACK    ACK station command data SUM EOT             of a write: the data that were written
//   NAK    NAK station command code SUM EOT
//
// Station: two hex digits. Address: four. Count: one, 1 to 8 words. Data: four a word, most
// significant first. SUM: the low byte of the sum of what stands between header and sum, two
// upper-case hex digits. Hex digits are read in either case and written in upper case.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::ls_bus {

constexpr Byte ls_enq = 0x05, ls_ack = 0x06, ls_nak = 0x15, ls_eot = 0x04;

constexpr std::size_t digits_of_a_word = 4;
constexpr unsigned ls_max_words = 8;
/// Cnet KO 8.1.1: the write of eight words.
constexpr std::size_t ls_max_frame = 1 + 2 + 1 + 4 + 1 + 4 * ls_max_words + 2 + 1;
static_assert(ls_max_frame == 44);

/// Where the count of a write stands.
enum class LsWriteOrder : std::uint8_t { address_first, count_first };

/// What is wrong with a request, in the order in which it is looked at: the first gives the code.
/// Each field has its own:
///   frame     FE  the sum is wrong
///   function  IF  a command other than R and W
///   address   IA  the address is cut short or not hex
///   data      ID  the count is not 1 to 8; data are missing, not hex, or more than the count
///                 says (so is every frame beyond 44 bytes)
///   range     IA  a word that the inverter does not have
///   rights    WM  a write to a word that is read only
/// A write is all or nothing. Silence, without a look at the sum: another station (or none), a
/// frame too short for station, command and sum, and bytes that no ENQ and EOT enclose.
enum class LsFault : std::uint8_t { none, frame, function, address, data, range, rights };

/// "FE"; empty for `none`.
std::string_view ls_error_code(LsFault fault);

struct LsRequest {
  std::optional<unsigned>
      station;       // nothing: no two hex digits, or the frame is too short to be answered
  char command = 0;  // as sent
  unsigned address = 0;
  unsigned count = 0;
  std::array<std::uint16_t, ls_max_words> data{};  // of a write
  LsFault fault = LsFault::none;  // `range` and `rights` are for the inverter to find
};

/// Never fails and never reads past the frame, which reaches from ENQ to EOT.
LsRequest parse_ls_request(ByteView frame, LsWriteOrder order);
/// Takes everything as it stands. Without a station: 00.
Bytes encode_ls_request(const LsRequest& request, LsWriteOrder order);

Bytes encode_ls_ack(unsigned station, char command, std::span<const std::uint16_t> data);
Bytes encode_ls_nak(unsigned station, char command, std::string_view code);

/// What an inverter answered.
struct LsReply {
  bool whole = false;  // station, command and sum are there
  bool sum_right = false;
  bool ack = false;                 // else NAK
  std::optional<unsigned> station;  // nothing: no two hex digits
  char command = 0;
  ByteView content{};  // words of an ACK, code of a NAK; points into the frame
};

/// Never fails and never reads past the frame, which reaches from ACK or NAK to EOT.
LsReply parse_ls_reply(ByteView frame);
/// The words of an ACK; nothing where they are not hex.
std::optional<std::vector<std::uint16_t>> ls_words(ByteView content);

/// "1230" or "h1230": four hex digits.
std::optional<unsigned> parse_ls_address(std::string_view text);

/// The low byte of the sum.
Byte ls_sum(ByteView between_header_and_sum);

/// Finds frames in what arrives: ENQ begins one (ACK or NAK on the client's side), wherever it
/// comes, EOT ends it. The manuals have no time-out between characters, so there is none here.
class LsReceiver {
 public:
  enum class Side : std::uint8_t { inverter, client };
  explicit LsReceiver(Side side = Side::inverter) : side_(side) {}

  /// From ENQ on (Cnet EN 8.1.1: 256 bytes); more without EOT is dropped.
  static constexpr std::size_t buffer_size = 256;

  /// True when `b` completes a frame.
  bool take(Byte b);
  /// The frame that was completed last, ENQ to EOT.
  ByteView frame() const { return frame_; }
  /// Is a frame in progress?
  bool inside() const { return inside_; }
  /// As after power on.
  void reset() { inside_ = false; }

 private:
  bool begins(Byte b) const {
    return side_ == Side::inverter ? b == ls_enq : b == ls_ack || b == ls_nak;
  }

  Side side_;
  bool inside_ = false;
  Bytes frame_;
};

}  // namespace fieldproof::ls_bus
