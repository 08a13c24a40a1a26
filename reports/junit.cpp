#include "reports/junit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "reports/text/case_text.hpp"
#include "reports/text/failures.hpp"
#include "reports/text/report_file.hpp"
#include "reports/text/run_text.hpp"
#include "reports/text/spill.hpp"
#include "reports/text/tally.hpp"
#include "reports/text/timing_table.hpp"
#include "reports/text/xml_text.hpp"
#include "reports/text/xml_writer.hpp"

namespace fieldproof::reports {

using results::CaseResult;
using results::Delivery;
using results::DutInfo;
using results::Gate;
using results::Reason;
using results::RunInfo;
using results::RunLog;
using results::Sink;
using results::Verdict;
using text::case_block;
using text::case_message;
using text::Failures;
using text::Finding;
using text::JunitOutcome;
using text::ReportFile;
using text::Spill;
using text::Tally;
using text::TimingTable;
using text::xml_line;
using text::XmlWriter;

namespace {

/// Head and end of its element need totals; what stands between them is ready.
struct Suite {
  std::string protocol;
  Spill cases;
  Tally tally = {};
  double seconds = 0;
  text::TimingTable timing = {};
  text::Failures failures = {};
};

struct Counts {
  std::size_t tests = 0, failures = 0, errors = 0, skipped = 0;
};

Counts counts_of(const Tally& tally, const Gate& gate) {
  Counts counts;
  counts.tests = tally.total();
  for (Verdict verdict : Tally::verdicts) {
    switch (text::junit_outcome(verdict, gate)) {
      case JunitOutcome::failure: counts.failures += tally.of(verdict); break;
      case JunitOutcome::error: counts.errors += tally.of(verdict); break;
      case JunitOutcome::skipped: counts.skipped += tally.of(verdict); break;
      case JunitOutcome::plain: break;
    }
  }
  return counts;
}

// {fmt} knows no locale: the decimal sign is a dot everywhere.
std::string seconds_text(double seconds) { return fmt::format("{:.3f}", seconds); }

std::string headline(const CaseResult& result) {
  return fmt::format("{}: {}\n", results::to_string(result.verdict), text::case_message(result));
}

/// Of what is not on a wire.
std::string kind_line(const CaseResult& result) {
  if (result.on_model.empty()) return "";
  return fmt::format("kind {}: of a model, not on a wire\n", result.on_model);
}

/// What a case that does not fail has to say.
std::string remarks(const CaseResult& result) {
  switch (result.verdict) {
    case Verdict::marginal:
    case Verdict::non_strict:
    case Verdict::info:
    case Verdict::xfail:
    case Verdict::inconclusive:
      return headline(result) + kind_line(result) + text::case_block(result);
    default: break;
  }
  std::string text = kind_line(result);
  if (!result.dut.empty()) text += fmt::format("device {}\n", text::xml_line(result.dut));
  for (const std::string& note : result.notes) text += text::xml_line(note) + '\n';
  return text;
}

/// The body of what has failed alike before: where that stands in full.
std::string reference(const CaseResult& result, const Finding& finding) {
  std::string text = fmt::format(
      "finding {}, as {}, where it stands in full; results.ndjson has the "
      "frames of this case\n",
      finding.number, finding.first.front());
  if (!result.title.empty()) text += xml_line(result.title) + '\n';
  if (!result.section.empty())
    text += fmt::format("rests on  {}, {}\n", result.manual, xml_line(result.section));
  if (!result.replay.empty()) text += fmt::format("replay    {}\n", xml_line(result.replay));
  return text;
}

void write_outcome(XmlWriter& xml, const CaseResult& result, const char* element,
                   const Finding& finding) {
  // GitLab shows the body and not the message.
  xml.leaf(element, {{"type", to_string(result.verdict)}, {"message", case_message(result)}},
           headline(result) + kind_line(result) +
               (finding.is_again() ? reference(result, finding)
                                   : case_block(result, {.exchange = true})));
}

void write_case(XmlWriter& xml, const CaseResult& result, const Gate& gate, Failures& failures) {
  const auto [classname, name] = junit_name(result);
  const std::string time = seconds_text(result.seconds);
  const XmlWriter::Attributes attributes{{"classname", classname}, {"name", name}, {"time", time}};
  const JunitOutcome outcome = text::junit_outcome(result.verdict, gate);
  const bool red = outcome == JunitOutcome::failure || outcome == JunitOutcome::error;
  const std::string said = red ? "" : remarks(result);
  if (outcome == JunitOutcome::plain && said.empty()) return xml.leaf("testcase", attributes);
  xml.open("testcase", attributes);
  if (red)
    write_outcome(xml, result, outcome == JunitOutcome::error ? "error" : "failure",
                  failures.add(result));
  if (outcome == JunitOutcome::skipped)
    xml.leaf("skipped",
             {{"type", to_string(result.verdict)},
              {"message", fmt::format("{}: {}", to_string(result.verdict), case_message(result))}});
  if (!said.empty()) xml.leaf("system-out", {}, said);
  xml.close("testcase");
}

class JunitReport final : public Sink {
 public:
  explicit JunitReport(const std::string& path) : path_(path) {}

