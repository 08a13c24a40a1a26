#include "harness/protocol.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace fieldproof::harness {

bool faultless(const std::vector<Field>& fields) {
  return !fields.empty() &&
         std::ranges::all_of(fields, [](const Field& field) { return field.problem.empty(); });
}

notation::Fields Protocol::fields_at(int station) const {
  return {station_bytes(station), station_bytes((station + 1) % 256), checks(), name_head()};
}

plc::FrameResult Protocol::monitor_result(ByteView frame, bool, bool) const {
  return faultless(explain(frame)) ? plc::user_definition_frame : plc::unknown_frame;
}

Result<std::unique_ptr<Protocol>> Protocol::configured(std::string_view,
                                                       const nlohmann::json&) const {
  return std::unique_ptr<Protocol>();
}

bool Protocol::has_model(std::string_view model) const {
  return std::ranges::count(models(), model) > 0;
}

std::string Protocol::spell(std::string_view area, std::uint32_t word) const {
  return std::string(area) + std::to_string(word);
}

std::vector<Protocol::Place> Protocol::places(const Written& written) const {
  return {{written.address, (written.last_word - written.first_word + 1) * std::size_t{4}}};
}

std::optional<Protocol::Written> Protocol::named(std::string_view, std::size_t) const {
  return std::nullopt;
}
std::optional<std::string> Protocol::moved(std::string_view, int) const { return std::nullopt; }
std::vector<Protocol::AddressField> Protocol::address_fields(ByteView, bool) const { return {}; }

/// Where addresses stand as text.
std::optional<Bytes> Protocol::moved_field(ByteView frame, const AddressField& field,
                                           int words) const {
  const std::optional<std::string> text =
      moved(to_text(frame.subspan(field.offset, field.size)), words);
  if (!text || text->size() != field.size) return std::nullopt;
  return to_bytes(*text);
}

std::uint32_t Protocol::words_of(std::string_view) const { return ~0u; }

}  // namespace fieldproof::harness
