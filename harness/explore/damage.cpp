#include "harness/explore/damage.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>
#include <utility>

#include "harness/explore/request.hpp"

namespace fieldproof::explore {

namespace {

auto place(Bytes& bytes, std::size_t at) { return bytes.begin() + static_cast<std::ptrdiff_t>(at); }

}  // namespace

Damaged flipped(Bytes frame, std::size_t at, unsigned bit) {
  frame[at] = static_cast<Byte>(frame[at] ^ (1u << bit));
  return {raw_notation(frame), fmt::format("bit {} of byte {} flipped", bit, at)};
}

Damaged dropped(Bytes frame, std::size_t at) {
  frame.erase(place(frame, at));
  return {raw_notation(frame), fmt::format("byte {} dropped", at)};
}

Damaged doubled(Bytes frame, std::size_t at) {
  const Byte byte = frame[at];
  frame.insert(place(frame, at), byte);
  return {raw_notation(frame), fmt::format("byte {} doubled", at)};
}

Damaged cut(Bytes frame, std::size_t size) {
  frame.resize(size);
  return {raw_notation(frame), fmt::format("cut after {} bytes", size)};
}

Damaged with_byte_before(Bytes frame, Byte byte) {
  frame.insert(frame.begin(), byte);
  return {raw_notation(frame), fmt::format("{:02X} before it", byte)};
}

Damaged with_byte_behind(Bytes frame, Byte byte) {
  frame.push_back(byte);
  return {raw_notation(frame), fmt::format("{:02X} behind it", byte)};
}

Damaged paused(ByteView frame, std::size_t at, notation::Pause pause) {
  notation::Item item;
  item.kind = notation::Item::Kind::pause;
  item.pause = pause;
  item.text = fmt::format("~{:g}{}", pause.amount, pause.characters ? "c" : "ms");
  Damaged damaged{raw_notation(frame.first(at)), {}};
  damaged.notation.push_back(std::move(item));
  std::ranges::move(raw_notation(frame.subspan(at)), std::back_inserter(damaged.notation));
  damaged.change = fmt::format("{:g} {} of silence before byte {}", pause.amount,
                               pause.characters ? "characters" : "ms", at);
  return damaged;
}

}  // namespace fieldproof::explore
