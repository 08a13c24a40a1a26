// What a person reads keeps to the terminal.
#include <gmock/gmock.h>

#include "reports/text/fold.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class OnATerminal : public testing::Test {
 protected:
  /// In a folder of its own: paths are short.
  Finished run(std::vector<std::string> arguments, const std::string& columns = "80") const {
    std::vector<std::pair<std::string, std::string>> environment;
    if (!columns.empty()) environment.emplace_back("COLUMNS", columns);
    return run_tool(std::move(arguments), {.environment = environment, .folder = folder_.path()});
  }

  /// Lines of either stream that are wider than the terminal.
  static std::vector<std::string> too_wide(const Finished& finished, std::size_t columns = 80) {
    std::vector<std::string> found;
    for (const std::string& line : text_lines(finished.out + finished.err))
      if (text::columns_of(line) > columns) found.push_back(line);
    return found;
  }

  std::vector<std::string> broken_run() const {
    std::error_code ignored;
    std::filesystem::create_symlink(BROKEN_SERVER, folder_ / "server", ignored);
    return {"run",
            "--endpoint",
            "exec:./server 0011_for_1132 {tty}",
            "--profile",
            "xbc-h",
            "--filter",
            "xgt_cnet/rss/*",
            "--out",
            "out"};
  }

  TestFolder folder_;
};

TEST_F(OnATerminal, a_green_run_fits) {
  const Finished finished = run({"run", "--filter", "*/examples/*:xgt_cnet/rs*"});
  EXPECT_EQ(finished.code, 0) << finished.out;
  EXPECT_THAT(too_wide(finished), IsEmpty());
}

TEST_F(OnATerminal, a_red_run_fits) {
  const Finished finished = run(broken_run());
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("replay    fieldproof run"));
  EXPECT_THAT(too_wide(finished), IsEmpty());
  std::vector<std::string> verbose = broken_run();
  verbose.push_back("-v");
  EXPECT_THAT(too_wide(run(verbose)), IsEmpty());
}

/// What is quoted for the shell, too: in the line to replay, and where `probe` says how to go on.
TEST_F(OnATerminal, a_command_with_a_long_endpoint_fits) {
  const std::string why =
      " # so that the quotes of this word hold more than a line of a terminal has";
  std::vector<std::string> red = broken_run();
  red[2] += why;
  const Finished failed = run(red);
  EXPECT_THAT(failed.out, HasSubstr("replay    fieldproof run"));
  EXPECT_THAT(too_wide(failed), IsEmpty());
  const Finished probed =
      run({"probe", red[2], "--protocol", "xgt-cnet", "--station", "1", "--wait", "200"});
  EXPECT_THAT(probed.out, HasSubstr("go on with    fieldproof run"));
  EXPECT_THAT(too_wide(probed), IsEmpty());
}

TEST_F(OnATerminal, a_replayed_command_can_be_pasted) {
  const std::string out = run(broken_run()).out;
  const std::size_t begin = out.find("replay    ") + 10;
  const std::string command = out.substr(begin, out.find("\n\n", begin) - begin);
  EXPECT_THAT(command, HasSubstr(" \\\n"));
  std::filesystem::create_symlink(FIELDPROOF_TOOL, folder_ / "fieldproof");
  const Finished again =
      run_program({"bash", "-c", "./" + command}, {.environment = {}, .folder = folder_.path()});
  EXPECT_EQ(again.code, 1) << again.err;
  EXPECT_THAT(again.out, HasSubstr("\n1 case in "));
}

