// Faults of what a server looks at in the header of a request (DECISIONS.md fenet/company-id,
// fenet/header-check, fenet/source).
#include <algorithm>
#include <numeric>

#include "suites/xgt_fenet/broken/faults.hpp"

namespace fieldproof::xgt_fenet_broken {

namespace {

using xgt_fenet::CheckPolicy;
using xgt_fenet::ServerConfig;

MakeBehaviour policy(CheckPolicy from, CheckPolicy to) {
  return set_up([=](ServerConfig& config) {
    if (config.check == from) config.check = to;
  });
}

/// A request of which that much of the id is right has a right one.
MakeBehaviour id_compared(std::size_t begin, std::size_t size) {
  return misreads([=](Bytes request) {
    const Bytes id = to_bytes(std::string("LSIS-XGT\0\0", 10));
    const auto at = static_cast<std::ptrdiff_t>(begin);
    if (std::equal(id.begin() + at, id.begin() + at + static_cast<std::ptrdiff_t>(size),
                   request.begin() + at))
      std::ranges::copy(id, request.begin());
    return request;
  });
}

/// What stands at `at` of a request must be `value`, or it is refused as having no company id.
MakeBehaviour demands(std::size_t at, Byte value) {
  return misreads([=](Bytes request) {
    if (request[at] != value) request[0] = 0;
    return request;
  });
}

/// The check of requests is that of something else.
MakeBehaviour strict_by(Byte (*check)(const Bytes& request)) {
  return misreads([=](Bytes request) {
    const bool good = request[check_at] == check(request);
    mend(request);
    if (!good) ++request[check_at];
    return request;
  });
}

}  // namespace

std::vector<Fault> check_faults() {
  return {
      {"id_not_looked_at", "any company id is taken", id_compared(0, 0),
       "xgt_fenet/header/company_id_wrong/xgt_byte_0", ""},
      {"id_of_8_bytes", "the two zeros of the company id are not looked at", id_compared(0, 8),
       "xgt_fenet/header/company_id_wrong/xgt_byte_8", ""},
      {"id_of_9_bytes", "the last byte of the company id is not looked at", id_compared(0, 9),
       "xgt_fenet/header/company_id_wrong/xgt_byte_9", ""},
      {"id_behind_the_maker", "the first four letters of the company id are not looked at",
       id_compared(4, 6), "xgt_fenet/header/company_id_wrong/xgt_byte_3", ""},
      {"id_in_any_case", "the company id is taken in lower case, too", misreads([](Bytes request) {
         for (std::size_t i = 0; i < 10; ++i)
           if (request[i] >= 'a' && request[i] <= 'z') request[i] -= 0x20;
         return request;
       }),
       "xgt_fenet/header/company_id_wrong/lower_case", ""},
      {"second_id_refused", "LGIS-GLOFA is refused", demands(1, 'S'),
       "xgt_fenet/header/company_id/id_2", ""},
      {"id_wrong_unanswered", "a wrong company id draws no answer", misreads([](Bytes request) {
         const bool known = request[0] == 'L' && (request[1] == 'S' || request[1] == 'G');
         return known ? request : Bytes{};
       }),
       "xgt_fenet/header/company_id_wrong/zeros", "no answer"},
      {"source_checked", "a source other than 33 is refused", demands(source_at, 0x33),
       "xgt_fenet/header/source_of_request/s11", ""},
      {"plc_info_checked", "a PLC info other than 0 is refused", demands(plc_info_at, 0),
       "xgt_fenet/header/plc_info_of_request/i0100", ""},
      {"cpu_info_checked", "a CPU info other than A0 is refused", demands(cpu_at, 0xA0),
       "xgt_fenet/header/cpu_info_of_request/cb0", ""},
      {"position_checked", "a position other than 0 is refused", demands(position_at, 0),
       "xgt_fenet/header/position_of_request/p03", ""},
      {"reserved_checked", "a reserved word other than 0 is refused", demands(reserved_at, 0),
       "xgt_fenet/header/reserved_of_request/read_0801", ""},
      {"check_always_strict", "the check is looked at without being set so",
       policy(CheckPolicy::ignore, CheckPolicy::strict),
       "xgt_fenet/header/check_ignored_by_default", ""},
      {"zero_check_refused", "a check 00 is refused where it is allowed",
       policy(CheckPolicy::zero_or_valid, CheckPolicy::strict),
       "xgt_fenet/header/check_of_request/zero_or_valid_zero", ""},
      {"wrong_check_taken", "a wrong check is taken where it must be 00 or right",
       policy(CheckPolicy::zero_or_valid, CheckPolicy::ignore),
       "xgt_fenet/header/check_of_request/zero_or_valid_wrong", ""},
      {"strict_check_ignored", "a wrong check is taken in spite of strict",
       policy(CheckPolicy::strict, CheckPolicy::ignore),
       "xgt_fenet/header/check_of_request/strict_wrong", ""},
      {"strict_takes_zero", "a check 00 is taken in spite of strict",
       policy(CheckPolicy::strict, CheckPolicy::zero_or_valid),
       "xgt_fenet/header/check_of_request/strict_zero", ""},
      {"strict_over_the_body", "requests are checked with their body",
       strict_by([](const Bytes& r) {
         return static_cast<Byte>(
             std::accumulate(r.begin() + body_at, r.end(), unsigned{sum_of_header(r)}));
       }),
       "xgt_fenet/header/check_of_request/strict_right", ""},
      {"strict_behind_the_id", "requests are checked without their company id",
       strict_by([](const Bytes& r) {
         return static_cast<Byte>(std::accumulate(r.begin() + 10, r.begin() + check_at, 0u));
       }),
       "xgt_fenet/header/check_of_request/strict_right", ""},
  };
}

}  // namespace fieldproof::xgt_fenet_broken
