// Faults of the stream: how frames are found in segments (DECISIONS.md fenet/stream).
#include <algorithm>
#include <memory>

#include "suites/broken/stream_faults.hpp"
#include "suites/xgt_fenet/broken/faults.hpp"

namespace fieldproof::xgt_fenet_broken {

namespace {

using Settings = xgt_fenet::ServerConfig;

bool is_data(const Burst& heard) { return heard.event == LinkEvent::data; }

std::size_t whole(const Bytes& bytes, std::size_t frames) {
  return broken::whole_frames(bytes, frames, body_at, [](const Bytes& all, std::size_t at) {
    return word_at(all, at + length_at);
  });
}
std::size_t whole(const Bytes& bytes) { return whole(bytes, broken::all_frames); }

constexpr auto hears_segment = broken::hears_segment<Settings>;
Behaviour one_stream() { return broken::one_stream<Settings>(whole); }
Behaviour half_stays(LinkEvent ending) { return broken::half_stays<Settings>(whole, ending); }

Bytes beginning(const Bytes& bytes, std::size_t size) {
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

/// Forgets what it has heard of a frame when the next segment comes later than so.
Behaviour impatient(Duration most) {
  struct Kept {
    std::map<LinkId, Time> last;
  };
  auto kept = std::make_shared<Kept>();
  return {.hear = [kept, most](Burst heard, Server&) {
    const auto last = kept->last.find(heard.link);
    const bool late = last != kept->last.end() && heard.start - last->second > most;
    const bool begins = heard.bytes.size() > 3 && heard.bytes[0] == 'L';
    kept->last[heard.link] = heard.start;
    return is_data(heard) && late && !begins ? Bursts{} : Bursts{std::move(heard)};
  }};
}

/// Looks for a company id before it takes a header.
Bytes from_the_id(Bytes segment) {
  const std::string text = to_text(segment);
  const std::size_t at = text.find("LSIS-XGT");
  if (at != text.npos)
    segment.erase(segment.begin(), segment.begin() + static_cast<std::ptrdiff_t>(at));
  return segment;
}

/// The answers of one moment in the reverse order.
void answers_reversed(Bursts& does, Server&) { std::ranges::reverse(does); }

}  // namespace

std::vector<Fault> stream_faults() {
  return {
      {"one_frame_a_segment", "of several frames in one segment the first alone is heard",
       hears_segment([](Bytes segment) {
         const std::size_t first = whole(segment, 1);
         return first == 0 ? segment : beginning(segment, first);
       }),
       "xgt_fenet/segments/two_in_one", ""},
      {"two_frames_a_segment", "a third frame in one segment is lost",
       hears_segment([](Bytes segment) {
         const std::size_t two = whole(segment, 2);
         return whole(segment, 3) == two ? segment : beginning(segment, two);
       }),
       "xgt_fenet/segments/three_in_one", ""},
      {"whole_segments_only", "a segment that ends in mid-frame is lost",
       hears_segment(
           [](Bytes segment) { return whole(segment) == segment.size() ? segment : Bytes{}; }),
       "xgt_fenet/segments/split/b20", "no answer"},
      {"header_in_one_piece", "a segment without a whole header is lost",
       hears_segment([](Bytes segment) { return segment.size() < body_at ? Bytes{} : segment; }),
       "xgt_fenet/segments/five_segments", "no answer"},
      {"rest_is_lost", "behind a whole frame the beginning of the next is lost",
       hears_segment([](Bytes segment) {
         const std::size_t size = whole(segment);
         return size == 0 ? segment : beginning(segment, size);
       }),
       "xgt_fenet/segments/one_and_a_part/b19", "no answer"},
      {"answers_reversed", "answers of one moment come in the reverse order",
       acts(answers_reversed), "xgt_fenet/segments/two_in_one", ""},
      {"one_stream_for_all", "the bytes of all connections are one stream", one_stream,
       "xgt_fenet/connections/byte_by_byte", ""},
      {"half_stays_after_rst", "half a frame stays when its connection is reset",
       [] { return half_stays(LinkEvent::reset); }, "xgt_fenet/connections/reset_in_mid_frame/b20",
       ""},
      {"half_stays_after_fin", "half a frame stays when its connection is closed",
       [] { return half_stays(LinkEvent::closed); }, "xgt_fenet/connections/fin_in_mid_frame/b20",
       ""},
      {"impatient_with_pieces", "the rest of a frame may not come later than 200 ms",
       [] { return impatient(200ms); }, "xgt_fenet/segments/pause/ms300", "no answer"},
      {"id_is_sought", "what stands before a company id is passed over", hears_segment(from_the_id),
       "xgt_fenet/segments/garbage_before/one_zero", ""},
  };
}

}  // namespace fieldproof::xgt_fenet_broken