TEST_F(OnATerminal, of_many_failures_the_first_are_told) {
  // Of eight kinds, since of one kind three are told in full.
  const std::vector<std::string> wrong{wrong_word,
                                       "[ACK st 'rSB' '01' '02' '0000' ETX BCC]",
                                       "[ACK st 'rSS' '02' '02' '0000' ETX BCC]",
                                       "[ACK '05' 'rSS' '01' '02' '0000' ETX BCC]",
                                       "[ACK st 'rSS' '01' '02' '0000' ETX BCC!]",
                                       "[ACK st 'rSS' '01' '04' '00000000' ETX BCC]",
                                       "[NAK st 'rSS' '1132' ETX BCC]",
                                       "'no frame'"};
  std::vector<nlohmann::ordered_json> vectors;
  for (std::size_t i = 0; i < 50; ++i)
    vectors.push_back(small_vector("many/n" + std::to_string(100 + i), wrong[i % wrong.size()]));
  const Finished finished = run({"run", "--vectors", write_vectors(folder_, vectors)});
  EXPECT_EQ(finished.code, 1);
  std::size_t in_full = 0, lines = 0;
  for (const std::string& line : text_lines(finished.out)) {
    in_full += line.starts_with("  received  ");
    lines += line.starts_with("FAIL ");
  }
  EXPECT_EQ(in_full, 20u);
  EXPECT_EQ(lines, 40u) << "and as many in a line each";
  EXPECT_THAT(finished.out, HasSubstr("further failures are counted"));
  EXPECT_THAT(finished.out, HasSubstr("50  FAIL"));
  EXPECT_THAT(finished.out, Not(HasSubstr("many/n149")));
  EXPECT_THAT(read_text(folder_ / "fieldproof-out/report.html"), HasSubstr("many/n149"));
}

TEST_F(OnATerminal, every_list_fits) {
  EXPECT_EQ(run({"run", "--filter", "*/examples/*", "--out", "out"}).code, 0);
  const std::vector<std::vector<std::string>> commands{
      {"list"},
      {"list", "--coverage"},
      {"list", "--redundant"},
      {"run", "--dry-run"},
      {"errata"},
      {"lint", "--vectors", write_vectors(folder_, many_vectors(3))},
      {"frame", "[ENQ st 'rSS' '01' name(%MW100) EOT BCC]"},
      {"probe", "emulator:xbc-h?line=38400-8E1"},
      {"compare", "out/results.json", "out/results.ndjson"},
      {"run", "--filter", "nothing/of/this", "--profile", "xbc-h", "--protocol", "modbus-rtu"},
      {"--version"}};
  for (const std::vector<std::string>& command : commands) {
    const Finished finished = run(command);
    EXPECT_THAT(too_wide(finished), IsEmpty()) << command.front();
    EXPECT_THAT(finished.out + finished.err, Not(IsEmpty())) << command.front();
  }
}

TEST_F(OnATerminal, titles_are_shortened) {
  const Finished list = run({"list", "xgt_cnet/rss/*"});
  EXPECT_THAT(list.out, HasSubstr("...\n"));
  EXPECT_THAT(run({"list", "xgt_cnet/rss/*"}, "").out, Not(HasSubstr("...\n"))) << "in a file";
}

/// Names in the list of commands, and the tool itself.
std::vector<std::vector<std::string>> commands_of_help(const std::string& help) {
  std::vector<std::vector<std::string>> commands{{}};
  for (const std::string& line : text_lines(help.substr(help.find("\nCommands:\n") + 11))) {
    if (!line.starts_with("  ")) break;
    if (line[2] != ' ') commands.push_back({line.substr(2, line.find(' ', 2) - 2)});
  }
  return commands;
}

TEST_F(OnATerminal, every_help_fits) {
  const std::vector<std::vector<std::string>> commands = commands_of_help(run({"--help"}).out);
  EXPECT_GT(commands.size(), 14u);
  for (std::vector<std::string> command : commands) {
    command.emplace_back("--help");
    for (const std::string columns : {"", "80", "60"}) {
      const Finished help = run(command, columns);
      EXPECT_EQ(help.code, 0);
      EXPECT_THAT(too_wide(help, columns == "60" ? 60 : 80), IsEmpty()) << command.front();
    }
  }
}

TEST_F(OnATerminal, the_options_of_a_run_are_in_groups) {
  for (const char* command : {"run", "explore"}) {
    const std::string help = run({command, "--help"}).out;
    const std::size_t others = help.find("\nOptions:\n");
    ASSERT_NE(others, std::string::npos);
    EXPECT_THAT(help.substr(0, others), HasSubstr("\nThe gate:\n"));
    EXPECT_EQ(help.find("\n  -", others), help.rfind("\n  -"))
        << "an option without a group: " << help.substr(others);
  }
}

}  // namespace
}  // namespace fieldproof::tool_tests
