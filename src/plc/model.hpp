// The device areas of the emulated PLCs, once, as data (Cnet EN and KO chapter 7 'Available types
// of device').
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fieldproof::plc {

/// Base, slot and element of dotted names: XEC I, Q and U ("%IW0.0.0"). All zero: the area has no
/// dotted names.
struct DottedForm {
  std::uint32_t bases = 0;
  std::uint32_t slots = 0;       // a base
  std::uint32_t slot_words = 0;  // words a slot

  explicit operator bool() const { return bases != 0; }
};

/// One area of words 0 to `last_word()`. Every area can be read and monitored.
struct DeviceArea {
  char letter = 0;
  std::uint32_t words = 0;
  bool write = true;
  std::uint32_t contacts = 0;  // T and C: bit names are contacts, apart from the current values
  DottedForm dotted{};
  char same_as = 0;  // the letter of the area whose words it has, of the same size

  std::uint32_t last_word() const { return words - 1; }
};

struct PlcModel {
  std::string_view name;  // "xbc-h"
  bool iec = false;       // bit names are flat bit indexes, not a word and a hex digit
  std::span<const DeviceArea> areas;
  bool clock = true;  // frames are monitored with the time of day, else since the first of them

  /// The area of an upper-case letter, or nullptr.
  const DeviceArea* area(char letter) const;
};

/// xbc-h (XBC-DxxxH), xbm-s (XBM-DxxxS), xec-h (XEC-DxxxH): the default first.
std::span<const PlcModel> plc_models();
/// nullptr when unknown.
const PlcModel* find_plc_model(std::string_view name);
/// The last words that the models have of an area, in rising order; empty: none has it.
std::vector<std::uint32_t> last_words_of(char letter);
/// "xbc-h, xbm-s, xec-h", for messages.
std::string plc_model_names();

}  // namespace fieldproof::plc