  Status begin(const RunInfo& run) override {
    gate_ = text::gate_of(run);
    return ok();
  }

  Status add(const Delivery& one) override {
    Suite& suite = suite_of(one->protocol);
    suite.tally.add(*one);
    suite.seconds += one->seconds;
    suite.timing.add(*one);
    text_.clear();
    XmlWriter xml(text_);
    xml.depth = 2;
    write_case(xml, *one, gate_, suite.failures);
    return suite.cases.append(text_);
  }

  Status end(const RunLog& log) override {
    write_reasons(log);
    auto file = ReportFile::create(path_);
    if (!file) return file.error();
    // A run without a result still says what it was about, and why nothing came of it.
    if (suites_.empty()) suite_of("");
    file->out() << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" << root_head(log);
    for (Suite& suite : suites_) {
      file->out() << suite_head(suite, log);
      if (Status copied = suite.cases.copy_to(file->out()); !copied) return copied;
      file->out() << suite_end(log);
    }
    file->out() << reasons_suite() << "</testsuites>\n";
    return file->commit();
  }

 private:
  /// What made the run red beside its cases: each reason is a test case of its own, so that no
  /// reader of the report finds green where the exit code is not 0.
  void write_reasons(const RunLog& log) {
    reasons_.clear();
    std::map<std::string, int> seen;
    for (const Reason& reason : reasons_of(log)) {
      if (is_shown_by_cases(reason)) continue;
      const int number = ++seen[reason.what];
      const bool failed = reason.exit_code == 1 || reason.exit_code == 4;
      ++reasons_counts_.tests;
      ++(failed ? reasons_counts_.failures : reasons_counts_.errors);
      XmlWriter xml(reasons_);
      xml.depth = 2;
      xml.open("testcase",
               {{"classname", "fieldproof.gate"},
                {"name", number == 1 ? reason.what : fmt::format("{} #{}", reason.what, number)},
                {"time", "0.000"}});
      xml.leaf(failed ? "failure" : "error", {{"type", reason.what}, {"message", reason.message}},
               fmt::format("exit {}: {}", reason.exit_code, reason.message));
      xml.close("testcase");
    }
  }

  static std::vector<Reason> reasons_of(const RunLog& log) {
    if (log.end) return log.end->reasons;
    return {{3, "killed", text::early_end(log)}};
  }

  std::string reasons_suite() const {
    if (reasons_.empty()) return "";
    std::string text;
    XmlWriter xml(text);
    xml.depth = 1;
    xml.open("testsuite", {{"name", "gate"},
                           {"tests", std::to_string(reasons_counts_.tests)},
                           {"failures", std::to_string(reasons_counts_.failures)},
                           {"errors", std::to_string(reasons_counts_.errors)},
                           {"skipped", "0"},
                           {"time", "0.000"}});
    xml.open("properties", {});
    xml.leaf("property", {{"name", "gate"}, {"value", text::to_string(gate_)}});
    xml.close("properties");
    text += reasons_;
    xml.close("testsuite");
    return text;
  }

  Suite& suite_of(const std::string& protocol) {
    const auto found = std::ranges::find(suites_, protocol, &Suite::protocol);
    if (found != suites_.end()) return *found;
    return suites_.emplace_back(Suite{protocol, Spill(path_)});
  }

