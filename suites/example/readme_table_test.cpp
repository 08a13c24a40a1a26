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
std::vector<std::string> command_for(const std::string& filter, const std::string& out) {
  const std::map<std::string, std::pair<std::string, std::string>> emulated{
      {"xgt_cnet", {"xgt-cnet", "--pty {tty}"}},
      {"modbus_rtu", {"modbus-rtu", "--pty {tty}"}},
      {"modbus_ascii", {"modbus-ascii", "--pty {tty}"}},
      {"modbus_tcp", {"modbus-tcp", "--tcp {port}"}},
      {"xgt_fenet", {"xgt-fenet", "--tcp {port} --udp {udp_port}"}}};
  std::string endpoint = "exec:python3 -B " FIELDPROOF_SOURCE_DIR
                         "/suites/example/inverter.py {tty} {station} {write_order}",
              protocol = "ls-bus", profile = "inverter";
  if (const auto one = emulated.find(filter); one != emulated.end()) {
    protocol = one->second.first;
    profile = "xbc-h";
    endpoint = "exec:" FIELDPROOF_TOOL " emulate 'xbc-h?protocol=" + protocol +
               "&station={station}' --control - " + one->second.second;
  }
  return tool_tests::tool_arguments({"run", "--endpoint", endpoint, "--control", "-", "--protocol",
                                     protocol, "--profile", profile, "--role", "server", "--filter",
                                     filter + "/*", "--out", out});
}

/// One run for each row, all at once: they wait more than they work.
class ReadmeTable : public testing::Test {
 protected:
  ReadmeTable() : rows_(rows_of(tool_tests::read_text(FIELDPROOF_SOURCE_DIR "/README.md"))) {
    for (const Row& row : rows_) runs_.emplace_back(command_for(row.filter, folder_ / row.filter));
    for (Process& run : runs_) run.wait(Process::Limit(800));
  }

  TestFolder folder_;
  std::vector<Row> rows_;
  std::list<Process> runs_;
};

TEST_F(ReadmeTable, HasWhatARunGives) {
  EXPECT_EQ(rows_.size(), 6u);
  for (const Row& row : rows_) {
    SCOPED_TRACE(row.filter);
    std::map<std::string, std::size_t> counts =
        tool_tests::read_results(folder_ / (row.filter + "/results.ndjson")).counts();
    const std::size_t skipped = counts["SKIP"], open = counts["BLOCKED"] + counts["INCONCLUSIVE"];
    const std::size_t all =
        std::accumulate(counts.begin(), counts.end(), std::size_t{},
                        [](std::size_t sum, const auto& one) { return sum + one.second; });
    EXPECT_EQ(row.declared, all - skipped);
    EXPECT_EQ(row.judged, all - skipped - open);
    EXPECT_EQ(std::accumulate(row.rest.begin(), row.rest.end(), std::size_t{}), open)
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
