// For tests: P2P blocks of an XBC-H as parameters give them: own addresses by name, partner's as
// the driver spells them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>

#include "src/p2p/block.hpp"

namespace fieldproof::p2p::test {

/// Of station 1; `size` 0: a single variable.
inline P2pBlock p2p_block(P2pBlock::Function function, std::string partner, std::string_view own,
                          unsigned size = 0) {
  const plc::ParsedAddress parsed = plc::parse_address(*plc::find_plc_model("xbc-h"), own);
  EXPECT_TRUE(parsed) << own;
  return {.function = function,
          .continuous = size != 0,
          .type = own[2],
          .size = size == 0 ? 1 : size,
          .station = 1,
          .variables = {{std::move(partner), parsed.address}}};
}
inline P2pBlock p2p_read(std::string partner, std::string_view own, unsigned size = 0) {
  return p2p_block(P2pBlock::Function::read, std::move(partner), own, size);
}
inline P2pBlock p2p_write(std::string partner, std::string_view own, unsigned size = 0) {
  return p2p_block(P2pBlock::Function::write, std::move(partner), own, size);
}

}  // namespace fieldproof::p2p::test
