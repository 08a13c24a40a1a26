#include "suites/user_frames/frame_parts.hpp"

#include <fmt/format.h>

#include <tuple>

#include "harness/notation/notation.hpp"
#include "src/user_frames/codec.hpp"

namespace fieldproof::user_frames_suite {

namespace {

using State = user_frames::FrameMatch::State;

/// One frame of one definition against bytes.
struct Candidate {
  const NamedDefinition* definition = nullptr;
  const user_frames::UserFrame* frame = nullptr;
  user_frames::FrameMatch match;

  /// The better, the greater: a beginning that is said, for a variable takes any; the whole of
  /// `bytes`, a right check, as far as it goes.
  auto rank(ByteView bytes) const {
    const bool complete = match.state == State::complete;
    const bool begins = match.length() > 0 && !frame->segments.front().bytes.empty();
    return std::tuple(begins, complete && match.length() == bytes.size(),
                      complete && user_frames::check_holds(*frame, match, bytes), complete,
                      match.state == State::partial, match.length());
  }
};

Candidate nearest(std::span<const NamedDefinition> definitions, ByteView bytes) {
  Candidate best;
  for (const NamedDefinition& one : definitions)
    for (const user_frames::UserFrame& frame : one.definition.frames) {
      Candidate candidate{&one, &frame, user_frames::match_frame(frame, bytes, true)};
      if (!best.frame || candidate.rank(bytes) > best.rank(bytes)) best = std::move(candidate);
    }
  return best;
}

std::string problem_of(const Candidate& candidate, std::size_t position, ByteView bytes) {
  const user_frames::Segment& segment = candidate.frame->segments[position];
  if (segment.kind != user_frames::Segment::Kind::check || candidate.match.state != State::complete)
    return {};
  if (user_frames::check_holds(*candidate.frame, candidate.match, bytes)) return {};
  return fmt::format(
      "expected {} ({} of {} to {})",
      notation::print_bytes(user_frames::due_check(*candidate.frame, candidate.match, bytes)),
      user_frames::facts_of(segment.method).name, candidate.frame->segments[segment.first].name,
      candidate.frame->segments[segment.last].name);
}

/// What follows the segments that were read.
std::string problem_of_rest(const Candidate& candidate) {
  const std::size_t position = candidate.match.ends.size();
  if (position == candidate.frame->segments.size()) return "behind the end of the frame";
  const user_frames::Segment& next = candidate.frame->segments[position];
  if (candidate.match.state == State::partial) return fmt::format("{} is cut off", next.name);
  return fmt::format("expected {}: {}", next.name, notation::print_bytes(next.bytes));
}

}  // namespace

std::optional<std::size_t> frame_length(std::span<const NamedDefinition> definitions,
                                        ByteView bytes) {
  std::optional<std::size_t> longest;
  for (const NamedDefinition& one : definitions)
    for (const user_frames::UserFrame& frame : one.definition.frames) {
      const user_frames::FrameMatch match = user_frames::match_frame(frame, bytes);
      if (match.state == State::complete && match.length() > longest.value_or(0))
        longest = match.length();
    }
  return longest;
}

std::vector<harness::Field> explain(std::span<const NamedDefinition> definitions, ByteView frame) {
  const Candidate best = nearest(definitions, frame);
  if (!best.frame || best.match.length() == 0)
    return {{"frame", 0, frame.size(), notation::print_bytes(frame),
             "no definition has a frame that begins like this"}};
  std::vector<harness::Field> fields;
  for (std::size_t i = 0; i < best.match.ends.size(); ++i) {
    const ByteView part = best.match.part(frame, i);
    fields.push_back({best.frame->segments[i].name, best.match.ends[i] - part.size(), part.size(),
                      notation::print_bytes(part), problem_of(best, i, frame)});
  }
  if (const std::size_t at = best.match.length();
      at < frame.size() || best.match.state != State::complete)
    fields.push_back({"rest", at, frame.size() - at, notation::print_bytes(frame.subspan(at)),
                      problem_of_rest(best)});
  // The last, so that a difference is named by the segment where it begins.
  fields.push_back({"frame", frame.size(), 0,
                    fmt::format("{} of {}", best.frame->name, best.definition->name), ""});
  return fields;
}

std::vector<harness::Protocol::Written> written_by(const NamedDefinition& definition,
                                                   ByteView request) {
  for (const user_frames::UserFrame& frame : definition.definition.frames) {
    const user_frames::FrameMatch match = user_frames::match_frame(frame, request, true);
    if (frame.sent || match.state != State::complete || match.length() != request.size()) continue;
    std::vector<harness::Protocol::Written> written;
    for (std::size_t i = 0; i < frame.segments.size(); ++i) {
      const user_frames::Segment& segment = frame.segments[i];
      if (segment.in_block) return {{"?", 0, 0, "what a P2P block says"}};
      if (!segment.memory) continue;
      const auto count = static_cast<std::uint32_t>(
          user_frames::bytes_in_memory(frame, segment, match.part(request, i).size()));
      if (count == 0) continue;
      const std::uint32_t first = segment.memory->index * plc::type_bytes(segment.memory->type);
      const char area = definition.definition.plc->areas[segment.memory->area].letter;
      written.push_back(
          {std::string(1, area), first / 2, (first + count - 1) / 2, segment.address});
    }
    return written;
  }
  return {{"?", 0, 0, notation::print_bytes(request)}};
}

}  // namespace fieldproof::user_frames_suite
