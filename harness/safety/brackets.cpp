#include "harness/safety/brackets.hpp"

#include <algorithm>

namespace fieldproof::safety {

using harness::Protocol;
using notation::Fields;
using notation::Item;
using notation::Notation;

Result<Bytes> bytes_of(const Notation& notation, const Fields& stations) {
  const Result<std::vector<notation::FrameTemplate>> templates =
      notation::make_templates(notation, stations);
  if (!templates) return templates.error();
  return templates->front().bytes;
}

std::vector<Bracket> brackets_of(const Notation& notation, bool reply, const Fields& stations,
                                 const Protocol& protocol) {
  std::vector<Bracket> brackets;
  for (std::size_t i = 0; i < notation.size(); ++i) {
    if (notation[i].kind != Item::Kind::open) continue;
    Bracket bracket{i, i, {}, {}};
    while (bracket.end < notation.size() && notation[bracket.end].kind != Item::Kind::close)
      ++bracket.end;
    const auto at = [&](std::size_t index) {
      return notation.begin() + static_cast<std::ptrdiff_t>(index);
    };
    const std::size_t closed = std::min(bracket.end + 1, notation.size());
    const Result<Bytes> bytes = bytes_of(Notation(at(bracket.begin), at(closed)), stations);
    if (!bytes) continue;
    bracket.bytes = *bytes;
    bracket.fields = protocol.address_fields(bracket.bytes, reply);
    brackets.push_back(std::move(bracket));
  }
  return brackets;
}

bool patch(Notation& notation, const Bracket& bracket, std::size_t offset, ByteView bytes,
           const Fields& stations) {
  const std::size_t past = offset + bytes.size();
  std::size_t patched = 0, start = 0;  // of the item
  for (std::size_t i = bracket.begin; i < bracket.end && start < past; ++i) {
    Item& item = notation[i];
    const bool literal = item.kind == Item::Kind::literal, name = item.kind == Item::Kind::name;
    if ((!literal && !name) || item.repeat != 1) {
      const auto at = [&](std::size_t index) {
        return notation.begin() + static_cast<std::ptrdiff_t>(index);
      };
      const Result<Bytes> with = bytes_of(Notation(at(bracket.begin), at(i + 1)), stations);
      if (!with) return false;
      start = with->size();
      continue;
    }
    const std::size_t size = name ? item.text.size() : item.bytes.size();
    if (name) start += stations.name_head(size).size();
    const std::size_t from = std::max(start, offset), to = std::min(start + size, past);
    for (std::size_t b = from; b < to; ++b, ++patched) {
      if (name)
        item.text[b - start] = static_cast<char>(bytes[b - offset]);
      else
        item.bytes[b - start] = bytes[b - offset];
    }
    if (literal && from < to) item.text = notation::print_bytes(item.bytes);
    start += size;
  }
  return patched == bytes.size();
}

}  // namespace fieldproof::safety
