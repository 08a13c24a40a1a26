// Vectors name memory where the default bases put it (Cnet EN 6.1.3: P0, M0, P0, M0). Where a
// device declares other bases, what a case calls %MW100 lies elsewhere there.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "suites/modbus/memory_requests.hpp"

namespace fieldproof::modbus_suite {

/// Where the declared device holds what a case that sends these requests calls `address`, and the
/// digits as they stand there. What no request reaches stays where it is. Errors: two tables of the
/// case hold it, and the declared ones lie apart; or there is no such name there.
Result<harness::Protocol::Placed> placed(const Framing& framing, const Bases& declared,
                                         std::string_view address, std::string_view hex,
                                         const std::vector<Bytes>& requests);

/// Why these requests mean something else on the declared device: the end of a table lies
/// elsewhere. Empty: they do not.
std::string tied_to_default(const Framing& framing, const Bases& declared,
                            const std::vector<Bytes>& requests);

}  // namespace fieldproof::modbus_suite
