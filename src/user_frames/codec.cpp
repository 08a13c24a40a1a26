#include "src/user_frames/codec.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/user_frames/variable.hpp"

namespace fieldproof::user_frames {

namespace {

using State = FrameMatch::State;

/// The segments from `from` on, of known size, at offset `at`.
State match_sized(const UserFrame& frame, std::size_t from, ByteView bytes, std::size_t at,
                  std::vector<std::size_t>& ends) {
  for (std::size_t i = from;
       i < frame.segments.size() && frame.segments[i].kind != Segment::Kind::rest; ++i) {
    const Segment& segment = frame.segments[i];
    const std::size_t have = std::min(segment.size, bytes.size() - at);
    if (segment.kind == Segment::Kind::constant &&
        !std::equal(segment.bytes.begin(),
                    segment.bytes.begin() + static_cast<std::ptrdiff_t>(have),
                    bytes.begin() + static_cast<std::ptrdiff_t>(at)))
      return State::no;
    if (have < segment.size) return State::partial;
    at += segment.size;
    ends.push_back(at);
  }
  return State::complete;
}

/// `rest` ends where the tail stands first; without constants in the tail, where the silence
/// begins.
FrameMatch match_rest(const UserFrame& frame, FrameMatch match, ByteView bytes, bool ended) {
  const std::size_t begin = match.length(), position = match.ends.size();
  std::size_t tail_size = 0;
  bool has_constant = false;
  for (std::size_t i = position + 1; i < frame.segments.size(); ++i) {
    tail_size += frame.segments[i].size;
    has_constant |= frame.segments[i].kind == Segment::Kind::constant;
  }
  match.state = State::partial;
  if (bytes.size() < begin + tail_size || (!has_constant && !ended)) return match;
  for (std::size_t at = has_constant ? begin : bytes.size() - tail_size;
       at + tail_size <= bytes.size(); ++at) {
    std::vector<std::size_t> ends = match.ends;
    ends.push_back(at);
    if (match_sized(frame, position + 1, bytes, at, ends) == State::complete)
      return {State::complete, std::move(ends)};
  }
  return match;
}

}  // namespace

ByteView FrameMatch::part(ByteView frame, std::size_t segment) const {
  const std::size_t begin = segment == 0 ? 0 : ends[segment - 1];
  return frame.subspan(begin, ends[segment] - begin);
}

FrameMatch match_frame(const UserFrame& frame, ByteView bytes, bool ended) {
  FrameMatch match;
  match.state = match_sized(frame, 0, bytes, 0, match.ends);
  const bool at_rest = match.state == State::complete && match.ends.size() < frame.segments.size();
  return at_rest ? match_rest(frame, std::move(match), bytes, ended) : match;
}

std::size_t check_position(const UserFrame& frame) {
  const auto found = std::ranges::find(frame.segments, Segment::Kind::check, &Segment::kind);
  return static_cast<std::size_t>(found - frame.segments.begin());
}

Bytes due_check(const UserFrame& frame, const FrameMatch& match, ByteView bytes) {
  const std::size_t position = check_position(frame);
  if (position == frame.segments.size()) return {};
  const Segment& check = frame.segments[position];
  const std::size_t begin = check.first == 0 ? 0 : match.ends[check.first - 1];
  return compute_check(check.method, check.options,
                       bytes.subspan(begin, match.ends[check.last] - begin));
}

bool check_holds(const UserFrame& frame, const FrameMatch& match, ByteView bytes) {
  const std::size_t position = check_position(frame);
  return position == frame.segments.size() ||
         std::ranges::equal(match.part(bytes, position), due_check(frame, match, bytes));
}

Stored store(const UserFrame& frame, const FrameMatch& match, ByteView bytes,
             plc::PlcMemory& memory) {
  std::vector<std::pair<const Segment*, Bytes>> values;
  for (std::size_t i = 0; i < frame.segments.size(); ++i) {
    const Segment& segment = frame.segments[i];
    if (segment.kind != Segment::Kind::data && segment.kind != Segment::Kind::rest) continue;
    const std::optional<Bytes> value = converted(segment.convert, match.part(bytes, i));
    if (!value) return Stored::not_hex;
    if (!segment.memory) continue;
    if (!fits_bytes(memory.model(), *segment.memory, value->size())) return Stored::beyond_area;
    values.emplace_back(&segment, swapped(segment.swap, *value));
  }
  for (const auto& [segment, value] : values) write_bytes(memory, *segment->memory, value);
  return Stored::yes;
}

Result<Bytes> build_frame(const UserFrame& frame, const plc::PlcMemory& memory) {
  Bytes bytes;
  FrameMatch match;
  for (const Segment& segment : frame.segments) {
    Bytes part = segment.bytes;
    if (segment.in_block && !segment.memory)
      return fail(
          fmt::format("cannot send {}: the memory of {} is given by a P2P block, and there is none",
                      frame.name, segment.name));
    if (segment.kind == Segment::Kind::data) {
      const Bytes held =
          read_bytes(memory, *segment.memory, bytes_in_memory(frame, segment, segment.size));
      const std::optional<Bytes> value = converted(segment.convert, swapped(segment.swap, held));
      if (!value)
        return fail(fmt::format("cannot send {}: {} at {} holds {}, which are not ASCII hex digits",
                                frame.name, segment.name, segment.address, to_hex(held)));
      part = *value;
    }
    if (segment.kind == Segment::Kind::check) part.assign(segment.size, 0);
    bytes.insert(bytes.end(), part.begin(), part.end());
    match.ends.push_back(bytes.size());
  }
  const Bytes check = due_check(frame, match, bytes);
  if (!check.empty())
    std::ranges::copy(check, bytes.end() - static_cast<std::ptrdiff_t>(
                                               match.length() - match.ends[check_position(frame)] +
                                               check.size()));
  return bytes;
}

}  // namespace fieldproof::user_frames
