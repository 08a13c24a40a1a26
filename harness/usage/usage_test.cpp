#include "harness/usage/usage.hpp"

#include <gmock/gmock.h>
#include <CLI/CLI.hpp>

#include "harness/usage/help.hpp"
#include "harness/usage/man_page.hpp"
#include "harness/usage/option_groups.hpp"

namespace fieldproof::usage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A tool of two commands.
class Usage : public testing::Test {
 protected:
  Usage() {
    app_.footer("Exit codes: 0 good, 1 bad.");
    CLI::App* run = app_.add_subcommand("run", "Run the cases");
    run->add_option("--out", out_, "Folder of the reports")->capture_default_str();
    run->add_option("--role", role_, "Who asks")->check(CLI::IsMember({"client", "server"}));
    run->add_option("--seed", seed_, "Shuffle")->check(CLI::Range(0, 9))->group("Order");
    run->add_flag("-v,--verbose", verbose_, "Show it all; 'all' is much");
    run->add_option("--secret", role_, "Of the harness")->group("");
    run->add_option("results", files_, "Files")->required();
    app_.add_subcommand("list", "List the cases")->add_option("--filter,filter", role_, "By id");
  }

  CLI::App app_{"A tool that is tested", "tool"};
  std::string out_ = "here", role_;
  int seed_ = 0;
  bool verbose_ = false;
  std::vector<std::string> files_;
};

TEST_F(Usage, IsThatOfTheCommandLine) {
  const Command tool = usage_of(app_);
  ASSERT_TRUE(tool.command("run"));
  const Command& run = *tool.command("run");
  EXPECT_EQ(run.synopsis(), "tool run [OPTIONS] results...");
  EXPECT_EQ(tool.synopsis(), "tool [OPTIONS] COMMAND");
  EXPECT_EQ(tool.command("list")->synopsis(), "tool list [OPTIONS] [filter]");
  EXPECT_THAT(run.groups, ElementsAre("Order", "Options")) << "-h is the least";
  EXPECT_THAT(run.option("--role")->choices, ElementsAre("client", "server"));
  EXPECT_EQ(run.option("-v")->heading(), "-v, --verbose");
  EXPECT_EQ(run.option("--seed")->heading(), "--seed INT");
  EXPECT_EQ(run.option("--out")->description, "Folder of the reports (default here)");
  EXPECT_FALSE(run.option("--secret")) << "hidden";
  EXPECT_FALSE(tool.command("run it"));
}

TEST_F(Usage, HelpKeepsToItsWidth) {
  EXPECT_EQ(help_text(*usage_of(app_).command("run"), 60), R"(Run the cases

Usage: tool run [OPTIONS] results...

  results...              Files

Order:
  --seed INT              Shuffle

Options:
  -h, --help              Print this help message and exit
  --out TEXT              Folder of the reports (default
                          here)
  --role {client,server}  Who asks
  -v, --verbose           Show it all; 'all' is much

Exit codes: 0 good, 1 bad.
)");
}

TEST_F(Usage, ManPageHasEachOptionAndCommand) {
  const std::string page = man_page(usage_of(app_), {"1.2", "2026-11-23"});
  EXPECT_THAT(page, HasSubstr(".TH TOOL 1 2026-11-23 \"tool 1.2\" \"User Commands\"\n"));
  EXPECT_THAT(page, HasSubstr(".SS \"tool run [OPTIONS] results...\"\nRun the cases.\n"));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fB\\-v\\fR, \\fB\\-\\-verbose\\fR\nShow it all; "
                              "\\(aqall\\(aq is much\n"));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fIresults\\fR...\nFiles\n"));
  EXPECT_THAT(page, HasSubstr(".SH \"EXIT STATUS\"\n0 good, 1 bad.\n"));
  EXPECT_THAT(page, Not(HasSubstr("secret")));
}

TEST_F(Usage, OptionsOfRunHaveTheirGroups) {
  group_options(*app_.get_subcommand("run"));
  const Command run = *usage_of(app_).command("run");
  EXPECT_EQ(run.option("--out")->group, "Reports");
  EXPECT_EQ(run.option("--role")->group, "The device");
  EXPECT_EQ(run.option("--help")->group, "Options");
}

}  // namespace
}  // namespace fieldproof::usage