  std::string root_head(const RunLog& log) const {
    Tally all;
    double seconds = 0;
    for (const Suite& suite : suites_) {
      all.add(suite.tally);
      seconds += suite.seconds;
    }
    Counts counts = counts_of(all, gate_);
    counts.tests += reasons_counts_.tests;
    counts.failures += reasons_counts_.failures;
    counts.errors += reasons_counts_.errors;
    std::string text;
    XmlWriter(text).open("testsuites",
                         {{"name", "fieldproof"},
                          {"tests", std::to_string(counts.tests)},
                          {"failures", std::to_string(counts.failures)},
                          {"errors", std::to_string(counts.errors)},
                          {"time", seconds_text(log.end ? log.end->seconds : seconds)}});
    return text;
  }

  std::string suite_head(const Suite& suite, const RunLog& log) const {
    const Counts counts = counts_of(suite.tally, gate_);
    std::string text;
    XmlWriter xml(text);
    xml.depth = 1;
    xml.open("testsuite", {{"name", suite.protocol.empty() ? "fieldproof" : suite.protocol},
                           {"tests", std::to_string(counts.tests)},
                           {"failures", std::to_string(counts.failures)},
                           {"errors", std::to_string(counts.errors)},
                           {"skipped", std::to_string(counts.skipped)},
                           {"time", seconds_text(suite.seconds)},
                           {log.run.started.empty() ? "" : "timestamp", log.run.started}});
    write_properties(xml, suite, log);
    return text;
  }

  void write_properties(XmlWriter& xml, const Suite& suite, const RunLog& log) const {
    xml.open("properties", {});
    const auto add = [&](const std::string& name, const std::string& value) {
      xml.leaf("property", {{"name", name}, {"value", value}});
    };
    add("fieldproof", log.run.tool_version);
    add("endpoint", log.run.endpoint);
    add("profile", log.run.profile);
    add("command", log.run.command);
    add("vectors", log.run.vectors_hash);
    add("gate", text::to_string(gate_));
    if (const std::string models = text::on_model_text(suite.tally); !models.empty())
      add("on_model", models);
    for (const auto& [name, value] : log.run.properties)
      if (name != "gate") add(name, value);
    for (const DutInfo& dut : log.run.duts) add("dut." + dut.identity.name, text::device_text(dut));
    add("end", log.end ? log.end->finished : "missing");
    if (log.end) add("exit_code", std::to_string(log.end->exit_code));
    if (const std::string why = text::early_end(log); !why.empty()) add("ended_early", why);
    if (log.soak) add("soak", soak_text(*log.soak));
    for (const Finding* finding : suite.failures.repeated())
      add(fmt::format("finding {}", finding->number), to_string(*finding));
    for (const auto& [name, figures] : suite.timing.rows())
      add("reply times " + name, to_string(figures));
    xml.close("properties");
  }

  static std::string suite_end(const RunLog& log) {
    std::string text;
    XmlWriter xml(text);
    xml.depth = 2;
    if (const std::string why = text::early_end(log); !why.empty()) xml.leaf("system-err", {}, why);
    xml.close("testsuite");
    return text;
  }

  std::string path_;
  Gate gate_;
  std::vector<Suite> suites_;  // few: found by looking at each
  Counts reasons_counts_;
  std::string reasons_;  // their test cases
  std::string text_;     // of one case; its room, from case to case
};

}  // namespace

JunitName junit_name(const CaseResult& result) {
  // The first two parts are folder and group; an id of fewer parts keeps the last as its name.
  JunitName name{"fieldproof", result.id};
  for (int part = 0; part < 2; ++part) {
    const std::size_t slash = name.name.find('/');
    if (slash == std::string::npos) break;
    name.classname += '.' + name.name.substr(0, slash);
    name.name.erase(0, slash + 1);
  }
  if (!result.line.empty()) name.name += fmt::format(" [{}]", result.line);
  if (result.repeat > 0) name.name += fmt::format(" #{}", result.repeat + 1);
  return name;
}

std::unique_ptr<Sink> junit_report(const std::string& path) {
  return std::make_unique<JunitReport>(path);
}

}  // namespace fieldproof::reports
