// Faults of the stream: how frames are found in segments (DECISIONS.md modbus-tcp/stream).
#include <algorithm>
#include <memory>

#include "suites/broken/stream_faults.hpp"
#include "suites/modbus/tcp_broken/faults.hpp"

namespace fieldproof::modbus_tcp_broken {

namespace {

using Settings = modbus::TcpServerConfig;

bool is_data(const Burst& heard) { return heard.event == LinkEvent::data; }

std::size_t whole(const Bytes& bytes, std::size_t frames) {
  return broken::whole_frames(bytes, frames, unit_at, [](const Bytes& all, std::size_t at) {
    return word_at(all, at + length_at);
  });
}
std::size_t whole(const Bytes& bytes) { return whole(bytes, broken::all_frames); }

constexpr auto hears_segment = broken::hears_segment<Settings>;
Behaviour one_stream() { return broken::one_stream<Settings>(whole); }
Behaviour half_stays(LinkEvent ending) { return broken::half_stays<Settings>(whole, ending); }

Bytes last_frame(Bytes segment) {
  std::size_t begin = 0;
  for (std::size_t frames = 1;; ++frames) {
    const std::size_t end = whole(segment, frames);
    if (end == begin || end == segment.size()) break;
    begin = end;
  }
  return {segment.begin() + static_cast<std::ptrdiff_t>(begin), segment.end()};
}

/// Answers as soon as the function has come: the rest is taken for zeros.
Behaviour answers_too_soon() {
  auto skips = std::make_shared<std::map<LinkId, std::size_t>>();
  return {.hear = [skips](Burst heard, Server&) {
    if (!is_data(heard)) return Bursts{std::move(heard)};
    std::size_t& skip = (*skips)[heard.link];
    const std::size_t passed = std::min(skip, heard.bytes.size());
    skip -= passed;
    heard.bytes.erase(heard.bytes.begin(),
                      heard.bytes.begin() + static_cast<std::ptrdiff_t>(passed));
    const std::size_t size = unit_at + word_at(heard.bytes, length_at);
    if (heard.bytes.size() > function_at && heard.bytes.size() < size) {
      skip = size - heard.bytes.size();
      heard.bytes.resize(size);
    }
    return Bursts{std::move(heard)};
  }};
}

/// A half frame is forgotten when so much time passes.
Behaviour forgets_after(Duration pause) {
  struct Kept {
    Bytes half;
    Time last{};
  };
  auto kept = std::make_shared<std::map<LinkId, Kept>>();
  return {.hear = [kept, pause](Burst heard, Server&) {
    if (!is_data(heard)) return Bursts{std::move(heard)};
    Kept& own = (*kept)[heard.link];
    if (heard.start - own.last > pause) own.half.clear();
    own.last = heard.start;
    own.half.insert(own.half.end(), heard.bytes.begin(), heard.bytes.end());
    heard.bytes = broken::take_whole(own.half, whole);
    return Bursts{std::move(heard)};
  }};
}

/// What is half there when the client closes is carried out, zeros for the rest.
Behaviour completes_at_the_end() {
  auto streams = std::make_shared<std::map<LinkId, Bytes>>();
  return {.hear = [streams](Burst heard, Server&) {
    Bytes& stream = (*streams)[heard.link];
    if (is_data(heard)) {
      stream.insert(stream.end(), heard.bytes.begin(), heard.bytes.end());
      broken::take_whole(stream, whole);
      return Bursts{std::move(heard)};
    }
    Bursts all;
    if (heard.event == LinkEvent::closed && stream.size() > function_at) {
      Bytes rest(unit_at + word_at(stream, length_at) - stream.size());
      all.push_back({.bytes = std::move(rest), .start = heard.start, .link = heard.link});
    }
    all.push_back(std::move(heard));
    return all;
  }};
}

}  // namespace

std::vector<Fault> stream_faults() {
  return {
      {"second_frame_lost", "of one segment the first frame alone is answered",
       hears_segment([](Bytes segment) {
         const std::size_t first = whole(segment, 1);
         if (first > 0) segment.resize(first);
         return segment;
       }),
       "modbus_tcp/segments/two_in_one", "no answer"},
      {"first_frame_lost", "of one segment the last frame alone is answered",
       hears_segment(last_frame), "modbus_tcp/segments/two_in_one", "transaction"},
      {"ten_frames_are_four", "of one segment four frames are answered",
       hears_segment([](Bytes segment) {
         const std::size_t four = whole(segment, 4);
         if (four > 0) segment.resize(four);
         return segment;
       }),
       "modbus_tcp/segments/ten_in_one", "no answer"},
      {"answers_in_reverse", "requests of one segment are answered from the last to the first",
       acts([](Bursts& does, Server&) { std::ranges::reverse(does); }),
       "modbus_tcp/segments/two_in_one", "transaction"},
      {"error_ends_the_segment", "what follows a bad request in its segment is lost",
       acts([](Bursts& does, Server&) {
         const auto bad =
             std::ranges::find_if(does, [](const Burst& one) { return is_exception(one.bytes); });
         if (bad != does.end()) does.erase(bad + 1, does.end());
       }),
       "modbus_tcp/segments/error_between", "no answer"},
      {"segment_must_be_whole", "a segment that ends within a frame is dropped",
       hears_segment([](Bytes segment) {
         segment.resize(whole(segment));
         return segment;
       }),
       "modbus_tcp/segments/split/b8", "no answer"},
      {"header_must_be_whole", "a segment without a whole header is dropped",
       hears_segment(
           [](Bytes segment) { return segment.size() < function_at ? Bytes{} : segment; }),
       "modbus_tcp/segments/split/b3", "no answer"},
      {"next_frame_cut", "the begin of the next frame is dropped with the end of a segment",
       hears_segment([](Bytes segment) {
         if (const std::size_t size = whole(segment); size > 0) segment.resize(size);
         return segment;
       }),
       "modbus_tcp/segments/one_and_a_part/b5", "no answer"},
      {"answered_too_soon", "a request is carried out before its last segment has come",
       answers_too_soon, "modbus_tcp/segments/half_does_not_block", "silence"},
      {"split_write_too_soon", "a write is carried out before its last segment has come",
       answers_too_soon, "modbus_tcp/segments/split_write/b13", ""},
      {"slow_requests_forgotten", "a half request is forgotten after 10 ms",
       [] { return forgets_after(10ms); }, "modbus_tcp/segments/five_segments", "no answer"},
      {"streams_mixed", "all connections are one stream", one_stream,
       "modbus_tcp/connections/byte_by_byte", ""},
      {"half_request_blocks", "a half request of one connection spoils those of others", one_stream,
       "modbus_tcp/segments/half_does_not_block", ""},
      {"half_survives_rst", "the next connection goes on with a half request after RST",
       [] { return half_stays(LinkEvent::reset); }, "modbus_tcp/connections/reset_in_mid_frame/b6",
       ""},
      {"half_survives_fin", "the next connection goes on with a half request after FIN",
       [] { return half_stays(LinkEvent::closed); }, "modbus_tcp/connections/fin_in_mid_frame/b11",
       ""},
      {"half_write_done_at_fin", "FIN completes a half request with zeros", completes_at_the_end,
       "modbus_tcp/segments/half_then_fin/write", ""},
  };
}

}  // namespace fieldproof::modbus_tcp_broken
