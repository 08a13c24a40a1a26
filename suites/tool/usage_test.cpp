// Completion and man page, as they are installed.
#include <gmock/gmock.h>

#include <regex>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

bool is_there(const std::string& program) {
  return run_program({"sh", "-c", "command -v " + program}).code == 0;
}

class Usage : public testing::Test {
 protected:
  Usage() {
    std::filesystem::create_directory(folder_ / "bin");
    std::filesystem::create_symlink(FIELDPROOF_TOOL, folder_ / "bin/fieldproof");
  }

  /// With the tool on its path.
  Finished in_shell(std::vector<std::string> command) const {
    command.insert(command.begin(),
                   {"env", "PATH=" + (folder_ / "bin") + ':' + std::getenv("PATH")});
    return run_program(std::move(command), {.environment = {}, .folder = folder_.path()});
  }

  std::string script(const std::string& shell) const {
    const Finished finished = run_tool({"completion", shell});
    EXPECT_EQ(finished.code, 0) << finished.err;
    return folder_.write("fieldproof." + shell, finished.out);
  }

  /// What bash offers behind this line.
  std::vector<std::string> in_bash(const std::string& line) const {
    const std::string call = "source " + script("bash") +
                             "; COMP_LINE=$1 COMP_POINT=${#1}; _fieldproof fieldproof 2>&1; "
                             "for one in \"${COMPREPLY[@]}\"; do printf '%s\\n' \"$one\"; done";
    return text_lines(in_shell({"bash", "-c", call, "bash", line}).out);
  }

  TestFolder folder_;
};

TEST_F(Usage, bash_is_told_how_to_complete) {
  EXPECT_EQ(in_shell({"bash", "-c", "source " + script("bash") + "; complete -p fieldproof"}).out,
            "complete -o default -F _fieldproof fieldproof\n");
}

TEST_F(Usage, bash_completes_commands_options_and_values) {
  EXPECT_THAT(in_bash("fieldproof "), AllOf(Contains("run"), Contains("completion")));
  EXPECT_THAT(in_bash("fieldproof run --allow-"), ElementsAre("--allow-write", "--allow-motion"));
  EXPECT_THAT(in_bash("fieldproof run --role "), ElementsAre("client", "server"));
  EXPECT_THAT(in_bash("fieldproof run --profile xbc-"), Contains("xbc-h"));
  EXPECT_THAT(in_bash("fieldproof run --endpoint 'exec:./a b' --protocol modbus-"),
              Contains("modbus-rtu"));
  EXPECT_THAT(in_bash("fieldproof run --out o"), IsEmpty()) << "files are bash's";
}

TEST_F(Usage, bash_completes_ids_of_cases) {
  EXPECT_THAT(in_bash("fieldproof list xgt_cnet/"), Contains("xgt_cnet/rss/"));
  EXPECT_THAT(in_bash("fieldproof run --filter xgt_cnet/rss/two_words/"),
              ElementsAre("xgt_cnet/rss/two_words/lower", "xgt_cnet/rss/two_words/upper"));
  // Behind ':' and '=', where bash begins a word of its own.
  EXPECT_THAT(in_bash("fieldproof run --filter=modbus_rtu/*:xgt_cnet/rs"),
              Contains("xgt_cnet/rss/"));
}

TEST_F(Usage, fish_completes) {
  if (!is_there("fish")) GTEST_SKIP() << "fish is not installed";
  const Finished finished =
      in_shell({"fish", "--no-config", "-c",
                "source " + script("fish") + "; complete -C 'fieldproof run --role '"});
  EXPECT_THAT(text_lines(finished.out), ElementsAre("client", "server")) << finished.err;
}

/// What zsh itself does with the words is not ours: its functions print what they are given.
TEST_F(Usage, zsh_completes) {
  if (!is_there("zsh")) GTEST_SKIP() << "zsh is not installed";
  const auto offered = [this](const std::string& words) {
    const std::string call =
        "compdef() { :; }; _files() { print files; }; compadd() { print -l -- ${@[4,-1]}; }; "
        "_describe() { print -l -- ${(P)2}; }; source " +
        script("zsh") + "; words=(" + words + "); CURRENT=$#words; _fieldproof";
    const Finished finished = in_shell({"zsh", "-f", "-c", call});
    EXPECT_EQ(finished.err, "");
    return text_lines(finished.out);
  };
  EXPECT_THAT(offered("fieldproof run --role ''"), ElementsAre("client", "server"));
  EXPECT_THAT(offered("fieldproof run --filter xgt_cnet/rs"), Contains("xgt_cnet/rss/"));
  EXPECT_THAT(offered("fieldproof run --read-"), ElementsAre(StartsWith("--read-only:Write")));
  EXPECT_THAT(offered("fieldproof run --out o"), ElementsAre("files"));
}

TEST_F(Usage, version_names_vectors_and_libraries) {
  const std::string version = run_tool({"--version"}).out;
  EXPECT_THAT(version, StartsWith("fieldproof " FIELDPROOF_VERSION " ("));
  EXPECT_EQ(
      run_tool({"run", "--filter", "xgt_cnet/rss/two_words/*", "--out", folder_ / "out"}).code, 0);
  const std::string hash = read_results(folder_ / "out/results.ndjson").run.at("vectors_hash");
  EXPECT_THAT(version, HasSubstr("\nvectors     " + hash + '\n'));
  for (const char* name : {"compiler", "Boost 1.", "CLI11 ", "fmt ", "GoogleTest ",
                           "nlohmann-json ", "OpenSSL ", "pugixml "})
    EXPECT_THAT(version, testing::ContainsRegex(std::string(name) + "[^,]*[0-9]")) << name;
}

TEST_F(Usage, the_man_page_is_sound) {
  const std::string page = folder_.write("fieldproof.1", run_tool({"man"}).out);
  bool checked = false;
  for (const std::vector<std::string>& check : std::vector<std::vector<std::string>>{
           {"groff", "-man", "-ww", "-z", page}, {"mandoc", "-Tlint", page}}) {
    if (!is_there(check.front())) continue;
    checked = true;
    const Finished finished = run_program(check);
    EXPECT_EQ(finished.out + finished.err, "") << check.front();
  }
  if (!checked) GTEST_SKIP() << "neither groff nor mandoc is installed";
}

TEST_F(Usage, the_man_page_has_every_option_of_every_help) {
  std::string page = run_tool({"man"}).out;
  std::erase(page, '\\');
  const std::regex command("\n  ([a-z]+) "), option("\n  (?:-[a-z], )?(--[a-z0-9-]+)");
  const std::string help = run_tool({"--help"}).out;
  std::size_t commands = 0, options = 0;
  const std::string listed = help.substr(help.find("\nCommands:"));
  for (std::sregex_iterator one(listed.begin(), listed.end(), command), end; one != end; ++one) {
    const std::string name = (*one)[1];
    const std::size_t begin = page.find(".SS \"fieldproof " + name + ' ');
    ASSERT_NE(begin, std::string::npos) << name;
    const std::string section = page.substr(begin, page.find("\n.S", begin + 1) - begin);
    const std::string its_help = run_tool({name, "--help"}).out;
    for (std::sregex_iterator at(its_help.begin(), its_help.end(), option); at != end; ++at) {
      EXPECT_THAT(section, HasSubstr("fB" + (*at)[1].str() + "fR")) << name;
      ++options;
    }
    ++commands;
  }
  EXPECT_GT(commands, 13u);
  EXPECT_GT(options, 100u);
}

}  // namespace
}  // namespace fieldproof::tool_tests
