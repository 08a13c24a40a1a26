// The parameters of the emulated inverter: words by address. The manuals name one address (1230)
// and leave the rest to the inverter's own manual; these ranges are this project's
// (DECISIONS.md ls-bus/addresses).
#pragma once

#include <cstdint>
#include <span>

#include "src/base/zeroed.hpp"

namespace fieldproof::ls_bus {

struct ParameterRange {
  std::uint16_t first = 0, last = 0;  // both belong to it
  bool write = false;
};

/// In the order of their addresses; what lies between them does not exist.
std::span<const ParameterRange> inverter_ranges();

class InverterParameters {
 public:
  InverterParameters() : words_(0x10000) {}

  bool exist(unsigned first, unsigned count) const;
  bool writable(unsigned first, unsigned count) const;

  /// Of an address that exists.
  std::uint16_t read(unsigned address) const { return words_[address]; }
  void write(unsigned address, std::uint16_t value) { words_[address] = value; }

 private:
  Zeroed<std::uint16_t> words_;
};

}  // namespace fieldproof::ls_bus
