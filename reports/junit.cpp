#include "reports/junit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>
#include <vector>

#include "reports/results/ndjson.hpp"
#include "reports/text/case_text.hpp"
#include "reports/text/report_file.hpp"
#include "reports/text/run_text.hpp"
#include "reports/text/timing_table.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::reports {

using results::CaseResult;
using results::Gate;
using results::Verdict;
using text::JunitOutcome;
using text::Tally;

namespace {

struct Suite {
  std::string protocol = {};
  Tally tally = {};
  double seconds = 0;
  text::TimingTable timing = {};
};

/// What the first pass finds.
struct Survey {
  results::RunLog log;
  std::vector<Suite> suites;
};

struct Counts {
  std::size_t tests = 0, failures = 0, errors = 0, skipped = 0;
};

Result<Survey> survey_results(const std::string& ndjson) {
  std::vector<Suite> suites;
  auto log = results::read_ndjson(ndjson, [&](const CaseResult& result) {
    auto suite = std::find_if(suites.begin(), suites.end(),
                              [&](const Suite& s) { return s.protocol == result.protocol; });
    if (suite == suites.end()) suite = suites.insert(suites.end(), {.protocol = result.protocol});
    suite->tally.add(result.verdict);
    suite->seconds += result.seconds;
    suite->timing.add(result);
  });
  if (!log) return log.error();
  // A run without a result still says what it was about, and why nothing came of it.
  if (suites.empty()) suites.push_back({});
  return Survey{std::move(*log), std::move(suites)};
}

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

void set(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(text::xml_line(value).c_str());
}
void set(pugi::xml_node node, const char* name, std::size_t value) {
  node.append_attribute(name).set_value(static_cast<unsigned long long>(value));
}
void set_body(pugi::xml_node node, const std::string& body) {
  node.text().set(text::xml_text(body).c_str());
}

std::string print(pugi::xml_node node, unsigned depth) {
  std::ostringstream out;
  node.print(out, "  ", pugi::format_default, pugi::encoding_utf8, depth);
  return out.str();
}

/// The tag that opens an element whose children are written one by one.
std::string opening_tag(pugi::xml_node node, unsigned depth) {
  std::string text = print(node, depth);
  text.replace(text.rfind("/>"), 2, ">");
  if (const std::size_t blank = text.rfind(" >"); blank != std::string::npos) text.erase(blank, 1);
  return text;
}

std::string root_tag(const Survey& survey, const Gate& gate) {
  Tally all;
  double seconds = 0;
  for (const Suite& suite : survey.suites) {
    for (Verdict verdict : Tally::verdicts) all.add(verdict, suite.tally.of(verdict));
    seconds += suite.seconds;
  }
  const Counts counts = counts_of(all, gate);
  pugi::xml_document document;
  pugi::xml_node node = document.append_child("testsuites");
  set(node, "name", std::string("fieldproof"));
  set(node, "tests", counts.tests);
  set(node, "failures", counts.failures);
  set(node, "errors", counts.errors);
  set(node, "time", seconds_text(survey.log.end ? survey.log.end->seconds : seconds));
  return opening_tag(node, 0);
}

std::string suite_tag(const Suite& suite, const results::RunLog& log, const Gate& gate) {
  const Counts counts = counts_of(suite.tally, gate);
  pugi::xml_document document;
  pugi::xml_node node = document.append_child("testsuite");
  set(node, "name", suite.protocol.empty() ? std::string("fieldproof") : suite.protocol);
  set(node, "tests", counts.tests);
  set(node, "failures", counts.failures);
  set(node, "errors", counts.errors);
  set(node, "skipped", counts.skipped);
  set(node, "time", seconds_text(suite.seconds));
  if (!log.run.started.empty()) set(node, "timestamp", log.run.started);
  return opening_tag(node, 1);
}

std::string properties(const Suite& suite, const results::RunLog& log, const Gate& gate) {
  pugi::xml_document document;
  pugi::xml_node list = document.append_child("properties");
  const auto add = [&](const std::string& name, const std::string& value) {
    pugi::xml_node property = list.append_child("property");
    set(property, "name", name);
    set(property, "value", value);
  };
  add("fieldproof", log.run.tool_version);
  add("endpoint", log.run.endpoint);
  add("profile", log.run.profile);
  add("command", log.run.command);
  add("vectors", log.run.vectors_hash);
  add("gate", text::to_string(gate));
  for (const auto& [name, value] : log.run.properties) {
    if (name != "gate") add(name, value);  // this report's gate is the one above
  }
  for (const results::DutInfo& dut : log.run.duts)
    add("dut." + dut.identity.name, text::device_text(dut));
  add("end", log.end ? log.end->finished : "missing");
  if (log.end) add("exit_code", std::to_string(log.end->exit_code));
  if (const std::string why = text::early_end(log); !why.empty()) add("ended_early", why);
  if (log.soak) add("soak", results::soak_text(*log.soak));
  for (const auto& [name, figures] : suite.timing.rows())
    add("reply times " + name, results::to_string(figures));
  return print(list, 2);
}

std::string headline(const CaseResult& result) {
  return fmt::format("{}: {}\n", results::to_string(result.verdict), text::case_message(result));
}

/// What a case that does not fail has to say.
std::string remarks(const CaseResult& result) {
  switch (result.verdict) {
    case Verdict::marginal:
    case Verdict::non_strict:
    case Verdict::info:
    case Verdict::xfail:
    case Verdict::inconclusive: return headline(result) + text::case_block(result);
    default: break;
  }
  std::string text =
      result.dut.empty() ? "" : fmt::format("device {}\n", text::xml_line(result.dut));
  for (const std::string& note : result.notes) text += text::xml_line(note) + '\n';
  return text;
}

void add_outcome(pugi::xml_node testcase, const CaseResult& result, const char* element) {
  pugi::xml_node node = testcase.append_child(element);
  set(node, "type", std::string(results::to_string(result.verdict)));
  set(node, "message", text::case_message(result));
  // GitLab shows the body and not the message.
  set_body(node, headline(result) + text::case_block(result, {.exchange = true}));
}

std::string testcase(const CaseResult& result, const Gate& gate) {
  pugi::xml_document document;
  pugi::xml_node node = document.append_child("testcase");
  const auto [classname, name] = junit_name(result);
  set(node, "classname", classname);
  set(node, "name", name);
  set(node, "time", seconds_text(result.seconds));
  switch (text::junit_outcome(result.verdict, gate)) {
    case JunitOutcome::failure: add_outcome(node, result, "failure"); break;
    case JunitOutcome::error: add_outcome(node, result, "error"); break;
    case JunitOutcome::skipped: {
      pugi::xml_node skipped = node.append_child("skipped");
      set(skipped, "type", std::string(results::to_string(result.verdict)));
      set(skipped, "message",
          fmt::format("{}: {}", results::to_string(result.verdict), text::case_message(result)));
      [[fallthrough]];
    }
    case JunitOutcome::plain:
      if (const std::string text = remarks(result); !text.empty())
        set_body(node.append_child("system-out"), text);
  }
  return print(node, 2);
}

Status write_suite(std::ostream& out, const std::string& ndjson, const Suite& suite,
                   const results::RunLog& log, const Gate& gate) {
  out << suite_tag(suite, log, gate) << properties(suite, log, gate);
  Tally written;
  auto again = results::read_ndjson(ndjson, [&](const CaseResult& result) {
    if (result.protocol != suite.protocol) return;
    written.add(result.verdict);
    out << testcase(result, gate);
  });
  if (!again) return again.error();
  if (written != suite.tally) {
    return fail(fmt::format(
        "cannot report {}: it changed while it was read; wait for the run to end, then repeat",
        ndjson));
  }
  if (const std::string why = text::early_end(log); !why.empty()) {
    pugi::xml_document document;
    pugi::xml_node node = document.append_child("system-err");
    set_body(node, why);
    out << print(node, 2);
  }
  out << "  </testsuite>\n";
  return ok();
}

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

Result<Tally> write_junit(const std::string& ndjson, const std::string& path, const Gate& gate) {
  auto survey = survey_results(ndjson);
  if (!survey) return survey.error();
  auto file = text::ReportFile::create(path);
  if (!file) return file.error();

  file->out() << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" << root_tag(*survey, gate);
  Tally all;
  for (const Suite& suite : survey->suites) {
    if (Status written = write_suite(file->out(), ndjson, suite, survey->log, gate); !written)
      return written.error();
    for (Verdict verdict : Tally::verdicts) all.add(verdict, suite.tally.of(verdict));
  }
  file->out() << "</testsuites>\n";
  if (Status done = file->commit(); !done) return done.error();
  return all;
}

}  // namespace fieldproof::reports
