#include "src/user_frames/block_frame.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/base/spelling.hpp"
#include "src/user_frames/variable.hpp"

namespace fieldproof::user_frames {

namespace {

Result<UserFrame> find_frame(const FrameDefinition& definition, const p2p::P2pBlock& block) {
  const bool sends = block.function == p2p::P2pBlock::Function::send;
  const UserFrame* found = definition.find(block.frame);
  if (found && found->sent == sends) return *found;
  if (found)
    return fail(fmt::format("frame {} is {}; name a frame of a {} group", block.frame,
                            sends ? "received" : "sent", sends ? "send" : "receive"));
  std::vector<std::string_view> names;
  for (const UserFrame& frame : definition.frames) names.push_back(frame.name);
  return fail(fmt::format("there is no frame '{}' in the definition; its frames are {}{}",
                          block.frame, fmt::join(names, ", "), suggestion(block.frame, names)));
}

/// Gives an open variable its memory, and where it is sent without one, its size.
Status settle(const FrameDefinition& definition, const p2p::P2pBlock& block, const UserFrame& frame,
              const plc::DeviceAddress& own, Segment& to) {
  const char* key = frame.sent ? "read" : "save";
  if (own.type == 'X')
    return fail(fmt::format("{} of {} is a bit; name bytes or words such as %MB200 or %MW100", key,
                            to.name));
  to.memory = own;
  if (frame.sent && to.kind == Segment::Kind::rest) {
    to.kind = Segment::Kind::data;
    if (to.convert == Convert::ascii_to_hex && block.size % 2 != 0)
      return fail(fmt::format("size is {}, and {} is pairs of hex digits; give an even size",
                              block.size, to.name));
    if (block.size % to.swap != 0)
      return fail(
          fmt::format("size is {}, which is no whole number of groups of {} that swap turns round",
                      block.size, to.swap));
    to.size = to.convert == Convert::none           ? block.size
              : to.convert == Convert::hex_to_ascii ? block.size * 2
                                                    : block.size / 2;
  }
  const std::size_t bytes = bytes_in_memory(frame, to, to.size);
  if (!fits_bytes(*definition.plc, own, bytes))
    return fail(
        fmt::format("{} of {}: the area ends before the last of {} bytes", key, to.name, bytes));
  return ok();
}

}  // namespace

Result<UserFrame> frame_of_block(const FrameDefinition& definition, const p2p::P2pBlock& block) {
  Result<UserFrame> frame = find_frame(definition, block);
  if (!frame) return frame;
  const char* key = frame->sent ? "read" : "save";
  const auto open =
      static_cast<std::size_t>(std::ranges::count(frame->segments, true, &Segment::in_block));
  if (open != block.variables.size())
    return fail(fmt::format(
        "{} has {} addresses, and frame {} has {} variables whose memory is the block's; {}", key,
        block.variables.size(), block.frame, open,
        open == 0 ? "remove it, or write \"memory\": true in the definition"
                  : "give one for each"));
  auto variable = block.variables.begin();
  for (Segment& segment : frame->segments) {
    if (!segment.in_block) continue;
    if (const Status settled = settle(definition, block, *frame, (variable++)->own, segment);
        !settled)
      return settled.error();
  }
  std::size_t size = 0;
  for (const Segment& segment : frame->segments) size += segment.size;
  if (size > max_frame)
    return fail(fmt::format("frame {} has {} bytes; it may have {}", block.frame, size, max_frame));
  return frame;
}

}  // namespace fieldproof::user_frames
