#include "reports/html/html_wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "reports/html/html_time_axis.hpp"

namespace fieldproof::html {

using results::CaseResult;
using results::Event;

namespace {

constexpr double wire_height = 124;
constexpr double bench_lane = 26, device_lane = 62, bar = 20, axis = 96;
constexpr double tick_room = 52;
constexpr std::size_t most_frames = 24;

/// What the picture measures across.
struct Size {
  double left, right, width;
  const char* css;
};
constexpr Size of_window{62, 748, 760, "wire"}, of_telephone{44, 340, 350, "wire narrow"};

std::string pixels(double value) { return fmt::format("{:.1f}", value); }
std::string in_ms(Duration time) { return fmt::format("{:.3f}", to_ms(time)); }

bool is_frame(const Event& event) {
  return event.kind == Event::Kind::sent || event.kind == Event::Kind::received;
}

/// A frame, or what became of a connection.
bool is_drawn(const Event& event) { return event.kind != Event::Kind::note; }

bool is_judged(const Event& event, const CaseResult& result) {
  return event.kind == Event::Kind::received && !event.bytes.empty() &&
         event.bytes == result.received_bytes && event.extract == result.received_extract;
}

/// Those up to the judged one and some behind it, where there are too many.
std::vector<const Event*> shown_frames(const CaseResult& result) {
  std::vector<const Event*> frames;
  std::size_t judged = 0;
  for (const Event& event : result.exchange) {
    if (!is_drawn(event)) continue;
    if (is_judged(event, result)) judged = frames.size();
    frames.push_back(&event);
  }
  if (frames.size() <= most_frames) return frames;
  const std::size_t last = std::min(frames.size(), std::max(judged + 3, most_frames));
  return {frames.begin() + static_cast<std::ptrdiff_t>(last - most_frames),
          frames.begin() + static_cast<std::ptrdiff_t>(last)};
}

class Wire {
 public:
  Wire(HtmlWriter& out, const CaseResult& result, const Size& size)
      : out_(out),
        result_(result),
        size_(size),
        frames_(shown_frames(result)),
        axis_(frames_, result.due, size.left, size.right) {}

  void write() {
    if (frames_.empty()) return;
    out_.element("figure", {{"class", size_.css}}, [&] {
      out_.picture(fmt::format("{} {}", size_.width, wire_height), "the exchange on a time axis",
                   [&] { write_picture(); });
    });
  }

 private:
  void write_picture() {
    write_due();
    for (const auto& [name, y] :
         {std::pair{"bench", bench_lane}, std::pair{"device", device_lane}}) {
      label("lane", 0, y + 14, name);
      line("rail", size_.left, y + bar, size_.right, y + bar);
    }
    for (const double x : axis_.cuts()) label("cut", x, axis + 4, "\u2248");
    for (const Event* event : frames_) is_frame(*event) ? write_bar(*event) : write_link(*event);
    write_silences();
    write_ticks();
  }

  void write_due() {
    const results::Due& due = result_.due;
    if (due.empty()) return;
    const double from = axis_.x(due.from), until = axis_.x(due.until);
    out_.empty("rect", {{"class", "due"},
                        {"x", pixels(from)},
                        {"y", "16"},
                        {"width", pixels(until - from)},
                        {"height", pixels(axis - 16)}});
    line("limit", until, 16, until, axis);
    const bool is_late = until > size_.width / 2;
    out_.element("text",
                 {{"class", "limit-text"},
                  {"x", pixels(until)},
                  {"y", "11"},
                  {"text-anchor", is_late ? "end" : "start"}},
                 fmt::format("answer due within {:g} ms", to_ms(due.until - due.from)));
  }

  void write_bar(const Event& frame) {
    const bool sent = frame.kind == Event::Kind::sent;
    const double x = axis_.x(frame.start), wide = std::max(axis_.x(frame.end) - x, 3.0);
    const char* css = sent                        ? "bar sent"
                      : is_judged(frame, result_) ? "bar judged"
                      : frame.surplus             ? "bar surplus"
                                                  : "bar received";
    const std::size_t bytes =
        frame.extract.empty() ? frame.bytes.size() : static_cast<std::size_t>(frame.extract.count);
    out_.element("rect",
                 {{"class", css},
                  {"x", pixels(x)},
                  {"y", pixels(sent ? bench_lane : device_lane)},
                  {"width", pixels(wide)},
                  {"height", pixels(bar)}},
                 [&] {
                   out_.element("title", {},
                                fmt::format("{} bytes, {} to {} ms", bytes,
                                            in_ms(since(frame.start)), in_ms(since(frame.end))));
                 });
  }

  void write_link(const Event& event) {
    const char* css = event.kind == Event::Kind::opened ? "link opened" : "link ended";
    out_.element(
        "circle",
        {{"class", css},
         {"cx", pixels(axis_.x(event.start))},
         {"cy", pixels((event.by_device ? device_lane : bench_lane) + bar)},
         {"r", "4"}},
        [&] {
          out_.element(
              "title", {},
              fmt::format("{} {} by the {}, {} ms", event.link, results::to_string(event.kind),
                          event.by_device ? "device" : "bench", in_ms(since(event.start))));
        });
  }

  /// Between one frame and the next, above the rail of the one that ends it.
  void write_silences() {
    double free_from = 0;
    for (std::size_t i = 1; i < frames_.size(); ++i) {
      const Event &before = *frames_[i - 1], &after = *frames_[i];
      const Duration silence = after.start - before.end;
      const double middle = (axis_.x(before.end) + axis_.x(after.start)) / 2;
      if (silence <= 0ns || middle < free_from) continue;
      const bool same = before.kind == after.kind && after.kind == Event::Kind::received;
      const bool too_long = same && result_.recording.max_gap > 0ns &&
                            silence > result_.recording.max_gap && before.step == after.step;
      label(too_long ? "silence over" : "silence", middle, device_lane - 5, in_ms(silence));
      free_from = middle + tick_room;
    }
  }

  void write_ticks() {
    line("rail", size_.left, axis, size_.right, axis);
    std::set<Time> moments;
    for (const Event* frame : frames_) moments.insert(frame->start);
    if (!result_.due.empty()) moments.insert(result_.due.until);
    double free_from = 0;
    for (const Time moment : moments) {
      const double x = axis_.x(moment);
      line("rail", x, axis - 3, x, axis + 3);
      if (x < free_from) continue;
      label(x > size_.right - tick_room / 2 ? "tick last" : "tick", x, axis + 16,
            in_ms(since(moment)));
      free_from = x + tick_room;
    }
    label("unit", size_.right, wire_height - 1, "ms, silences cut at \u2248");
  }

  Duration since(Time moment) const { return moment - results::shown_from(result_); }

  void label(std::string_view css, double x, double y, std::string_view text) {
    out_.element("text", {{"class", css}, {"x", pixels(x)}, {"y", pixels(y)}}, text);
  }
  void line(std::string_view css, double x1, double y1, double x2, double y2) {
    out_.empty("path", {{"class", css},
                        {"d", fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x1, y1, x2, y2)}});
  }

  HtmlWriter& out_;
  const CaseResult& result_;
  const Size& size_;
  std::vector<const Event*> frames_;
  TimeAxis axis_;
};

}  // namespace

void write_wire(HtmlWriter& out, const CaseResult& result, WireOn on) {
  Wire(out, result, on == WireOn::window ? of_window : of_telephone).write();
}

}  // namespace fieldproof::html
