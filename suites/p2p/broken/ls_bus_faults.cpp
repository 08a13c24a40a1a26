// The LS Bus client (000 and 003 chapter 8).
#include "src/ls_bus/codec.hpp"
#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p {

namespace {

void set_sum(Bytes& frame) {
  const std::size_t sum = frame.size() - 3;
  std::ranges::copy(hex_number(ls_sum(ByteView(frame).subspan(1, sum - 1)), 2), frame.begin() + static_cast<std::ptrdiff_t>(sum));
}

MakeBehaviour spoils_with_sum(std::function<void(Bytes& request)> edit) {
  return spoils([=](Bytes& request) {
    edit(request);
    set_sum(request);
  });
}

void accept_any_sum(Bytes& frame, const P2pBlock&) {
  if (frame.size() >= 7) set_sum(frame);
}

}  // namespace

std::vector<Fault> ls_bus_faults() {
  constexpr std::size_t count_of_read = 8;
  return {
      {"sum_missing", "the request has no sum", spoils([](Bytes& request) { request.erase(request.end() - 3, request.end() - 1); }),
       "ls_bus/client/read", ""},
      {"sum_with_header", "ENQ is in the sum",
       spoils([](Bytes& request) {
         const std::size_t sum = request.size() - 3;
         std::ranges::copy(hex_number(ls_sum(ByteView(request).first(sum)), 2), request.begin() + static_cast<std::ptrdiff_t>(sum));
       }),
       "ls_bus/client/read", ""},
      {"ls_count_plus_one", "a read asks for one word more", spoils_with_sum([](Bytes& request) {
         if (request.at(3) == 'R') ++request.at(count_of_read);
       }),
       "ls_bus/client/read", ""},
      {"ls_sum_ignored", "a wrong sum is accepted", hears(accept_any_sum), "ls_bus/client/error", ""},
  };
}

}  // namespace fieldproof::p2p
