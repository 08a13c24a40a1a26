// An inverter's parameters through the LS Bus itself, where there is no back door. Addresses are
// four hex digits, "1230" or "h1230".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/protocol.hpp"

namespace fieldproof::ls_bus_suite {

/// The area of all parameters in the write fence, by the value of their address: --allow-write
/// h1230.
constexpr std::string_view parameter_area = "H";

/// ENQ, the body and its sum, EOT.
Bytes request(std::string_view body);

/// At most eight words each. `station`: two hex digits. What inverters tell of themselves is read
/// only.
Result<std::vector<Bytes>> write_requests(std::string_view station, std::string_view address,
                                          std::string_view hex, bool count_first = false);
Result<std::vector<Bytes>> read_requests(std::string_view station, std::string_view address,
                                         std::size_t digits);
Status write_reply(ByteView reply);
Result<std::string> read_reply(ByteView reply);
/// harness::MemoryRequests::answers.
bool answers(ByteView request, ByteView reply);

/// Runs of parameters that are not read only; those that the emulated inverter lacks are not
/// declared.
std::vector<harness::Protocol::Place> places(const harness::Protocol::Written& written);
std::optional<harness::Protocol::Written> named(std::string_view address, std::size_t digits);
std::optional<std::string> moved(std::string_view address, int words);
/// The address of a request, in one of the two orders of a write (Cnet EN 8.2.1: count first).
std::vector<harness::Protocol::AddressField> address_fields(ByteView request, bool count_first);

/// What a request frame would write: address first, and count first too unless it adds up address
/// first alone. Of a device that declares its order (true: count first), in that one.
std::vector<harness::Protocol::Written> written_by(ByteView request,
                                                   std::optional<bool> order = {});

}  // namespace fieldproof::ls_bus_suite
