// The table of protocols that the tool is made with (suites/protocols.cpp). It is handed down from
// main: nothing below it knows which protocols there are.
#pragma once

#include <span>
#include <string_view>

#include "harness/protocol.hpp"

namespace fieldproof::harness {

/// A view: the table outlives it. The first protocol is the default.
class Protocols {
 public:
  Protocols(std::span<const Protocol* const> table) : table_(table) {}

  auto begin() const { return table_.begin(); }
  auto end() const { return table_.end(); }
  bool empty() const { return table_.empty(); }
  const Protocol& front() const { return *table_.front(); }

  /// nullptr when unknown.
  const Protocol* find(std::string_view name) const;
  /// Protocol::read_word of the first that can read it.
  std::optional<Protocol::WordName> read_word(std::string_view text) const;
  /// The last axis that a device of any has.
  unsigned last_axis() const;
  /// The protocol `name`, or where it is empty, the first one that has `model` (empty: the default
  /// protocol). Errors name what there is.
  Result<const Protocol*> choose(std::string_view name, std::string_view model) const;

 private:
  std::span<const Protocol* const> table_;
};

}  // namespace fieldproof::harness
