#include "suites/user_frames/broken/faults.hpp"

namespace fieldproof::user_frames_broken {

using user_frames::Convert;
using user_frames::Segment;
using user_frames::UserFrame;

namespace {

using Kind = Segment::Kind;

bool is_variable(const Segment& segment) {
  return segment.kind == Kind::data || segment.kind == Kind::rest;
}

/// The conversion is another; sizes in the frame follow.
Behaviour convert_otherwise(Convert hex_to_ascii, Convert ascii_to_hex) {
  return each_frame([=](UserFrame& frame) {
    for (Segment& segment : frame.segments) {
      if (!is_variable(segment) || segment.convert == Convert::none) continue;
      const std::size_t in_memory = user_frames::bytes_in_memory(frame, segment, segment.size);
      segment.convert = segment.convert == Convert::hex_to_ascii ? hex_to_ascii : ascii_to_hex;
      if (frame.sent)
        segment.size = segment.convert == Convert::none           ? in_memory
                       : segment.convert == Convert::hex_to_ascii ? in_memory * 2
                                                                  : in_memory / 2;
    }
  });
}

/// The last `size` bytes of a received variable are not stored.
void cut(UserFrame& frame, Kind kind) {
  for (std::size_t i = frame.segments.size(); i-- > 0;) {
    Segment& segment = frame.segments[i];
    if (segment.kind != kind || !segment.memory || segment.size == 1) continue;
    Segment lost;
    lost.kind = Kind::data;
    lost.size = segment.convert == Convert::ascii_to_hex ? 2 : 1;
    if (kind == Kind::data) segment.size -= lost.size;
    insert_behind(frame, i, lost);
  }
}

void low_byte_first(Segment& segment) {
  if (!segment.memory || segment.memory->type != 'W') return;
  segment.memory->type = 'B';
  segment.memory->index *= 2;
}

/// The second variable of each frame has no memory.
void lose_the_second(UserFrame& frame) {
  int count = 0;
  for (Segment& segment : frame.segments)
    if (is_variable(segment) && ++count == 2) segment.memory.reset();
}

}  // namespace

std::vector<Fault> variable_faults() {
  return {
      {"swap_not_applied", "bytes are not swapped", each_segment([](Segment& s) { s.swap = 1; }),
       "user_frames/swap/send_swap_2", "body 1: expected"},
      {"swap_always_2", "groups of 4 and 8 are swapped by 2", each_segment([](Segment& s) {
         if (s.swap > 1) s.swap = 2;
       }),
       "user_frames/swap/receive_swap_4", "%MW199 holds"},
      {"swap_of_8_is_4", "groups of 8 are swapped by 4", each_segment([](Segment& s) {
         if (s.swap == 8) s.swap = 4;
       }),
       "user_frames/swap/receive_swap_8", "%MW199 holds"},
      {"not_converted", "variables are not converted",
       convert_otherwise(Convert::none, Convert::none), "user_frames/conversions/send_h2a_printed",
       "body 1"},
      {"converted_the_other_way", "hex to ASCII and ASCII to hex are mixed up",
       convert_otherwise(Convert::ascii_to_hex, Convert::hex_to_ascii),
       "user_frames/conversions/send_a2h_4567", "body 1"},
      {"rest_cut", "the last byte of a variable segment is lost",
       each_received([](UserFrame& frame) { cut(frame, Kind::rest); }),
       "user_frames/segments/rest_of_half_a_word/bytes_313233", "%MW259 holds"},
      {"fixed_cut", "the last byte of a fixed segment is lost",
       each_received([](UserFrame& frame) { cut(frame, Kind::data); }),
       "user_frames/segments/four_fixed", "%MW200 holds"},
      {"low_byte_first", "words are taken low byte first", each_segment(low_byte_first),
       "user_frames/conversions/send_none", "body 1: expected"},
      {"stored_one_further", "data are stored one element further",
       each_received([](UserFrame& frame) {
         for (Segment& s : frame.segments)
           if (s.memory) ++s.memory->index;
       }),
       "user_frames/px7/any_content/commas", "%MW199 holds"},
      {"sent_from_one_further", "data are taken one element further",
       each_sent([](UserFrame& frame) {
         for (Segment& s : frame.segments)
           if (s.memory) ++s.memory->index;
       }),
       "user_frames/xgt_write/frame_follows_memory", "data: expected"},
      {"second_variable_lost", "only the first variable is stored", each_received(lose_the_second),
       "user_frames/segments/three_fixed_and_rest/two", "%MW240 holds"},
      {"never_stores", "received data are not stored", each_received([](UserFrame& frame) {
         for (Segment& s : frame.segments) s.memory.reset();
       }),
       "user_frames/xgt_write/nak_stores_the_code", "%MW199 holds"},
  };
}

}  // namespace fieldproof::user_frames_broken
