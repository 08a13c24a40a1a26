// The table of README "A program that can be set up": what a run judges of each device there is
// what the table says.
#include <gmock/gmock.h>

#include <list>
#include <map>
#include <numeric>
#include <regex>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::example {
namespace {

using tool_tests::Process;
using tool_tests::TestFolder;

struct Row {
  std::string filter;  // "ls_bus"
  std::size_t judged = 0, declared = 0;
  std::vector<std::size_t> rest;  // of each reason
};

std::size_t number(std::string text) {
  std::erase(text, ',');
  return std::stoul(text);
}

/// Its rows have a protocol's folder of vectors behind the device, and how many are judged.
std::vector<Row> rows_of(const std::string& readme) {
  static const std::regex row(R"(^\| .*\(`([a-z_]+)`\) \| ([0-9,]+) of ([0-9,]+) \| (.*)\|$)"),
      count(R"(\(([0-9]+)\))");
  std::vector<Row> rows;
  for (const std::string& line : tool_tests::text_lines(readme)) {
    std::smatch match;
    if (!std::regex_match(line, match, row)) continue;
    Row& one = rows.emplace_back(Row{match[1], number(match[2]), number(match[3]), {}});
    const std::string rest = match[4];
    for (std::sregex_iterator at(rest.begin(), rest.end(), count), end; at != end; ++at)
      one.rest.push_back(number((*at)[1]));
  }
  return rows;
}

/// The commands of README, for each protocol.
std::vector<std::string> command_for(const std::string& folder, const std::string& filter,
                                     const std::string& out) {
  const std::map<std::string, std::pair<std::string, std::string>> emulated{
      {"xgt_cnet", {"xgt-cnet", "--pty {tty}"}},
      {"modbus_rtu", {"modbus-rtu", "--pty {tty}"}},
      {"modbus_ascii", {"modbus-ascii", "--pty {tty}"}},
      {"modbus_tcp", {"modbus-tcp", "--tcp {port}"}},
      {"xgt_fenet", {"xgt-fenet", "--tcp {port} --udp {udp_port}"}}};
  std::string endpoint = "exec:python3 -B " FIELDPROOF_SOURCE_DIR
                         "/suites/example/inverter.py {tty} {station} {write_order}",
              protocol = "ls-bus", profile = "inverter";
  if (const auto one = emulated.find(folder); one != emulated.end()) {
    protocol = one->second.first;
    profile = "xbc-h";
    endpoint = "exec:" FIELDPROOF_TOOL " emulate 'xbc-h?protocol=" + protocol +
               "&station={station}' --control - " + one->second.second;
  }
  return tool_tests::tool_arguments({"run", "--endpoint", endpoint, "--control", "-", "--protocol",
                                     protocol, "--profile", profile, "--role", "server", "--filter",
                                     filter, "--out", out});
}

/// One run for each row, all at once: they wait more than they work.
class ReadmeTable : public testing::Test {
 protected:
  ReadmeTable() : rows_(rows_of(tool_tests::read_text(FIELDPROOF_SOURCE_DIR "/README.md"))) {
    for (const Row& row : rows_)
      runs_.emplace_back(command_for(row.filter, row.filter + "/*", folder_ / row.filter));
    for (Process& run : runs_) run.wait(Process::Limit(800));
  }

  tool_tests::Results results_of(const std::string& name) {
    return tool_tests::read_results(folder_ / (name + "/results.ndjson"));
  }

  /// What is not judged: a computer that is busy for a moment may add to it, so it is run once
  /// more, alone.
  std::vector<std::string> open_of(const Row& row) {
    const std::vector<std::string> first = results_of(row.filter).ids_of(open);
    if (row.judged + first.size() == row.declared) return first;
    Process again(command_for(row.filter, tool_tests::filter_of(first), folder_ / "again"));
    again.wait(Process::Limit(800));
    return results_of("again").ids_of(open);
  }

  const std::set<std::string> open{"BLOCKED", "INCONCLUSIVE"};
  TestFolder folder_;
  std::vector<Row> rows_;
  std::list<Process> runs_;
};

TEST_F(ReadmeTable, HasWhatARunGives) {
  EXPECT_EQ(rows_.size(), 6u);
  for (const Row& row : rows_) {
    SCOPED_TRACE(row.filter);
    const tool_tests::Results results = results_of(row.filter);
    const std::vector<std::string> left = open_of(row);
    const std::size_t declared = results.cases.size() - results.counts()["SKIP"];
    EXPECT_EQ(row.declared, declared);
    EXPECT_EQ(row.judged, declared - left.size()) << tool_tests::filter_of(left);
    EXPECT_EQ(std::accumulate(row.rest.begin(), row.rest.end(), std::size_t{}), left.size())
        << "each that is left is named";
  }
}

TEST(ReadmeText, HasTheLinesOfTheExample) {
  const std::size_t lines =
      tool_tests::text_lines(
          tool_tests::read_text(FIELDPROOF_SOURCE_DIR "/suites/example/inverter.py"))
          .size();
  EXPECT_THAT(tool_tests::read_text(FIELDPROOF_SOURCE_DIR "/README.md"),
              testing::HasSubstr("inverter of " + std::to_string(lines) + " lines"));
}

}  // namespace
}  // namespace fieldproof::example
