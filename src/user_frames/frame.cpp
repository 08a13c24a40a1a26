#include "src/user_frames/frame.hpp"

#include <algorithm>

namespace fieldproof::user_frames {

std::string_view to_string(Area area) {
  switch (area) {
    case Area::head: return "head";
    case Area::body: return "body";
    case Area::tail: return "tail";
  }
  return "";
}

const UserFrame* FrameDefinition::find(std::string_view name) const {
  const auto found = std::ranges::find(frames, name, &UserFrame::name);
  return found == frames.end() ? nullptr : &*found;
}

std::vector<const UserFrame*> received_frames(const FrameDefinition& definition) {
  std::vector<const UserFrame*> frames;
  for (const UserFrame& frame : definition.frames)
    if (!frame.sent) frames.push_back(&frame);
  return frames;
}

std::size_t bytes_in_memory(const UserFrame& frame, const Segment& variable, std::size_t in_frame) {
  if (variable.convert == Convert::none) return in_frame;
  const bool twice_in_frame = (variable.convert == Convert::hex_to_ascii) == frame.sent;
  return twice_in_frame ? in_frame / 2 : in_frame * 2;
}

}  // namespace fieldproof::user_frames
