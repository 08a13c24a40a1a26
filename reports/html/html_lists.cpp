#include "reports/html/html_lists.hpp"

#include <fmt/format.h>

namespace fieldproof::html {

void write_head_row(HtmlWriter& out, std::initializer_list<const char*> heads) {
  out.element("thead", {}, [&] {
    out.element("tr", {}, [&] {
      for (const char* head : heads) out.element("th", {}, head);
    });
  });
}

void write_readings(HtmlWriter& out, const HtmlSurvey& survey) {
  out.element("h2", {{"id", "readings"}}, "Readings taken");
  if (survey.readings.empty()) {
    out.element("p", {}, "No case met a place where the manuals leave two readings.");
    return;
  }
  out.element("p", {},
              "Where the manuals can be read in more than one way, the device did this. A device "
              "that mixes readings is NON-STRICT.");
  out.element("table", {{"class", "list"}}, [&] {
    write_head_row(out, {"reading", "taken", "cases", "first seen in"});
    out.element("tbody", {}, [&] {
      for (const auto& [name, taken] : survey.readings) {
        for (const auto& [choice, reading] : taken) {
          out.element("tr", {}, [&] {
            out.element("th", {}, name);
            out.element("td", {}, choice + (taken.size() > 1 ? " (mixed)" : ""));
            out.element("td", {{"class", "num"}}, std::to_string(reading.cases));
            out.element("td", {}, [&] {
              out.text(reading.clause + ": " + reading.title);
              out.element("small", {}, reading.example);
            });
          });
        }
      }
    });
  });
}

void write_errata(HtmlWriter& out, const HtmlSurvey& survey) {
  if (survey.errata.empty()) return;
  out.element("h2", {{"id", "errata"}}, "Errata of the manuals met");
  out.element("p", {}, "Cases judged by what is right, where the manual prints what cannot be.");
  out.element("table", {{"class", "list errata"}}, [&] {
    write_head_row(out, {"manual", "printed", "right, and why", "cases"});
    out.element("tbody", {}, [&] {
      for (const auto& [erratum, tally] : survey.errata) {
        out.element("tr", {}, [&] {
          out.element("th", {}, [&] {
            std::string places;
            for (const results::Passage& one : erratum.places)
              places +=
                  fmt::format("{}{}, {}", places.empty() ? "" : "; ", one.manual, one.section);
            out.text(places);
            out.element("small", {}, fmt::format("{}: {}", erratum.id, erratum.kind));
          });
          out.element("td", {}, [&] { out.element("code", {}, erratum.printed); });
          out.element("td", {}, [&] {
            out.element("code", {}, erratum.right);
            out.element("small", {}, erratum.why);
            if (!erratum.doubt.empty()) out.element("small", {}, erratum.doubt);
          });
          out.element("td", {}, text::to_string(tally));
        });
      }
    });
  });
}

void write_hashes(HtmlWriter& out, const HtmlSurvey& survey) {
  out.element("h2", {}, "What this report speaks of");
  out.element("table", {{"class", "facts wide"}}, [&] {
    const auto row = [&](std::string_view name, const std::string& hash) {
      out.element("tr", {}, [&] {
        out.element("th", {}, name);
        out.element("td", {}, [&] { out.element("code", {}, hash); });
      });
    };
    for (const auto& [name, hash] : survey.log.run.hashes) row("SHA-256 of " + name, hash);
    row("SHA-256 of the log", survey.log.sha256);
    row("command", survey.log.run.command);
  });
}

}  // namespace fieldproof::html
