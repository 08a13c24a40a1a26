// Memory through the XGT FEnet protocol itself, where there is no back door. Invoke ids of these
// requests lie above those that cases count.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/protocol.hpp"
#include "src/plc/model.hpp"

namespace fieldproof::xgt_fenet_suite {

/// Bytes as a continuous request of at most 512 (FEnet EN 5.2.4), other elements as individual ones
/// of at most 16 blocks. F and N are read only (DECISIONS.md fenet/memory-map).
Result<std::vector<Bytes>> write_requests(std::string_view address, std::string_view hex);
Result<std::vector<Bytes>> read_requests(std::string_view address, std::size_t digits);
Status write_reply(ByteView reply);
/// Each element most significant digit first, as its data type says.
Result<std::string> read_reply(ByteView reply);
/// harness::MemoryRequests::answers.
bool answers(ByteView request, ByteView reply);

/// A read of the first word of M, with an invoke id that `tested` does not have.
Bytes probing_request(ByteView tested);

/// Of so many bytes from %MB0 on, and of so many times the first word of M.
Bytes read_of_bytes(unsigned count);
Bytes read_of_blocks(unsigned count);

/// What the frames in a request would write, also where a header is damaged. Without a model
/// names are read leniently (harness::memory_at).
std::vector<harness::Protocol::Written> written_by(ByteView request, const plc::PlcModel* model);

/// The names in a request.
std::vector<harness::Protocol::AddressField> address_fields(ByteView request,
                                                            const plc::PlcModel& model);

}  // namespace fieldproof::xgt_fenet_suite
