#include "reports/compare/compare_junit.hpp"

#include <fmt/format.h>

#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "reports/compare/compare_text.hpp"
#include "reports/junit.hpp"
#include "reports/text/report_file.hpp"
#include "reports/text/xml_text.hpp"
#include "reports/text/xml_writer.hpp"

namespace fieldproof::compare {

using results::Verdict;
using text::XmlWriter;

namespace {

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

enum class Outcome { plain, failure, skipped };

bool is_unjudged(const CaseSummary& one) {
  return one.verdict == Verdict::skip || one.verdict == Verdict::blocked ||
         one.verdict == Verdict::inconclusive;
}

/// What was not judged now is no success, changed or not.
Outcome outcome_of(Change change, const CaseSummary* after) {
  if (got_worse(change)) return Outcome::failure;
  return is_incomparable(change) || !after || is_unjudged(*after) ? Outcome::skipped
                                                                  : Outcome::plain;
}

/// One suite: the cases of one comparison, written as they are counted.
class Suite {
 public:
  explicit Suite(std::string name) : name_(std::move(name)) { xml_.depth = 2; }

  void add(const CaseChange& change) {
    const std::string message =
        fmt::format("{}: {} -> {}", to_string(change.change), verdict_text(change.before),
                    verdict_text(change.after));
    add_case(change.id, "", outcome_of(change.change, change.after), to_string(change.change),
             message, body_of(change));
  }

  void add(const TimeShift& shift, const TimingTest& timing) {
    const bool slower = shift.shift_ms >= 0;
    const std::string what = slower ? "slower" : "faster";
    const std::string body = fmt::format("{}\n{}\n", shift_text(shift), describe(timing));
    add_case(shift.id, " (reply time)", slower ? Outcome::failure : Outcome::plain, what,
             what + ": " + shift_text(shift), slower ? body : what + ": " + body);
  }

  void add_unchanged(const std::string& id, const CaseSummary& both) {
    add_case(id, "", is_unjudged(both) ? Outcome::skipped : Outcome::plain, verdict_text(&both),
             fmt::format("{}: {}", verdict_text(&both), both.message), "");
  }

  std::size_t tests = 0, failures = 0, skipped = 0;

  /// All of it, with the properties given.
  std::string text(const std::vector<std::pair<std::string, std::string>>& properties) const {
    std::string text;
    XmlWriter xml(text);
    xml.depth = 1;
    xml.open("testsuite", {{"name", name_},
                           {"tests", std::to_string(tests)},
                           {"failures", std::to_string(failures)},
                           {"errors", "0"},
                           {"skipped", std::to_string(skipped)},
                           {"time", "0.000"}});
    xml.open("properties", {});
    for (const auto& [name, value] : properties)
      xml.leaf("property", {{"name", name}, {"value", value}});
    xml.close("properties");
    text += cases_;
    xml.close("testsuite");
    return text;
  }

 private:
  /// Class names begin with the suite's name: a case stands in each suite, and readers want it
  /// unique.
  void add_case(const std::string& id, const std::string& suffix, Outcome outcome,
                const std::string& type, const std::string& message, const std::string& body) {
    results::CaseResult named;
    named.id = id;
    const reports::JunitName name = reports::junit_name(named);
    const std::string classname =
        name_ + name.classname.substr(std::string_view("fieldproof").size());
    const std::string own_name = name.name + suffix;
    const XmlWriter::Attributes attributes{
        {"classname", classname}, {"name", own_name}, {"time", "0.000"}};
    ++tests;
    failures += outcome == Outcome::failure;
    skipped += outcome == Outcome::skipped;
    if (outcome == Outcome::plain && body.empty()) return xml_.leaf("testcase", attributes);
    xml_.open("testcase", attributes);
    if (outcome == Outcome::failure)
      xml_.leaf("failure", {{"type", type}, {"message", message}}, body);
    if (outcome == Outcome::skipped) xml_.leaf("skipped", {{"type", type}, {"message", message}});
    if (outcome != Outcome::failure && !body.empty()) xml_.leaf("system-out", {}, body);
    xml_.close("testcase");
  }

  std::string name_, cases_;
  XmlWriter xml_{cases_};
};

void fill(Suite& suite, const Comparison& comparison) {
  std::set<std::string> changed;
  for (const CaseChange& change : comparison.changes) {
    suite.add(change);
    changed.insert(change.id);
  }
  for (const TimeShift& shift : comparison.shifts) suite.add(shift, comparison.timing);
  for (const auto& [id, summary] : comparison.before->cases)
    if (!changed.contains(id)) suite.add_unchanged(id, summary);
}

}  // namespace

Status write_compare_junit(const ComparisonSet& set, const std::string& path) {
  auto file = text::ReportFile::create(path);
  if (!file) return file.error();
  std::string suites;
  std::size_t tests = 0, failures = 0;
  for (std::size_t i = 0; i < set.comparisons.size(); ++i) {
    const Comparison& one = set.comparisons[i];
    Suite suite(
        fmt::format("compare_{}_{}", ComparisonSet::letter(0), ComparisonSet::letter(i + 1)));
    fill(suite, one);
    suites += suite.text({{"before", one.before->path + ": " + run_facts(*one.before)},
                          {"after", one.after->path + ": " + run_facts(*one.after)},
                          {"outcome", outcome(one)}});
    tests += suite.tests;
    failures += suite.failures;
  }
  std::string head;
  XmlWriter(head).open("testsuites", {{"name", "fieldproof compare"},
                                      {"tests", std::to_string(tests)},
                                      {"failures", std::to_string(failures)},
                                      {"errors", "0"},
                                      {"time", "0.000"}});
  file->out() << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
              << head << suites << "</testsuites>\n";
  return file->commit();
}

}  // namespace fieldproof::compare
