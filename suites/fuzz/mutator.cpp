#include "suites/fuzz/mutator.hpp"

#include <algorithm>
#include <array>

namespace fieldproof::fuzz {

namespace {

constexpr std::size_t longest = 30'000;
/// Ends of ranges, control characters, and what text frames and JSON are made of.
constexpr std::array<Byte, 24> telling{0x00, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x0A,
                                       0x0D, 0x15, 0x7F, 0x80, 0xFE, 0xFF, '0',  '9',
                                       'A',  'F',  '%',  '"',  '{',  '[',  '-',  ':'};

std::size_t below(std::mt19937_64& random, std::size_t end) {
  return end == 0 ? 0 : random() % end;
}

}  // namespace

Bytes Mutator::beginning(Random& random) const {
  if (!seeds_.empty() && below(random, 20) != 0) return seeds_[below(random, seeds_.size())];
  Bytes bytes(below(random, 80));
  for (Byte& one : bytes) one = static_cast<Byte>(random());
  return bytes;
}

void Mutator::change(Bytes& bytes, Random& random) const {
  const std::size_t at = below(random, bytes.size() + 1);
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  const std::size_t rest = bytes.size() - at;
  const auto run = static_cast<std::ptrdiff_t>(std::min(rest, 1 + below(random, 16)));
  switch (below(random, 9)) {
    case 0:
      if (rest > 0) *place ^= static_cast<Byte>(1u << below(random, 8));
      break;
    case 1:
      if (rest > 0) *place = telling[below(random, telling.size())];
      break;
    case 2:
      if (rest > 0) *place = static_cast<Byte>(random());
      break;
    case 3: bytes.erase(place, place + run); break;
    case 4: bytes.insert(place, telling[below(random, telling.size())]); break;
    case 5: {  // the same again
      const Bytes again(place, place + run);
      bytes.insert(place, again.begin(), again.end());
      break;
    }
    case 6: bytes.resize(at); break;
    case 7: {  // the end of another one
      const Bytes other = beginning(random);
      const std::size_t from = below(random, other.size() + 1);
      bytes.resize(at);
      bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
      break;
    }
    default:
      if (rest > 0) *place = static_cast<Byte>(*place + (random() & 1 ? 1 : -1));
  }
}

Bytes Mutator::input(std::uint64_t number) const {
  Random random(seed_ * 0x9E3779B97F4A7C15u + number);
  Bytes bytes = beginning(random);
  for (std::size_t i = below(random, 7); i > 0; --i) change(bytes, random);
  if (bytes.size() > longest) bytes.resize(longest);
  return bytes;
}

}  // namespace fieldproof::fuzz
