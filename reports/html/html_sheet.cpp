#include "reports/html/html_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "reports/html/html_page.hpp"

namespace fieldproof::html {
namespace {

constexpr std::size_t reason_limit = 200;

void write_head_row(HtmlWriter& out, std::initializer_list<const char*> heads) {
  out.element("thead", {}, [&] {
    out.element("tr", {}, [&] {
      for (const char* head : heads) out.element("th", {}, head);
    });
  });
}

std::string joined(const std::vector<std::string>& ids, std::size_t total) {
  std::string text;
  for (const std::string& id : ids) text += (text.empty() ? "" : ", ") + id;
  return total > ids.size() ? fmt::format("{}, and {} more", text, total - ids.size()) : text;
}

std::string value_or(const std::map<std::string, std::string>& map, const std::string& key,
                     const char* otherwise) {
  const auto found = map.find(key);
  return found == map.end() ? otherwise : found->second;
}

}  // namespace

void write_unexecuted(HtmlWriter& out, const HtmlSurvey& survey) {
  out.element("h2", {{"id", "unexecuted"}}, "Not judged, and why");
  if (survey.unexecuted.empty()) {
    out.element("p", {}, "Every selected case was executed and judged.");
    return;
  }
  std::vector<const decltype(survey.unexecuted)::value_type*> reasons;
  for (const auto& one : survey.unexecuted) reasons.push_back(&one);
  std::ranges::stable_sort(
      reasons, [](const auto* a, const auto* b) { return a->second.cases > b->second.cases; });
  out.element("table", {{"class", "list"}}, [&] {
    write_head_row(out, {"verdict", "cases", "reason"});
    out.element("tbody", {}, [&] {
      for (const auto* one : std::span(reasons).first(std::min(reasons.size(), reason_limit))) {
        out.element("tr", {}, [&] {
          out.element("td", {}, [&] { write_verdict(out, one->first.first); });
          out.element("td", {{"class", "num"}}, std::to_string(one->second.cases));
          out.element("td", {}, [&] {
            out.element("details", {}, [&] {
              out.element(
                  "summary", {},
                  one->first.second.empty() ? "no reason given" : one->first.second.substr(0, 500));
              out.element("p", {{"class", "ids"}}, joined(one->second.ids, one->second.cases));
            });
          });
        });
      }
    });
  });
  if (reasons.size() > reason_limit)
    out.element("p", {}, fmt::format("... {} more reasons", reasons.size() - reason_limit));
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
  out.element("h2", {{"id", "hashes"}}, "What this report speaks of");
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

void write_fingerprint(HtmlWriter& out, const results::Identity& identity) {
  out.element("h2", {}, identity.name.empty() ? "Fingerprint" : "Fingerprint of " + identity.name);
  if (identity.fingerprint.empty() && identity.fingerprint_found.empty()) {
    out.element(
        "p", {},
        "None was declared and none was read: the identity above is as the engineer entered it.");
    return;
  }
  std::map<std::string, std::string> keys = identity.fingerprint;
  keys.insert(identity.fingerprint_found.begin(), identity.fingerprint_found.end());
  out.element("table", {{"class", "list"}}, [&] {
    write_head_row(out, {"", "declared", "found"});
    out.element("tbody", {}, [&] {
      for (const auto& [key, any] : keys) {
        const std::string declared = value_or(identity.fingerprint, key, "not declared");
        const std::string found = value_or(identity.fingerprint_found, key, "not read");
        out.element("tr", {}, [&] {
          out.element("th", {}, key);
          out.element("td", {}, declared);
          out.element("td", {},
                      !identity.fingerprint.contains(key) || declared == found
                          ? found
                          : found + " (differs)");
        });
      }
    });
  });
}

void write_signatures(HtmlWriter& out) {
  out.element("div", {{"class", "signatures"}}, [&] {
    for (const char* role : {"Tested by", "Approved by"}) {
      out.element("div", {}, [&] {
        out.element("b", {}, role);
        for (const char* field : {"Name", "Date", "Signature"}) out.element("p", {}, field);
      });
    }
  });
}

}  // namespace fieldproof::html
