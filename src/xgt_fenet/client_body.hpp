// The bodies of XGT FEnet frames as a client sees them (request.hpp, FEnet EN 5.2.5): it writes
// requests and reads replies.
#pragma once

#include <optional>
#include <vector>

#include "src/xgt_fenet/request.hpp"

namespace fieldproof::xgt_fenet {

/// Command, type and blocks of `request`: names; of a continuous one the size; of a write the data.
Bytes encode_request(const Request& request);

struct Reply {
  std::uint16_t command = 0;
  std::optional<std::uint16_t> refused{};  // the code of a refusal
  std::uint16_t blocks = 0;
  std::vector<ByteView> data{};  // of a read, one a block
};

/// Views into `body`. Nothing: it is not as long as its own fields say, no more, no less. What is
/// no reply to a write is read as one to a read.
std::optional<Reply> parse_reply(ByteView body);

}  // namespace fieldproof::xgt_fenet
