#include "suites/fuzz/chosen.hpp"

#include <algorithm>
#include <string>

#include "harness/paths.hpp"
#include "harness/vectors/loader.hpp"
#include "suites/fuzz/rule.hpp"

namespace fieldproof::fuzz {

const harness::Protocol& protocol_of(Byte number) {
  const harness::Protocols all = suites::protocols();
  return **(all.begin() + number % (all.end() - all.begin()));
}

std::optional<Byte> number_of(std::string_view protocol) {
  const harness::Protocols all = suites::protocols();
  const auto found = std::ranges::find(all.begin(), all.end(), protocol,
                                       [](const harness::Protocol* one) { return one->name(); });
  if (found == all.end()) return std::nullopt;
  return static_cast<Byte>(found - all.begin());
}

Bytes behind(Byte number, ByteView rest) {
  Bytes all(1 + rest.size(), number);
  std::ranges::copy(rest, all.begin() + 1);
  return all;
}

const std::vector<vectors::Case>& cases_of_vectors() {
  static const vectors::VectorSet set = [] {
    const auto folder = harness::find_data().vectors;
    vectors::VectorSet read = vectors::load_vectors(folder, {.protocols = suites::protocols()});
    vectors::load_wires(folder, read);
    rule(!read.cases.empty(), "there are vectors to begin with; is FIELDPROOF_DATA right?");
    return read;
  }();
  return set.cases;
}

std::vector<Bytes> wires_of(const vectors::Step& step) {
  std::vector<Bytes> all;
  for (const vectors::Frame& frame : step.frames) {
    std::string hex = frame.wire.value_or("");
    std::ranges::replace(hex, '?', '0');
    if (std::optional<Bytes> bytes = from_hex(hex); bytes && !bytes->empty())
      all.push_back(std::move(*bytes));
  }
  return all;
}

}  // namespace fieldproof::fuzz
