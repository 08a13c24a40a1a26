#include "reports/html/html_head.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "reports/html/html_page.hpp"
#include "reports/text/run_text.hpp"

namespace fieldproof::html {

using results::Gate;
using text::Tally;

namespace {

/// As the run ended; a killed run is red whatever it had found so far.
int exit_code_of(const HtmlSurvey& survey) {
  constexpr int killed = 130;
  return survey.log.end ? survey.log.end->exit_code : killed;
}

/// The gravest reason up to its details: "conformance failed", "not qualified", "gate met".
std::string title_of(const HtmlSurvey& survey) {
  if (!survey.log.end) return "killed before its end";
  const std::string line = text::headline(*survey.log.end, survey.tally);
  return line.substr(0, line.find_first_of(":;"));
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string duration_text(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long long>(seconds);
  return seconds < 3600 ? fmt::format("{} min {} s", whole / 60, whole % 60)
                        : fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

void write_bar(HtmlWriter& out, const Tally& tally) {
  out.element("div", {{"class", "bar"}, {"role", "img"}, {"aria-label", text::to_string(tally)}},
              [&] {
                for (results::Verdict verdict : Tally::verdicts) {
                  if (tally.of(verdict) == 0) continue;
                  out.element("span",
                              {{"class", verdict_class(verdict)},
                               {"style", fmt::format("flex-grow:{}", tally.of(verdict))}},
                              "");
                }
              });
}

void write_tiles(HtmlWriter& out, const Tally& tally, const Gate& gate) {
  out.element("ul", {{"class", "tiles"}}, [&] {
    for (results::Verdict verdict : Tally::verdicts) {
      if (tally.of(verdict) == 0) continue;
      out.element("li", {{"class", verdict_class(verdict)}}, [&] {
        out.element("b", {{"data-count", results::to_string(verdict)}},
                    std::to_string(tally.of(verdict)));
        write_verdict(out, verdict);
        out.element("small", {}, text::verdict_meaning(verdict) + text::gate_hint(verdict, gate));
      });
    }
  });
}

class Facts {
 public:
  explicit Facts(HtmlWriter& out) : out_(out) {}
  void row(std::string_view name, const std::string& value) {
    if (value.empty()) return;
    out_.element("tr", {}, [&] {
      out_.element("th", {}, name);
      out_.element("td", {}, value);
    });
  }

 private:
  HtmlWriter& out_;
};

void write_device(HtmlWriter& out, const results::RunInfo& run) {
  const results::Identity& device = run.identity;
  Facts facts(out);
  facts.row("maker", device.maker);
  facts.row("model", device.model);
  facts.row("serial number", device.serial);
  facts.row("firmware", device.firmware);
  facts.row("endpoint", run.endpoint);
  facts.row("profile", run.profile);
  for (const char* name : {"device", "protocol", "station", "line"}) {
    if (const auto found = run.properties.find(name); found != run.properties.end())
      facts.row(name, found->second);
  }
  facts.row("bench entry", device.name);
  facts.row("operator", device.operator_name);
  facts.row("notes", device.notes);
}

void write_run(HtmlWriter& out, const HtmlSurvey& survey, const Gate& gate) {
  constexpr std::array<std::string_view, 6> elsewhere{"device", "protocol", "station",
                                                      "line",   "gate",     "response_max_ms"};
  const results::RunInfo& run = survey.log.run;
  Facts facts(out);
  facts.row("date", run.started);
  facts.row("duration", survey.log.end ? duration_text(survey.log.end->seconds)
                                       : "unknown: the run did not end");
  const std::string moved = survey.transposed == 0
                                ? ""
                                : fmt::format(", {} transposed to this device", survey.transposed);
  facts.row("cases", fmt::format("{}{}", survey.tally.total(), moved));
  if (const std::string models = text::on_model_text(survey.tally); !models.empty())
    facts.row("of a model", models);
  facts.row("gate", text::to_string(gate));
  facts.row("fieldproof", run.tool_version);
  facts.row("vectors", run.vectors_hash);
  for (const auto& [name, value] : run.properties) {
    if (std::ranges::find(elsewhere, name) == elsewhere.end()) facts.row(name, value);
  }
}

/// Several devices shared the run.
void write_devices(HtmlWriter& out, const results::RunInfo& run) {
  if (run.duts.empty()) return;
  out.element("h2", {}, "Devices");
  out.element("table", {{"class", "list devices"}}, [&] {
    out.element("tbody", {}, [&] {
      for (const results::DutInfo& dut : run.duts) {
        out.element("tr", {}, [&] {
          out.element("th", {}, dut.identity.name);
          out.element("td", {}, text::device_text(dut));
          out.element("td", {}, dut.identity.notes);
        });
      }
    });
  });
}

}  // namespace

std::string device_title(const results::RunInfo& run) {
  const results::Identity& device = run.identity;
  std::string title = device.maker;
  if (!device.model.empty()) title += (title.empty() ? "" : " ") + device.model;
  if (title.empty()) return run.endpoint;
  return device.firmware.empty() ? title : title + ", firmware " + device.firmware;
}

void write_verdict_of_run(HtmlWriter& out, const HtmlSurvey& survey, const Gate& gate) {
  const int code = exit_code_of(survey);
  const std::string detail =
      survey.log.end ? text::headline(*survey.log.end, survey.tally) : text::early_end(survey.log);
  out.element("header", {{"class", code == 0 ? "banner good" : "banner bad"}}, [&] {
    out.element("p", {{"class", "device"}}, "Conformance of " + device_title(survey.log.run));
    out.element("h1", {}, (code == 0 ? "\u2713 " : "\u2717 ") + capitalised(title_of(survey)));
    out.element("p", {{"class", "detail"}},
                detail + (survey.log.end ? fmt::format(" (exit {})", code) : ""));
  });
  write_bar(out, survey.tally);
  write_tiles(out, survey.tally, gate);
}

void write_facts(HtmlWriter& out, const HtmlSurvey& survey, const Gate& gate) {
  out.element("div", {{"class", "columns"}}, [&] {
    out.element("table", {{"class", "facts"}}, [&] { write_device(out, survey.log.run); });
    out.element("table", {{"class", "facts"}}, [&] { write_run(out, survey, gate); });
  });
  write_devices(out, survey.log.run);
}

void write_legend(HtmlWriter& out, const Gate& gate) {
  out.element("h2", {{"id", "legend"}}, "Verdicts");
  out.element("ul", {{"class", "legend"}}, [&] {
    for (results::Verdict verdict : Tally::verdicts) {
      out.element("li", {}, [&] {
        write_verdict(out, verdict);
        out.text(" " + text::verdict_meaning(verdict) +
                 (results::gates(verdict, gate) ? "; turns this gate red"
                                                : text::gate_hint(verdict, gate)));
      });
    }
  });
}

}  // namespace fieldproof::html
