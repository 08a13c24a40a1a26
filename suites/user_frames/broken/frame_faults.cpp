#include <algorithm>
#include <cctype>

#include "suites/user_frames/broken/faults.hpp"

namespace fieldproof::user_frames_broken {

using user_frames::Area;
using user_frames::UserFrame;

namespace {

using Kind = user_frames::Segment::Kind;

Behaviour not_compared(Area area) {
  return each_received([area](UserFrame& frame) {
    for (user_frames::Segment& segment : frame.segments)
      if (segment.kind == Kind::constant && segment.area == area) accept_anything(segment);
  });
}

/// Sent frames lack the constants of an area.
Behaviour not_sent(Area area) {
  return each_sent([area](UserFrame& frame) {
    for (std::size_t i = frame.segments.size(); i-- > 0;)
      if (frame.segments[i].kind == Kind::constant && frame.segments[i].area == area)
        remove_segment(frame, i);
  });
}

/// Whatever is received is answered with the first frame that can be sent.
void answer_everything(user_frames::FrameDefinition& definition) {
  const auto first = std::ranges::find(definition.frames, true, &UserFrame::sent);
  if (first == definition.frames.end()) return;
  for (UserFrame& frame : definition.frames)
    if (!frame.sent) frame.answer = first->name;
}

Behaviour works_with(std::function<void(user_frames::FrameDefinition&)> edit) {
  return {.works_with = std::move(edit), .set_to = {}, .says = {}, .deaf_to = {}};
}
Behaviour says(std::function<Bytes(const Bytes&)> what) {
  return {.works_with = {}, .set_to = {}, .says = std::move(what), .deaf_to = {}};
}
Behaviour set_to(const char* key, nlohmann::json value) {
  return {
      .works_with = {},
      .set_to = [key, value = std::move(value)](nlohmann::json& config) { config[key] = value; },
      .says = {},
      .deaf_to = {}};
}

Bytes twice(const Bytes& frame) {
  Bytes both = frame;
  both.insert(both.end(), frame.begin(), frame.end());
  return both;
}

Bytes lower_case(const Bytes& frame) {
  Bytes bytes = frame;
  for (Byte& b : bytes) b = static_cast<Byte>(std::tolower(b));
  return bytes;
}

}  // namespace

std::vector<Fault> frame_faults() {
  return {
      {"head_not_compared", "any head is accepted", not_compared(Area::head),
       "user_frames/px7/other_head/ack", "%MW199 holds"},
      {"body_not_compared", "constants of the body are not compared", not_compared(Area::body),
       "user_frames/px7/not_this_frame/station", "%MW199 holds"},
      {"tail_not_compared", "any tail is accepted", not_compared(Area::tail),
       "user_frames/px7/other_tail/cr_cr", "%MW199 holds"},
      {"head_not_sent", "sent frames have no head", not_sent(Area::head), "user_frames/px7/request",
       "STX"},
      {"tail_not_sent", "sent frames have no tail", not_sent(Area::tail),
       "user_frames/px7_controller/answer", "CR LF"},
      {"frame_sent_twice", "each frame goes out twice", says(twice), "user_frames/px7/ko_request",
       "after the complete exchange"},
      {"lower_case", "letters go out in lower case", says(lower_case),
       "user_frames/segments/ten_bytes", "body 0"},
      {"mute", "nothing is sent", says([](const Bytes&) { return Bytes{}; }),
       "user_frames/px7/cycle", "no answer"},
      {"never_answers", "received frames are not answered",
       each_received([](UserFrame& frame) { frame.answer.clear(); }),
       "user_frames/px7_controller/two_requests", "no answer"},
      {"answers_what_has_no_answer", "every received frame is answered",
       works_with(answer_everything), "user_frames/px7/reply", "where silence is due"},
      {"deaf", "no frame is received", each_received([](UserFrame& frame) {
         frame.segments.front().bytes = {0xFF};
         frame.segments.front().size = 1;
         frame.segments.front().kind = Kind::constant;
       }),
       "user_frames/px7/ko_reply", "%MW199 holds"},
      {"works_in_stop",
       "STOP changes nothing",
       {.works_with = {}, .set_to = {}, .says = {}, .deaf_to = "stop"},
       "user_frames/px7/stop",
       "where silence is due"},
      {"silence_ends_no_frame", "the inter-character time is not kept",
       set_to("inter_character_ms", 60'000), "user_frames/px7/pause_inside", "%MW199 holds"},
      {"no_delay", "the delay of RS-485 is not kept", set_to("delay_ms", 0),
       "user_frames/px7_controller/delay", "where silence is due"},
  };
}

}  // namespace fieldproof::user_frames_broken
