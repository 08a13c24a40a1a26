#include "reports/history/storage/packed_list.hpp"

#include <algorithm>
#include <numeric>

namespace fieldproof::history {

namespace {

/// Longer lists are damage: they would fill the memory before anybody reads them.
constexpr std::uint64_t most_numbers = 100'000'000;

/// Seven bits a byte, the lowest first; the highest bit says that more follow.
void append(std::string& bytes, std::uint64_t number) {
  for (; number >= 0x80; number >>= 7) bytes += static_cast<char>(0x80 | (number & 0x7F));
  bytes += static_cast<char>(number);
}

/// Reads what `append` wrote. A number beyond the end is none, and nothing comes after it.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_(bytes) {}
  bool more() const { return !rest_.empty() && ok_; }
  bool ok() const { return ok_; }

  std::uint64_t take() {
    std::uint64_t number = 0;
    for (unsigned shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(rest_.front());
      rest_.remove_prefix(1);
      number |= std::uint64_t{byte & 0x7Fu} << shift;
      if (byte < 0x80) return number;
    }
    ok_ = false;
    return 0;
  }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

/// Small numbers of either sign become small: 0, -1, 1, -2, ...
std::uint64_t unsigned_of(std::int64_t number) {
  return (static_cast<std::uint64_t>(number) << 1) ^ static_cast<std::uint64_t>(number >> 63);
}

std::int64_t signed_of(std::uint64_t number) {
  return static_cast<std::int64_t>(number >> 1) ^ -static_cast<std::int64_t>(number & 1);
}

}  // namespace

std::string pack(const Numbers& numbers) {
  std::string bytes;
  for (auto first = numbers.begin(); first != numbers.end();) {
    const auto last = std::find_if(first, numbers.end(), [&](auto one) { return one != *first; });
    // A single number costs nothing more: the lowest bit says whether a count follows.
    const auto count = static_cast<std::uint64_t>(last - first);
    const std::uint64_t number = unsigned_of(*first);
    append(bytes, number << 1 | (count > 1 ? 1 : 0));
    if (count > 1) append(bytes, count);
    first = last;
  }
  return bytes;
}

std::optional<std::vector<Repeated>> unpack_repeated(std::string_view bytes) {
  std::vector<Repeated> parts;
  parts.reserve(bytes.size() / 2);
  std::uint64_t left = most_numbers;
  for (Cursor cursor(bytes); cursor.more();) {
    const std::uint64_t head = cursor.take();
    const std::uint64_t count = head & 1 ? cursor.take() : 1;
    if (!cursor.ok() || count > left) return std::nullopt;
    left -= count;
    parts.push_back({signed_of(head >> 1), count});
  }
  return parts;
}

std::optional<Numbers> unpack(std::string_view bytes) {
  const auto parts = unpack_repeated(bytes);
  if (!parts) return std::nullopt;
  Numbers numbers;
  numbers.reserve(parts->size());
  for (const Repeated& one : *parts) numbers.insert(numbers.end(), one.count, one.number);
  return numbers;
}

Numbers to_steps(Numbers numbers) {
  std::adjacent_difference(numbers.begin(), numbers.end(), numbers.begin());
  return numbers;
}

Numbers from_steps(Numbers steps) {
  std::partial_sum(steps.begin(), steps.end(), steps.begin());
  return steps;
}

}  // namespace fieldproof::history
