// Memory through the XGT protocol itself, where there is no back door: requests in lower case,
// whose BCC tells what a bad line has made of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/protocol.hpp"
#include "src/plc/model.hpp"

namespace fieldproof::xgt_cnet_suite {

/// WSS for one element, WSB (at most 60 words each, Cnet EN 7.1.5 (4)) for more. F and N are read
/// only (Cnet EN 7.1.4).
Result<std::vector<Bytes>> write_requests(std::string_view station, std::string_view address,
                                          std::string_view hex);
/// RSS for one element, RSB for more.
Result<std::vector<Bytes>> read_requests(std::string_view station, std::string_view address,
                                         std::size_t digits);
Status write_reply(ByteView reply);
Result<std::string> read_reply(ByteView reply);
/// harness::MemoryRequests, of the same names.
bool answers(ByteView request, ByteView reply);
bool is_checked(ByteView request);
std::vector<std::pair<std::string, std::string>> sets(ByteView request);
Bytes without_check(ByteView request);

/// What a request frame would write. Without a model device names are read leniently: what a name
/// could touch on any model counts as touched.
std::vector<harness::Protocol::Written> written_by(ByteView request,
                                                   const plc::PlcModel* model = nullptr);

/// The names in a request, as far as the model has them.
std::vector<harness::Protocol::AddressField> address_fields(ByteView request,
                                                            const plc::PlcModel& model);

}  // namespace fieldproof::xgt_cnet_suite
