#include "harness/usage/completion.hpp"

#include <gmock/gmock.h>

#include "harness/usage/completion_scripts.hpp"

namespace fieldproof::usage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Option takes(const std::string& name, std::vector<std::string> choices = {}) {
  Option option;
  option.names = {name};
  option.value = "TEXT";
  option.choices = std::move(choices);
  option.description = "about " + name;
  return option;
}

Option flag(const std::string& letter, const std::string& name) {
  Option option;
  option.names = {letter, name};
  return option;
}

Command tool() {
  Option model = takes("model");
  model.positional = true;
  Command run{"tool run",
              "Run it",
              "",
              {},
              {takes("--role", {"client", "server"}), takes("--filter"), takes("--out"),
               flag("-v", "--verbose")},
              {}};
  Command emulate{"tool emulate", "A device", "", {}, {model, takes("--tcp")}, {}};
  return {"tool", "", "", {}, {flag("-h", "--help")}, {run, emulate}};
}

std::vector<std::string> values(const Command&, const Option& option, const std::string&) {
  if (option.names.front() == "--filter") return {"a/", "b/"};
  if (option.names.front() == "model") return {"xbc-h", "modem"};
  return {};
}

std::vector<std::string> words_for(const std::vector<std::string>& words) {
  std::vector<std::string> found;
  for (const Candidate& one : complete(tool(), words, values)) found.push_back(one.word);
  return found;
}

TEST(Complete, Commands) {
  EXPECT_THAT(words_for({""}), ElementsAre("run", "emulate"));
  EXPECT_THAT(words_for({"e"}), ElementsAre("emulate"));
  EXPECT_THAT(words_for({"-v", "r"}), ElementsAre("run"));
  EXPECT_THAT(words_for({}), IsEmpty());
}

TEST(Complete, OptionsOfTheCommand) {
  EXPECT_THAT(words_for({"run", "--"}), ElementsAre("--role", "--filter", "--out", "--verbose"));
  EXPECT_THAT(words_for({"--h"}), ElementsAre("--help"));
  EXPECT_THAT(complete(tool(), {"run", "--ro"}, values),
              ElementsAre(Candidate{"--role", "about --role"}));
}

TEST(Complete, Values) {
  EXPECT_THAT(words_for({"run", "--role", ""}), ElementsAre("client", "server"));
  EXPECT_THAT(words_for({"run", "-v", "--role", "s"}), ElementsAre("server"));
  EXPECT_THAT(words_for({"run", "--role=c"}), ElementsAre("--role=client"));
  EXPECT_THAT(words_for({"run", "--filter", "a"}), ElementsAre("a/"));
  EXPECT_THAT(words_for({"emulate", "--tcp", "1", "x"}), ElementsAre("xbc-h"));
}

TEST(Complete, WhatTheShellKnowsBetterIsLeftToIt) {
  EXPECT_THAT(words_for({"run", "--out", "r"}), IsEmpty());
  EXPECT_THAT(words_for({"run", "--unknown="}), IsEmpty());
  EXPECT_THAT(words_for({"run", "r"}), IsEmpty()) << "it takes no more words";
}

TEST(Complete, LinesHaveADescription) {
  EXPECT_EQ(to_string({{"--role", "Who asks"}, {"a/", ""}}), "--role\tWho asks\na/\n");
}

TEST(CompletionScript, IsOfItsShellAndTool) {
  for (const std::string_view shell : shells) {
    const std::string script = completion_script(shell, "fieldproof");
    EXPECT_THAT(script, HasSubstr(std::string(shell) + " completion of fieldproof"));
    EXPECT_THAT(script, HasSubstr("__complete"));
    EXPECT_THAT(script, Not(HasSubstr("TOOL")));
  }
}

}  // namespace
}  // namespace fieldproof::usage
