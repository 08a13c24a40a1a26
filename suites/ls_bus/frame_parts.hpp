// LS Bus frames taken apart for people: `frame`, the field-by-field difference, the end of a frame.
// Shares no code with the emulator (src/ls_bus): what is shown to be wrong must not depend on what
// answers.
#pragma once

#include <optional>
#include <vector>

#include "harness/protocol.hpp"
#include "suites/checks/control_bytes.hpp"

namespace fieldproof::ls_bus_suite {

using checks::ack, checks::enq, checks::eot, checks::nak;
constexpr std::size_t max_words = 8, digits_of_a_word = 4;

/// Length of the first complete frame: header to EOT (Cnet EN 8.1.1). A header inside a frame ends
/// it, and so it does a run of bytes before a header.
std::optional<std::size_t> frame_length(ByteView bytes);

/// The parts of a request, ACK or NAK (Cnet EN 8.2), as far as it can be read. A write is shown
/// with the address first, unless it adds up with the count first alone; its count then says so.
std::vector<harness::Field> explain(ByteView frame);

/// A request with all its digits as capitals and the sum that belongs to them, where its own sum is
/// right: of the digits of a request no manual says the case (DECISIONS.md ls-bus/letter-case).
/// Commands stay as they are.
Bytes in_plain_letters(ByteView request);

/// A write request in one of its two orders.
struct WriteReading {
  std::string address;       // four digits, as they stand in the request
  unsigned words = 1;        // as its count or its data say, whichever is more; at least one
  bool count_first = false;  // Cnet EN 8.2.1; else address first (inverter manuals)
  bool adds_up = false;      // count and length of the data agree
};
/// The readings that have an address, address first before count first.
std::vector<WriteReading> write_readings(ByteView frame);

/// What an error code means (FE IA ID IF WM: inverter manuals); empty for an unknown one.
std::string_view error_meaning(std::string_view code);

}  // namespace fieldproof::ls_bus_suite
