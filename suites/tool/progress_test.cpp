// The console of a run: one line that moves on a terminal, failures and a summary in a log.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;
using testing::Not;

class ProgressOfARun : public testing::Test {
 protected:
  ProgressOfARun() {
    std::vector<nlohmann::ordered_json> vectors = many_vectors(60);
    vectors.push_back(
        small_vector("many/m_wrong", wrong_word));  // in the middle of neither: the first by its id
    arguments_ = {
        "run",   "--endpoint",   "emulator:xbc-h", "--vectors", write_vectors(folder_, vectors),
        "--out", folder_ / "out"};
  }

  /// `script` runs a command behind a pty of its own, `columns` wide.
  Finished on_a_terminal(int columns) {
    std::string command =
        "stty cols " + std::to_string(columns) + " && exec " + quoted(FIELDPROOF_TOOL);
    for (const std::string& one : arguments_) command += ' ' + quoted(one);
    return run_program({"script", "--quiet", "--return", "--command", command, "/dev/null"});
  }

  TestFolder folder_;
  std::vector<std::string> arguments_;
};

/// What stands on the screen in the end: a carriage return goes back to the first column, ESC [ K
/// erases from there.
std::vector<std::string> screen(const std::string& output) {
  std::vector<std::string> lines{""};
  std::size_t column = 0;
  for (std::size_t i = 0; i < output.size(); ++i) {
    if (output[i] == '\r') {
      column = 0;
    } else if (output[i] == '\n') {
      lines.emplace_back();
      column = 0;
    } else if (output.compare(i, 2, "\x1b[") == 0) {
      const std::size_t end = output.find_first_of("Km", i);
      if (output[end] == 'K') lines.back().resize(column);
      i = end;
    } else {
      lines.back().resize(std::max(lines.back().size(), column + 1), ' ');
      lines.back()[column++] = output[i];
    }
  }
  return lines;
}

/// The progress lines as they were drawn, one after the other.
std::vector<std::string> drawn(const std::string& output) {
  const std::string erase = "\r\x1b[K[";
  std::vector<std::string> lines;
  for (std::size_t at = output.find(erase); at != std::string::npos;
       at = output.find(erase, at + 1)) {
    const std::size_t start = at + erase.size() - 1;
    lines.push_back(output.substr(start, output.find_first_of("\r\n\x1b", start) - start));
  }
  return lines;
}

TEST_F(ProgressOfARun, is_one_line_on_a_terminal) {
  const Finished finished = on_a_terminal(60);
  EXPECT_EQ(finished.code, 1) << finished.out;
  const std::vector<std::string> lines = drawn(finished.out);
  ASSERT_FALSE(lines.empty()) << finished.out;
  EXPECT_THAT(lines.front(), HasSubstr("[ 0/61] 61 to go  xgt_cnet/many/m_wrong"));
  for (const std::string& line : lines) EXPECT_LT(line.size(), 60u) << line;
  std::size_t failures = 0;
  for (const std::string& line : screen(finished.out)) {
    EXPECT_THAT(line, Not(testing::StartsWith("["))) << "a progress line was left behind";
    failures += line.starts_with("FAIL          xgt_cnet/many/m_wrong");
  }
  EXPECT_EQ(failures, 1u) << finished.out;
}

TEST_F(ProgressOfARun, is_cut_to_the_terminal) {
  for (const std::string& line : drawn(on_a_terminal(30).out)) EXPECT_LE(line.size(), 29u) << line;
}

TEST_F(ProgressOfARun, is_not_in_a_log) {
  const Finished finished = run_tool(arguments_);
  EXPECT_EQ(finished.code, 1);
  EXPECT_THAT(finished.out, Not(testing::ContainsRegex("[\r\x1b]")));
  EXPECT_THAT(finished.out, Not(HasSubstr("to go")));
  EXPECT_THAT(finished.out, HasSubstr("\nFAIL          xgt_cnet/many/m_wrong  "));
  EXPECT_THAT(finished.out, Not(HasSubstr("many/n1")));
  EXPECT_THAT(finished.out, HasSubstr("\n61 cases in "));
}

}  // namespace
}  // namespace fieldproof::tool_tests
