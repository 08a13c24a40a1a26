#include "reports/html/html_monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "reports/html/html_case.hpp"
#include "reports/text/case_text.hpp"
#include "reports/text/frame_cells.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::html {

using results::CaseResult;
using results::Event;
using text::FrameCells;

std::string more_bytes(std::size_t count) { return fmt::format("... {} more bytes", count); }

Direction direction(Event::Kind kind) {
  switch (kind) {
    case Event::Kind::sent: return {"\u2192", "sent"};
    case Event::Kind::received: return {"\u2190", "received"};
    case Event::Kind::opened: return {"\u25CB", "opened"};
    case Event::Kind::closed: return {"\u25CF", "closed"};
    case Event::Kind::reset: return {"\u25CF", "reset"};
    case Event::Kind::note: break;
  }
  return {"\u00B7", "note"};
}

namespace {

constexpr text::CaseTextOptions frame_limits{.limit = block_frame_limit};

/// Bytes of a frame: how many there are, of which cells show the first.
struct Whole {
  std::size_t total = 0;
  const results::Extract* extract = nullptr;  // nullptr: all are kept
};

Whole whole(std::size_t total, const results::Extract& extract) {
  return extract.empty() ? Whole{total} : Whole{total, &extract};
}

/// Hex, the bytes that differ marked. `cells` are the first.
void write_cells(HtmlWriter& out, const FrameCells& cells, const Whole& of) {
  const std::size_t shown = std::min(cells.size(), block_frame_limit);
  std::string plain;
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) plain += ' ';
    if (!cells[i].marked) {
      plain += cells[i].text;
      continue;
    }
    out.text(plain);
    plain.clear();
    out.element("mark", {}, cells[i].text);
  }
  out.text(plain);
  if (shown < of.total) out.element("em", {}, " " + more_bytes(of.total - shown));
  if (!of.extract) return;
  const results::Extract& extract = *of.extract;
  out.element(
      "em", {},
      fmt::format(" ... {} bytes left out ... ", text::grouped(extract.left_out(of.total))));
  out.text(to_hex(extract.tail));
  out.element(
      "em", {},
      fmt::format(" {} bytes in all, sha256 {}", text::grouped(extract.count), extract.sha256));
}

void write_frame(HtmlWriter& out, const std::string& notation, const FrameCells& cells,
                 const Whole& of) {
  out.element("td", {}, [&] {
    if (!notation.empty())
      out.element("code", {{"class", "notation"}}, text::shorten(notation, frame_limits));
    if (!cells.empty())
      out.element("code", {{"class", "hex"}}, [&] { write_cells(out, cells, of); });
  });
}

/// The rows of a frame monitor, with what was expected above what was judged.
class Monitor {
 public:
  Monitor(HtmlWriter& out, const CaseResult& result) : out_(out), result_(result) {
    if (text::has_judged_frames(result)) judged_ = text::judged_frames(result);
  }

  void write() {
    if (result_.exchange.empty() && !judged_) return;
    out_.element("table", {{"class", "monitor"}}, [&] {
      out_.element("thead", {}, [&] {
        out_.element("tr", {}, [&] {
          for (const char* head : {"time ms", "gap ms", "", "frame"}) out_.element("th", {}, head);
        });
      });
      out_.element("tbody", {}, [&] { write_rows(); });
    });
  }

 private:
  void write_rows() {
    const Event* answer = nullptr;  // the last that is the judged one
    for (const Event& event : result_.exchange) {
      if (event.kind == Event::Kind::received && !event.bytes.empty() &&
          event.bytes == result_.received_bytes && event.extract == result_.received_extract)
        answer = &event;
    }
    for (const Event& event : result_.exchange) {
      if (&event == answer) write_expected();
      write_event(event, &event == answer);
    }
    if (answer != nullptr || !judged_) return;
    write_expected();
    row("judged", {}, "", {"\u2190", "received"},
        result_.received.empty() ? "nothing" : result_.received, judged_->received,
        whole(judged_->received.size(), result_.received_extract));
  }

  void write_expected() {
    if (!judged_) return;
    const FrameCells cells = judged_->expected.value_or(FrameCells{});
    row("expected", {}, "", {"", "expected"}, result_.expected, cells, {cells.size()});
  }

  void write_event(const Event& event, bool judged) {
    const bool is_frame = event.kind != Event::Kind::note;
    const std::string gap =
        is_frame && last_end_ ? fmt::format("{:.3f}", to_ms(event.start - *last_end_)) : "";
    // A large frame need not become a large table of cells before it is cut.
    const ByteView shown =
        ByteView(event.bytes).first(std::min(event.bytes.size(), block_frame_limit));
    row(judged ? "judged" : direction(event.kind).word, event.start - results::shown_from(result_),
        gap, direction(event.kind), event.text,
        judged && judged_ ? judged_->received : text::cells_of(shown),
        whole(event.bytes.size(), event.extract));
    if (is_frame) last_end_ = event.end;
  }

  void row(std::string_view css, std::optional<Time> time, const std::string& gap, Direction way,
           const std::string& notation, const FrameCells& cells, const Whole& of) {
    out_.element("tr", {{"class", css}}, [&] {
      out_.element("td", {{"class", "num"}}, time ? fmt::format("{:.3f}", to_ms(*time)) : "");
      out_.element("td", {{"class", "num"}}, gap);
      out_.element("td", {{"class", "way"}, {"title", way.word}},
                   *way.arrow != '\0' ? way.arrow : way.word);
      write_frame(out_, notation, cells, of);
    });
  }

  HtmlWriter& out_;
  const CaseResult& result_;
  std::optional<text::JudgedFrames> judged_;
  std::optional<Time> last_end_;
};

}  // namespace

void write_monitor(HtmlWriter& out, const CaseResult& result) { Monitor(out, result).write(); }

}  // namespace fieldproof::html
