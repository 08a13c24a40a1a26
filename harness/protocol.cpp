#include "harness/protocol.hpp"

#include <fmt/format.h>

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

Bytes Protocol::probe(int station, ByteView tested) const {
  return probing() ? probing()->probing_request(station, tested) : Bytes{};
}
bool Protocol::is_reply_to_probe(ByteView probe, ByteView reply) const {
  return probing() && probing()->answers_probe(probe, reply);
}

namespace {

Error no_request(const Protocol& protocol, std::string_view address) {
  return fail(
      fmt::format("{} has no request that reads or writes {}; use an emulator, whose memory "
                  "the bench sees, or --aux, another port of the same device",
                  protocol.name(), address));
}

}  // namespace

Result<std::vector<Bytes>> Protocol::write_requests(int station, std::string_view address,
                                                    std::string_view hex) const {
  if (!memory()) return no_request(*this, address);
  // From here on digits are counted: blanks between them would count as some.
  if (!std::ranges::all_of(hex, [](char c) { return hex_digit(c) >= 0; }))
    return fail(fmt::format("'{}' is not hex", hex));
  return memory()->requests_to_write(station, address, hex);
}
Result<std::vector<Bytes>> Protocol::read_requests(int station, std::string_view address,
                                                   std::size_t digits) const {
  if (!memory()) return no_request(*this, address);
  return memory()->requests_to_read(station, address, digits);
}
Status Protocol::write_reply(ByteView reply) const {
  if (!memory()) return no_request(*this, "memory");
  return memory()->acknowledged(reply);
}
Result<std::string> Protocol::read_reply(ByteView reply) const {
  if (!memory()) return no_request(*this, "memory");
  return memory()->digits_in(reply);
}

Status Protocol::sound_reply(ByteView request, ByteView reply) const {
  if (!memory()) return no_request(*this, "memory");
  if (reply.empty()) return fail("no answer");
  const std::vector<Field> fields = explain(reply);
  if (fields.empty()) return fail("the answer is no frame");
  for (const Field& field : fields)
    if (!field.problem.empty())
      return fail(
          fmt::format("the answer is damaged: {} {}: {}", field.name, field.text, field.problem));
  if (frame_length(reply) != reply.size()) return fail("the answer is no whole frame");
  if (!memory()->answers(request, reply)) return fail("the answer is one to another request");
  return ok();
}

Status Protocol::check_fact(const nlohmann::json& facts) const {
  if (tables()) return tables()->check_table(facts);
  return fail(fmt::format("the suite of {} has no tables; write a case", name()));
}

nlohmann::json Protocol::defaults(std::string_view) const { return nlohmann::json::object(); }

Result<std::unique_ptr<Protocol>> Protocol::configured(std::string_view,
                                                       const nlohmann::json&) const {
  return std::unique_ptr<Protocol>();
}

Result<Protocol::Placed> Protocol::placed(std::string_view address, std::string_view hex,
                                          const std::vector<Bytes>&) const {
  return Placed{std::string(address), std::string(hex)};
}
std::string Protocol::tied_to_default(const std::vector<Bytes>&) const { return {}; }

bool Protocol::has_model(std::string_view model) const {
  return std::ranges::count(models(), model) > 0;
}

std::optional<Protocol::WordName> Protocol::read_word(std::string_view) const {
  return std::nullopt;
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
