#include "reports/html/html_case.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/html/html_monitor.hpp"
#include "reports/html/html_page.hpp"
#include "reports/html/html_trace.hpp"
#include "reports/html/html_wire.hpp"
#include "reports/text/case_text.hpp"

namespace fieldproof::html {

using results::CaseResult;
using results::Event;

namespace {

constexpr text::CaseTextOptions limits{.limit = block_frame_limit};

void write_clause(HtmlWriter& out, const CaseResult& result, const std::string& section_title) {
  out.element("p", {{"class", "clause"}}, [&] {
    out.element(
        "b", {},
        fmt::format("{}{}{}", result.manual, result.section.empty() ? "" : ", ", result.section));
    if (!section_title.empty()) out.element("span", {{"class", "of"}}, section_title);
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

/// Of what is not on a wire.
void write_kind(HtmlWriter& out, const CaseResult& result) {
  if (!result.on_model.empty())
    out.element("small", {{"class", "kind"}}, result.on_model + ", on a model");
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
      write_kind(out, result);
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
    out.element("td", {}, [&] {
      write_kind(out, result);
      out.text(text::shorten(result.message, {.limit = line_bytes_limit}));
    });
  });
}

void write_case_block(HtmlWriter& out, const CaseResult& result, const CaseBlock& block) {
  const auto body = [&] {
    out.element("summary", {}, [&] {
      write_verdict(out, result.verdict);
      out.markup(" ");
      out.element("b", {}, text::case_label(result));
      if (!result.message.empty())
        out.element("span", {{"class", "message"}}, text::shorten(result.message, limits));
    });
    out.element("p", {{"class", "title"}}, text::shorten(result.title, limits));
    write_clause(out, result, block.section_title);
    write_differences(out, result);
    write_trace(out, result);
    if (block.wire)  // the style shows one of them
      for (const WireOn on : {WireOn::window, WireOn::telephone}) write_wire(out, result, on);
    write_monitor(out, result);
    write_remarks(out, result);
  };
  // XHTML wants a value for every attribute; a closed block has no `open` at all.
  const std::string css = "case " + verdict_class(result.verdict);
  if (block.open)
    out.element("details", {{"class", css}, {"id", block.id}, {"open", "open"}}, body);
  else if (!block.id.empty())
    out.element("details", {{"class", css}, {"id", block.id}}, body);
  else
    out.element("details", {{"class", css}}, body);
  out.markup("\n");
}

}  // namespace fieldproof::html
