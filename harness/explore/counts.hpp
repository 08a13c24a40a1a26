// How much a request asks for: its count, and the same request for more or less of it, with all
// that belongs to that.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/explore/random.hpp"
#include "harness/protocol.hpp"

namespace fieldproof::explore {

/// What a request counts: blocks, words, bytes of data.
struct Count {
  harness::Field field;
  std::uint32_t value = 0;
};

/// "data", "data 2"; not its type, size or number, which make another request of it.
bool is_data(const harness::Field& field);

/// Refers to the protocol.
class Counts {
 public:
  /// `requests`: of a protocol that counts in bytes they tell which comes first.
  Counts(const harness::Protocol& protocol, int station, const std::vector<Bytes>& requests);

  /// Nothing: this one counts nothing.
  std::optional<Count> count_in(ByteView request) const;
  /// What it asks the device to do: "r SS", "10 Preset Multiple Registers, request".
  std::string service_of(ByteView request) const;
  /// The same of `count`: blocks are those that there are, data follow, and checks. Nothing: it
  /// cannot be told how.
  std::optional<Bytes> resized(ByteView request, std::uint32_t count, Random& random) const;
  /// Their checks as they must be.
  Bytes with_checks(Bytes request) const;

 private:
  std::uint32_t number(ByteView digits, bool low_first) const;
  Bytes digits(std::uint32_t value, std::size_t size) const;
  std::optional<Bytes> with_blocks(ByteView request, const Count& had, std::uint32_t count,
                                   Random& random) const;
  std::optional<Bytes> with_data(ByteView request, const Count& had, std::uint32_t count,
                                 Random& random) const;
  std::vector<harness::Field> fields_of(ByteView request) const;

  const harness::Protocol& protocol_;
  int station_;
  bool low_first_ = false;
};

}  // namespace fieldproof::explore
