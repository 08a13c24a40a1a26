#include "reports/compare/compare_junit.hpp"

#include <fmt/format.h>

#include <pugixml.hpp>
#include <set>

#include "reports/compare/compare_text.hpp"
#include "reports/junit.hpp"
#include "reports/text/report_file.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::compare {
namespace {

void set_text(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(text::xml_line(value).c_str());
}
void set_count(pugi::xml_node node, const char* name, std::size_t value) {
  node.append_attribute(name).set_value(static_cast<unsigned long long>(value));
}

bool is_incomparable(Change change) {
  return change == Change::added || change == Change::removed || change == Change::revised;
}

std::string body_of(const CaseChange& change) {
  std::string body = fmt::format("{}: {}\n", to_string(change.change), meaning(change.change));
  const auto side = [&](const char* name, const CaseSummary* summary) {
    if (!summary) return;
    body += fmt::format("{}  {}{}{}\n", name, verdict_text(summary),
                        summary->message.empty() ? "" : "  ", text::xml_text(summary->message));
  };
  side("before", change.before);
  side("after ", change.after);
  return body;
}

/// Class names begin with the suite's name: a case stands in each suite, and readers want it
/// unique.
pugi::xml_node add_case(pugi::xml_node suite, const std::string& id,
                        const std::string& suffix = "") {
  results::CaseResult named;
  named.id = id;
  const reports::JunitName name = reports::junit_name(named);
  pugi::xml_node node = suite.append_child("testcase");
  set_text(
      node, "classname",
      suite.attribute("name").value() + name.classname.substr(std::string("fieldproof").size()));
  set_text(node, "name", name.name + suffix);
  set_text(node, "time", "0.000");
  return node;
}

void add_change(pugi::xml_node suite, const CaseChange& change) {
  pugi::xml_node node = add_case(suite, change.id);
  const bool worse = got_worse(change.change);
  if (worse || is_incomparable(change.change)) {
    pugi::xml_node outcome = node.append_child(worse ? "failure" : "skipped");
    set_text(outcome, "type", to_string(change.change));
    set_text(outcome, "message",
             fmt::format("{}: {} -> {}", to_string(change.change), verdict_text(change.before),
                         verdict_text(change.after)));
    if (worse) outcome.text().set(text::xml_text(body_of(change)).c_str());
  }
  if (!worse) node.append_child("system-out").text().set(text::xml_text(body_of(change)).c_str());
}

void add_shift(pugi::xml_node suite, const TimeShift& shift, const TimingTest& timing) {
  pugi::xml_node node = add_case(suite, shift.id, " (reply time)");
  const std::string body = fmt::format("{}\n{}\n", shift_text(shift), describe(timing));
  if (shift.shift_ms < 0) {
    node.append_child("system-out").text().set(("faster: " + body).c_str());
    return;
  }
  pugi::xml_node failure = node.append_child("failure");
  set_text(failure, "type", "slower");
  set_text(failure, "message", "slower: " + shift_text(shift));
  failure.text().set(body.c_str());
}

void add_property(pugi::xml_node properties, const std::string& name, const std::string& value) {
  pugi::xml_node property = properties.append_child("property");
  set_text(property, "name", name);
  set_text(property, "value", value);
}

struct SuiteCounts {
  std::size_t tests = 0, failures = 0;
};

SuiteCounts add_suite(pugi::xml_node root, const Comparison& comparison, const std::string& name) {
  pugi::xml_node suite = root.append_child("testsuite");
  std::size_t failures = comparison.slower(), skipped = 0;
  for (const CaseChange& change : comparison.changes) {
    failures += got_worse(change.change);
    skipped += is_incomparable(change.change);
  }
  set_text(suite, "name", name);
  const SuiteCounts counts{
      comparison.unchanged + comparison.changes.size() + comparison.shifts.size(), failures};
  set_count(suite, "tests", counts.tests);
  set_count(suite, "failures", counts.failures);
  set_count(suite, "errors", 0);
  set_count(suite, "skipped", skipped);
  set_text(suite, "time", "0.000");
  pugi::xml_node properties = suite.append_child("properties");
  add_property(properties, "before",
               comparison.before->path + ": " + run_facts(*comparison.before));
  add_property(properties, "after", comparison.after->path + ": " + run_facts(*comparison.after));
  add_property(properties, "outcome", outcome(comparison));
  for (const CaseChange& change : comparison.changes) add_change(suite, change);
  for (const TimeShift& shift : comparison.shifts) add_shift(suite, shift, comparison.timing);
  std::set<std::string> changed;
  for (const CaseChange& change : comparison.changes) changed.insert(change.id);
  for (const auto& [id, summary] : comparison.before->cases)
    if (!changed.contains(id)) add_case(suite, id);
  return counts;
}

}  // namespace

Status write_compare_junit(const ComparisonSet& set, const std::string& path) {
  auto file = text::ReportFile::create(path);
  if (!file) return file.error();
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("testsuites");
  set_text(root, "name", "fieldproof compare");
  SuiteCounts all;
  for (std::size_t i = 0; i < set.comparisons.size(); ++i) {
    const SuiteCounts counts = add_suite(
        root, set.comparisons[i],
        fmt::format("compare_{}_{}", ComparisonSet::letter(0), ComparisonSet::letter(i + 1)));
    all.tests += counts.tests;
    all.failures += counts.failures;
  }
  set_count(root, "tests", all.tests);
  set_count(root, "failures", all.failures);
  set_count(root, "errors", 0);
  set_text(root, "time", "0.000");
  document.save(file->out(), "  ", pugi::format_default, pugi::encoding_utf8);
  return file->commit();
}

}  // namespace fieldproof::compare
