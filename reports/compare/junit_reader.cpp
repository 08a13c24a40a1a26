#include "reports/compare/junit_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <pugixml.hpp>
#include <tuple>

namespace fieldproof::compare {

using results::CaseResult;
using results::Verdict;

namespace {

constexpr std::string_view own_prefix = "fieldproof.";

void read_property(const std::string& name, const std::string& value, results::RunInfo& run) {
  if (name == "fieldproof")
    run.tool_version = value;
  else if (name == "endpoint")
    run.endpoint = value;
  else if (name == "profile")
    run.profile = value;
  else if (name == "command")
    run.command = value;
  else if (name == "vectors")
    run.vectors_hash = value;
  else
    run.properties[name] = value;
}

/// The reverse of junit_name() for our own, "class/name" for others.
void read_name(pugi::xml_node node, CaseResult& result) {
  std::string classname = node.attribute("classname").value();
  result.id = node.attribute("name").value();
  if (classname.starts_with(own_prefix)) {
    classname.erase(0, own_prefix.size());
    std::ranges::replace(classname, '.', '/');
    if (const std::size_t mark = result.id.rfind(" #"); mark != std::string::npos) {
      const char* end = result.id.data() + result.id.size();
      int number = 0;
      if (std::from_chars(result.id.data() + mark + 2, end, number).ptr == end && number > 1) {
        result.repeat = number - 1;
        result.id.resize(mark);
      }
    }
    if (const std::size_t mark = result.id.rfind(" [");
        mark != std::string::npos && result.id.ends_with(']')) {
      result.line = result.id.substr(mark + 2, result.id.size() - mark - 3);
      result.id.resize(mark);
    }
  } else if (classname == "fieldproof") {
    classname.clear();
  }
  if (!classname.empty()) result.id = classname + '/' + result.id;
}

std::string first_line(const char* text) {
  const std::string_view all(text);
  const std::size_t begin = std::min(all.find_first_not_of(" \t\r\n"), all.size());
  return std::string(all.substr(begin, all.find_first_of("\r\n", begin) - begin));
}

/// "NON-STRICT: allowed alternative", as our remarks begin; false where the line says no verdict.
bool read_headline(const std::string& line, CaseResult& result) {
  const std::size_t colon = line.find(": ");
  const auto verdict =
      results::parse_verdict(std::string_view(line).substr(0, std::min(colon, line.size())));
  if (!verdict) return false;
  result.verdict = *verdict;
  result.message = colon == std::string::npos ? "" : line.substr(colon + 2);
  return true;
}

void read_outcome(pugi::xml_node node, CaseResult& result) {
  constexpr std::pair<const char*, Verdict> outcomes[] = {
      {"error", Verdict::error}, {"failure", Verdict::fail}, {"skipped", Verdict::skip}};
  for (const auto& [element, verdict] : outcomes) {
    const pugi::xml_node outcome = node.child(element);
    if (!outcome) continue;
    result.verdict = results::parse_verdict(outcome.attribute("type").value()).value_or(verdict);
    result.message = outcome.attribute("message").value();
    if (result.message.empty()) result.message = first_line(outcome.text().get());
    // A skipped case of ours repeats the verdict before the message.
    if (CaseResult read; read_headline(result.message, read) && read.verdict == result.verdict)
      result.message = read.message;
    return;
  }
  result.verdict = Verdict::pass;
  read_headline(first_line(node.child("system-out").text().get()), result);
}

}  // namespace

Result<ResultFile> read_junit_text(const std::string& text, const std::string& path) {
  pugi::xml_document document;
  if (const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
      !parsed) {
    const auto end = text.begin() + std::clamp<std::ptrdiff_t>(
                                        parsed.offset, 0, static_cast<std::ptrdiff_t>(text.size()));
    return fail(fmt::format("cannot read {}, line {}: {}; is the file complete?", path,
                            1 + std::count(text.begin(), end, '\n'), parsed.description()));
  }
  const std::string root = document.document_element().name();
  if (root != "testsuites" && root != "testsuite")
    return fail(fmt::format(
        "cannot read {}: it is XML, but no JUnit (<{}> instead of <testsuites>)", path, root));
  ResultFile file;
  file.path = path;
  for (const pugi::xpath_node& found : document.select_nodes("//testsuite/properties/property"))
    read_property(found.node().attribute("name").value(), found.node().attribute("value").value(),
                  file.run);
  file.run.started =
      document.select_node("//testsuite[@timestamp]").node().attribute("timestamp").value();
  std::map<std::tuple<std::string, std::string, int>, int> seen;
  for (const pugi::xpath_node& found : document.select_nodes("//testcase")) {
    CaseResult result;
    result.rev = 0;
    read_name(found.node(), result);
    if (result.id.empty())
      return fail(
          fmt::format("cannot read {}: test case {} has no name", path, file.results.size() + 1));
    read_outcome(found.node(), result);
    result.seconds = found.node().attribute("time").as_double();
    result.repeat += seen[{result.id, result.line, result.repeat}]++;  // others may name two alike
    file.results.push_back(std::move(result));
  }
  return file;
}

}  // namespace fieldproof::compare
