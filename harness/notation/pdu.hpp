// pdu(03 00 63 00 01): a body that several protocols share, written once, framed by each.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "harness/notation/dressing.hpp"
#include "src/base/result.hpp"

namespace fieldproof::notation {

/// `text` with each pdu(...) of it written out as a frame in ordinary notation.
///
/// pdu(BODY)       from or to the station under test
/// pdu@02(BODY)    another station: st+1, or a hex byte
/// pdu!(BODY)      with a check that is deliberately wrong; pdu@02!(BODY)
///
/// BODY has bytes (hex, quoted, seq(n)), names where numbers travel as bytes, repetitions
/// (5634*60), and in `expect` what is open: ?? a byte, x:4 two bytes, {id:2} two bytes, {id} again,
/// alternatives. `transaction` is asked once for
/// each pdu(...) whose frame has one, in order; it answers in notation, or why there is none.
Result<std::string> dress(std::string_view text, const Dressing& dressing,
                          const std::function<Result<std::string>()>& transaction);

/// Has it a pdu(...)?
bool has_pdu(std::string_view text);

}  // namespace fieldproof::notation
