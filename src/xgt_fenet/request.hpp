// The bodies of XGT FEnet frames (FEnet EN 5.2.4, 5.2.5; DECISIONS.md fenet/bodies), numbers low
// byte first:
//
//   read         54 00 type 00 00 n (name)*
//   continuous   54 00 14 00 00 00 01 00 name bytes
//   write        58 00 type 00 00 n (name)* (size data)*
//   continuous   58 00 14 00 00 00 01 00 name size data
//   reply        55 00 type reserved 00 00 n (size data)*; 59 00 type reserved 00 00 n
//   refusal      55 00 type reserved FF FF code
//
// type: 00 X, 01 B, 02 W, 03 D, 04 L, 14 continuous. name: u16 length, then "%MW100".
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::xgt_fenet {

constexpr std::uint16_t read_command = 0x54, write_command = 0x58, continuous_type = 0x14;
constexpr unsigned most_blocks = 16, most_bytes = 512;  // table 5-4, 5.1.2
constexpr std::size_t shortest_name = 4, longest_name = 16;

/// DECISIONS.md fenet/error-codes: the manual prints none.
namespace error {
constexpr std::uint16_t none = 0, blocks = 0x01, letter = 0x02, area = 0x03, range = 0x04,
                        size = 0x05, device = 0x10, name = 0x11, continuous_letter = 0x12,
                        data_type = 0x24, company = 0x75, length = 0x76, check = 0x77,
                        command = 0x78;
}  // namespace error

/// Of a request whose form is right.
struct Request {
  struct Block {
    std::string_view name{};
    std::uint16_t size = 0;  // bytes that are written, or read by a continuous request
    ByteView data{};         // what is written
  };

  std::uint16_t command = 0, type = 0;
  std::vector<Block> blocks{};
  std::uint16_t fault = error::none;  // the first thing that is wrong with it

  bool writes() const { return command == write_command; }
  bool is_continuous() const { return type == continuous_type; }
  /// The letter that names of its type have.
  char letter() const { return is_continuous() ? 'B' : "XBWDL"[type]; }
};

/// Views into `body`. `fault` is what the form alone tells: command, data type, number of blocks,
/// lengths (DECISIONS.md fenet/order-of-checks). Command and type that are not there count as 0
/// (fenet/missing-fields).
Request parse_request(ByteView body);

/// The body of a reply: `data` of a read, one a block.
Bytes encode_reply(const Request& request, std::span<const Bytes> data);
Bytes encode_refusal(const Request& request, std::uint16_t code);

}  // namespace fieldproof::xgt_fenet
