// The partner's chair: one of our own devices answers what a client under test asks, and a fault
// may befall the answer.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/protocol.hpp"
#include "harness/vectors/case.hpp"
#include "src/line/device.hpp"

namespace fieldproof::exchange {

/// `answer` with a fault of its bytes: wrong_station, wrong_check, wrong_head, wrong_tail, short,
/// long, not_hex. But for wrong_check its check is right again. `station` is the partner's. Errors
/// say what the answer lacks for the fault.
Result<Bytes> damaged(std::string_view fault, ByteView answer, int station,
                      const harness::Protocol& protocol);

/// Lives as long as a case: devices keep their memory, and what was asked is remembered.
class Partner {
 public:
  explicit Partner(const harness::Protocol& protocol) : protocol_(protocol) {}

  struct Answer {
    Bytes bytes;    // empty: none
    Time moment{};  // when its first byte is due
  };
  /// What comes back for `request`. `too_late` is the moment at which the fault `late` begins to
  /// answer. Errors name the fault, or the key of the partner.
  Result<Answer> answer(const vectors::PartnerSpec& spec, const Burst& request, Time too_late);

 private:
  Result<plc::EmulatedDevice*> device_for(const vectors::PartnerSpec& spec);
  Result<Bytes> faulty(const vectors::PartnerSpec& spec, plc::EmulatedDevice& device,
                       const Burst& request, const Bytes& answer) const;

  struct Exchanged {
    Bytes request, answer;
  };
  const harness::Protocol& protocol_;
  std::map<std::string, std::unique_ptr<plc::EmulatedDevice>>
      devices_;                       // by model and configuration
  std::vector<Exchanged> exchanged_;  // in this case, without faults
};

}  // namespace fieldproof::exchange
