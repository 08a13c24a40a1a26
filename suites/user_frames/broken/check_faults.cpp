#include "suites/user_frames/broken/faults.hpp"

namespace fieldproof::user_frames_broken {

using user_frames::CheckMethod;
using user_frames::Segment;
using user_frames::UserFrame;

namespace {

Behaviour instead_of(CheckMethod right, CheckMethod wrong) {
  return each_check([=](Segment& check) {
    if (check.method == right) check.method = wrong;
  });
}

Behaviour start_of(CheckMethod method, std::uint16_t start) {
  return each_check([=](Segment& check) {
    if (check.method == method) check.options.start = start;
  });
}

/// The frame with a wrong check is stored all the same, and only then dropped.
void store_first(user_frames::FrameDefinition& definition) {
  std::vector<UserFrame> without_check;
  for (UserFrame frame : definition.frames) {
    if (frame.sent) continue;
    frame.answer.clear();
    for (Segment& segment : frame.segments)
      if (segment.kind == Segment::Kind::check) accept_anything(segment);
    without_check.push_back(std::move(frame));
  }
  definition.frames.insert(definition.frames.end(), without_check.begin(), without_check.end());
}

}  // namespace

std::vector<Fault> check_faults() {
  return {
      {"check_starts_one_late", "the first segment is not covered", each_check([](Segment& c) {
         if (c.first < c.last) ++c.first;
       }),
       "user_frames/xgt_write/b_a", "BCC: expected"},
      {"check_ends_one_early", "the last segment is not covered", each_check([](Segment& c) {
         if (c.first < c.last) --c.last;
       }),
       "user_frames/xgt_write/b_b", "BCC: expected"},
      {"check_covers_the_frame", "start and end are not looked at",
       each_frame([](UserFrame& frame) {
         for (std::size_t i = 0; i < frame.segments.size(); ++i)
           if (frame.segments[i].kind == Segment::Kind::check)
             frame.segments[i].first = 0, frame.segments[i].last = i - 1;
       }),
       "user_frames/check_options/range_body_only", "tail 2: expected"},
      {"check_not_verified", "a frame with a wrong check is received",
       each_received([](UserFrame& frame) {
         for (Segment& s : frame.segments)
           if (s.kind == Segment::Kind::check) accept_anything(s);
       }),
       "user_frames/xgt_write/nak_with_wrong_check", "%MW199 holds"},
      {"stores_before_the_check",
       "a frame with a wrong check is stored",
       {.works_with = store_first, .set_to = {}, .says = {}, .deaf_to = {}},
       "user_frames/check_methods/receive_wrong_crc_16",
       "%MW199 holds"},
      {"check_left_out", "sent frames have no check", each_sent([](UserFrame& frame) {
         for (std::size_t i = frame.segments.size(); i-- > 0;)
           if (frame.segments[i].kind == Segment::Kind::check) remove_segment(frame, i);
       }),
       "user_frames/xgt_write/frm_a", "BCC"},
      {"check_not_in_ascii", "the check is not converted", each_check([](Segment& c) {
         c.options.ascii = false;
         c.size = user_frames::check_size(c.method, false);
       }),
       "user_frames/check_options/ascii_byte_sum", "tail 1"},
      {"check_high_byte_first", "16-bit checks are sent high byte first",
       each_check([](Segment& c) { c.options.low_first = false; }),
       "user_frames/check_methods/crc_16_of_123456789", "tail 0: expected"},
      {"crc_starts_at_0", "CRC 16 starts at 0", start_of(CheckMethod::crc_16, 0),
       "user_frames/check_methods/send_crc_16_a", "tail 1: expected"},
      {"xor_starts_at_0", "XOR starts at 0", start_of(CheckMethod::byte_xor, 0),
       "user_frames/check_methods/send_byte_xor_a", "tail 1: expected"},
      {"initial_ff_ignored", "sums start at 0 always", start_of(CheckMethod::byte_sum, 0),
       "user_frames/check_options/initial_ff_byte_sum", "tail 1: expected"},
      {"seven_bits_are_eight", "7-bit SUM keeps the highest bit",
       instead_of(CheckMethod::sum_7bit, CheckMethod::byte_sum),
       "user_frames/check_methods/receive_7bit_sum_eight_bits", "%MW199 holds"},
      {"seven_bit_xor_is_eight", "7-bit XOR keeps the highest bit",
       instead_of(CheckMethod::xor_7bit, CheckMethod::byte_xor),
       "user_frames/check_methods/receive_7bit_xor_eight_bits", "%MW199 holds"},
      {"sum_1_without_20", "7-bit SUM#1 adds nothing below 20 hex",
       instead_of(CheckMethod::sum_7bit_1, CheckMethod::sum_7bit),
       "user_frames/check_methods/7bit_sum_1_at_1f", "tail 1: expected"},
      {"ones_for_twos_complement", "2'S COMP is the one's complement",
       instead_of(CheckMethod::sum_2s_complement, CheckMethod::sum_1s_complement),
       "user_frames/check_methods/send_byte_sum_2s_comp_a", "tail 1: expected"},
      {"df1_counts_dle_twice", "DLE AB counts both of DLE DLE",
       instead_of(CheckMethod::dle_ab, CheckMethod::sum_2s_complement),
       "user_frames/check_methods/send_dle_ab_doubled", "tail 1: expected"},
      {"siemens_without_dle_etx", "DLE SIEMENS does not cover DLE ETX", each_check([](Segment& c) {
         if (c.method == CheckMethod::dle_siemens) --c.last;
       }),
       "user_frames/check_methods/send_dle_siemens_a", "tail 1: expected"},
  };
}

}  // namespace fieldproof::user_frames_broken
