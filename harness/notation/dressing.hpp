// How a protocol frames a body that it shares with others, or that is written without its header.
#pragma once

#include <cstddef>
#include <string_view>

namespace fieldproof::notation {

/// How a protocol frames a body. Supplied by the protocol; lives as long as the program.
struct Dressing {
  /// One frame in notation, with ${body} and where it has them ${station}, ${transaction}, and
  /// ${wrong} behind the check that may be wrong: "[${station} ${body} CRC${wrong}]".
  std::string_view frame;
  /// Each byte of station and body travels as two hex digits.
  bool digits = false;
  /// The same of other speakers; empty: as `frame`, which then is what the bench sends as client.
  std::string_view reply_of_device{};    // the bench expects it as client
  std::string_view request_of_device{};  // the bench expects it as server
  std::string_view reply_of_bench{};     // the bench sends it as server
  /// The transaction stands low byte first.
  bool low_byte_first = false;
  /// So many bytes in front of what is the device's own in the body of each reply (two bytes that
  /// are reserved); 0: there is nothing.
  std::size_t before_own_word = 0;

  /// That of one speaker, as `frame`. `bench_is_client`: the device is the server.
  Dressing of(bool bench_is_client, bool bench_sends) const {
    Dressing one = *this;
    const std::string_view form = bench_is_client
                                      ? (bench_sends ? frame : reply_of_device)
                                      : (bench_sends ? reply_of_bench : request_of_device);
    if (!form.empty()) one.frame = form;
    return one;
  }
};

}  // namespace fieldproof::notation
