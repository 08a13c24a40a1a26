// The frames in a notation: what stands in them, and bytes of them replaced, so that their checks
// follow.
#pragma once

#include <vector>

#include "harness/notation/notation.hpp"
#include "harness/protocol.hpp"

namespace fieldproof::safety {

/// The first of its alternatives; open places are 0.
Result<Bytes> bytes_of(const notation::Notation& notation, const notation::Fields& stations);

/// A bracket of a notation: its items, and the addresses in it.
struct Bracket {
  std::size_t begin = 0, end = 0;  // of the items
  Bytes bytes;
  std::vector<harness::Protocol::AddressField> fields;
};

/// In their order; those whose bytes cannot be made are left out. `reply`: they come from the
/// device.
std::vector<Bracket> brackets_of(const notation::Notation& notation, bool reply,
                                 const notation::Fields& stations,
                                 const harness::Protocol& protocol);

/// Puts `bytes` at `offset` of a bracket; false where that is not all literal bytes or a name.
bool patch(notation::Notation& notation, const Bracket& bracket, std::size_t offset, ByteView bytes,
           const notation::Fields& stations);

}  // namespace fieldproof::safety
