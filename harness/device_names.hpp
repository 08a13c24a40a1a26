// Names of PLC memory (src/plc/address.hpp) as write fence, journal and transposition see them, on
// one declared model.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "harness/protocol.hpp"
#include "src/plc/address.hpp"

namespace fieldproof::harness {

/// The words, or contacts, that `count` elements from `address` on lie in.
Protocol::Written memory_of(const plc::PlcModel& model, const plc::DeviceAddress& address,
                            std::uint32_t count, std::string_view name);

/// "%MW100" taken apart, whatever the model: area and type as capitals. A view into the name.
struct ElementName {
  char area = 0, type = 0;  // type: X B W D L
  std::string_view number;

  std::size_t element_bytes() const { return plc::type_bytes(type); }
};
std::optional<ElementName> read_element_name(std::string_view text);
/// "%MX0010A", whatever the model.
bool is_bit_name(std::string_view text);
/// The name of an element so many further on. Errors: the number is not decimal.
Result<std::string> element_further_on(const ElementName& name, std::size_t elements);

/// What `count` elements from a name on could touch: read leniently where `model` is nullptr or
/// does not know the name: what it could touch on any model counts as touched. Of a damaged name
/// the whole area, or area "?".
Protocol::Written memory_at(const plc::PlcModel* model, const std::string& name,
                            std::uint32_t count);

/// "M", "M100", "%MW100": an area of any model.
std::optional<Protocol::WordName> read_word_name(std::string_view text);

/// What so many hex digits at a name stand for; nothing where the model has no such memory.
std::optional<Protocol::Written> named_memory(const plc::PlcModel& model, std::string_view name,
                                              std::size_t digits);

/// Of a moved name: as many as before, where its length is on the wire; or what it needs.
enum class Digits { as_many, any };

/// "%MW100" and 20: "%MW120"; "%MX0010A" and 4: "%MX0014A". The same type and place in the word; a
/// contact moves by contacts. Nothing where there is no such name: more digits than it may have,
/// half a double word, past the area, "%IW0.0.0".
std::optional<std::string> moved_name(const plc::PlcModel& model, std::string_view name, int words,
                                      Digits digits = Digits::as_many);

/// `written` as names: the words that the model has, and those past its area; each contact by
/// itself. None of a read-only area.
std::vector<Protocol::Place> places_on(const plc::PlcModel& model,
                                       const Protocol::Written& written);

}  // namespace fieldproof::harness
