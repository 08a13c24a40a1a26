#include "reports/html/html_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "reports/html/html_page.hpp"
#include "reports/html/html_trace.hpp"
#include "reports/text/case_text.hpp"
#include "reports/text/frame_cells.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::html {

using results::CaseResult;
using results::Event;
using text::FrameCells;

namespace {

constexpr text::CaseTextOptions limits{.limit = block_frame_limit};

std::string more_bytes(std::size_t count) { return fmt::format("... {} more bytes", count); }

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
      out.element("code", {{"class", "notation"}}, text::shorten(notation, limits));
    if (!cells.empty())
      out.element("code", {{"class", "hex"}}, [&] { write_cells(out, cells, of); });
  });
}

struct Direction {
  const char* arrow;
  const char* word;
};
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

void write_clause(HtmlWriter& out, const CaseResult& result) {
  out.element("p", {{"class", "clause"}}, [&] {
    out.element(
        "b", {},
        fmt::format("{}{}{}", result.manual, result.section.empty() ? "" : ", ", result.section));
    if (!result.level.empty()) out.text(fmt::format(" ({}, {})", result.level, result.basis));
    if (!result.on_model.empty())
      out.text(fmt::format(" {} of a model, not on a wire", result.on_model));
    if (!result.quote.empty()) out.element("q", {}, text::shorten(result.quote, limits));
  });
}

void write_differences(HtmlWriter& out, const CaseResult& result) {
  if (result.differences.empty()) return;
  out.element("table", {{"class", "differences"}}, [&] {
    out.element("thead", {}, [&] {
      out.element("tr", {}, [&] {
        for (const char* head : {"field", "expected", "received", ""}) out.element("th", {}, head);
      });
    });
    out.element("tbody", {}, [&] {
      for (const results::Difference& one : result.differences) {
        out.element("tr", {}, [&] {
          for (const std::string* text : {&one.field, &one.expected, &one.received, &one.hint})
            out.element("td", {}, text::shorten(*text, limits));
        });
      }
    });
  });
}

void write_remarks(HtmlWriter& out, const CaseResult& result) {
  out.element("ul", {{"class", "remarks"}}, [&] {
    const auto item = [&](std::string_view name, const std::string& text) {
      if (text.empty()) return;
      out.element("li", {}, [&] {
        out.element("b", {}, name);
        out.text(" " + text::shorten(text, limits));
      });
    };
    item("device", result.dut);
    item("timing", text::case_timing(result));
    for (const auto& [name, taken] : result.readings) item("reading", name + " = " + taken);
    for (const std::string& note : result.notes) item("note", note);
    out.element("li", {}, [&] {
      out.text(
          fmt::format("{} revision {}, {:.3f} s", result.protocol, result.rev, result.seconds));
    });
  });
  if (!result.replay.empty())
    out.element("pre", {{"class", "replay"}}, text::shorten(result.replay, limits));
}

}  // namespace

void write_pass_line(HtmlWriter& out, const CaseResult& result, bool pictures) {
  out.element("tr", {}, [&] {
    out.element("th", {{"title", text::shorten(result.title, {.limit = line_bytes_limit})}},
                text::case_label(result));
    out.element("td", {}, [&] {
      std::size_t left = line_bytes_limit, hidden = 0;
      std::string line;
      for (const Event& event : result.exchange) {
        if (event.kind == Event::Kind::note) continue;
        const ByteView shown = ByteView(event.bytes).first(std::min(event.bytes.size(), left));
        if (!shown.empty())
          line += fmt::format("{}{} {}", line.empty() ? "" : " ", direction(event.kind).arrow,
                              to_hex(shown));
        left -= shown.size();
        const std::size_t all = event.extract.empty() ? event.bytes.size() : event.extract.count;
        hidden += all - shown.size();
      }
      out.text(line);
      if (hidden > 0) out.element("em", {}, " " + more_bytes(hidden));
      if (!result.dut.empty()) out.element("small", {{"class", "dut"}}, result.dut);
      for (const std::string& note : result.notes)
        out.element("small", {}, text::shorten(note, {.limit = line_bytes_limit}));
      if (pictures && !result.trace.empty())
        out.element("details", {}, [&] {
          out.element("summary", {}, result.trace.axes.empty() ? "token" : "motion");
          write_trace(out, result);
        });
    });
    const auto& times = result.response_ms;
    out.element(
        "td", {},
        times.empty() ? "" : fmt::format("{:.3f}", *std::max_element(times.begin(), times.end())));
  });
}

void write_case_line(HtmlWriter& out, const CaseResult& result, const std::string& link) {
  out.element("tr", {}, [&] {
    out.element("td", {}, [&] { write_verdict(out, result.verdict); });
    out.element("th", {}, [&] {
      if (link.empty())
        out.text(text::case_label(result));
      else
        out.element("a", {{"href", "#" + link}}, text::case_label(result));
    });
    out.element("td", {}, text::shorten(result.message, {.limit = line_bytes_limit}));
  });
}

void write_case_block(HtmlWriter& out, const CaseResult& result, bool open, const std::string& id) {
  const auto body = [&] {
    out.element("summary", {}, [&] {
      write_verdict(out, result.verdict);
      out.markup(" ");
      out.element("b", {}, text::case_label(result));
      if (!result.message.empty())
        out.element("span", {{"class", "message"}}, text::shorten(result.message, limits));
    });
    out.element("p", {{"class", "title"}}, text::shorten(result.title, limits));
    write_clause(out, result);
    write_differences(out, result);
    write_trace(out, result);
    Monitor(out, result).write();
    write_remarks(out, result);
  };
  // XHTML wants a value for every attribute; a closed block has no `open` at all.
  const std::string css = "case " + verdict_class(result.verdict);
  if (open)
    out.element("details", {{"class", css}, {"id", id}, {"open", "open"}}, body);
  else if (!id.empty())
    out.element("details", {{"class", css}, {"id", id}}, body);
  else
    out.element("details", {{"class", css}}, body);
  out.markup("\n");
}

}  // namespace fieldproof::html
