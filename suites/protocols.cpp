// The table of protocols: one line each.
#include <array>

#include "harness/protocol.hpp"
#include "suites/xgt_cnet/protocol.hpp"

namespace fieldproof {

std::span<const Protocol* const> protocols() {
  static const std::array table{&xgt_cnet::protocol()};
  return table;
}

const Protocol* find_protocol(std::string_view name) {
  for (const Protocol* protocol : protocols())
    if (protocol->name() == name) return protocol;
  return nullptr;
}

}  // namespace fieldproof
