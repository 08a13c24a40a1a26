// XGT Cnet frames taken apart for people: `frame`, the field-by-field difference, the end of a
// frame. Shares no code with the emulator (src/xgt_cnet): what is shown to be wrong must not depend
// on what answers.
#pragma once

#include <optional>
#include <vector>

#include "harness/protocol.hpp"
#include "suites/checks/control_bytes.hpp"

namespace fieldproof::xgt_cnet_suite {

using checks::ack, checks::enq, checks::eot, checks::etx, checks::nak;

/// Length of the first complete frame: header to tail, and two characters of BCC where the main
/// command is lower case (Cnet EN 7.1.2). Bytes before a header count as a piece of their own.
std::optional<std::size_t> frame_length(ByteView bytes);

/// The parts of a request, ACK or NAK (Cnet EN 7.1.5), as far as it can be read.
std::vector<harness::Field> explain(ByteView frame);

/// A request in upper case but for its main command, with the BCC of these bytes (Cnet EN 7.1.3:
/// 'capitals or small letters for main commands, but not for the others'). As it is where its BCC
/// is wrong.
Bytes in_plain_letters(ByteView request);

/// What an error code of Appendix 3.1 means; empty for an unknown one.
std::string_view error_meaning(std::string_view code);

}  // namespace fieldproof::xgt_cnet_suite
