// Faults that show in one digit of the sum, or in one bit of an address.
#include <fmt/format.h>

#include <deque>

#include "src/base/bytes.hpp"
#include "suites/ls_bus/broken/faults.hpp"

namespace fieldproof::ls_bus_broken {

namespace {

/// A request whose sum is right in this digit is taken for right.
MakeBehaviour compares_one_digit(std::size_t digit) {
  return misread([digit](FrameText& request) {
    FrameText right = request;
    right.seal();
    if (request.sum.size() == 2 && request.sum[digit] == right.sum[digit]) request = right;
  });
}

/// Addresses of reads never have this bit.
MakeBehaviour loses_address_bit(unsigned bit) {
  return misread([bit](FrameText& request) {
    const std::string content = request.content();
    const auto bytes = from_hex(content.substr(0, std::min<std::size_t>(4, content.size())));
    if (request.command() != 'R' || !bytes || bytes->size() != 2) return;
    const unsigned address = ((*bytes)[0] << 8 | (*bytes)[1]) & ~(1U << bit);
    request.set_content(hex_number(address, 4) + content.substr(4));
  });
}

}  // namespace

std::vector<Fault> narrow_faults() {
  static std::deque<std::string> names;
  std::vector<Fault> result{
      {"sum_first_digit_alone", "of the sum of requests the first digit alone is compared",
       compares_one_digit(0), "errors/other_sums/low_digit", "header", broken::in_process},
      {"sum_second_digit_alone", "of the sum of requests the second digit alone is compared",
       compares_one_digit(1), "errors/other_sums/high_digit", "header", broken::in_process}};
  for (unsigned bit = 0; bit <= 12; ++bit)
    result.push_back({names.emplace_back(fmt::format("without_address_bit_{}", bit)),
                      "a read looks at an address with one bit less", loses_address_bit(bit),
                      "ranges/each_address_bit", "data", broken::in_process});
  return result;
}

}  // namespace fieldproof::ls_bus_broken
