#include "harness/vectors/lint/citation_rules.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace fieldproof::vectors::citation_rules_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
namespace fs = std::filesystem;

/// Two vectors: a read that cites the row of its reply, a client that looks at a flag.
VectorSet two_vectors() {
  VectorSet set;
  load_vector_text(R"j([
    {"id": "xgt_cnet/read", "title": "a read of one element", "level": "must", "basis": "derived", "why": "it follows", "decision": ["cnet/order"],
     "statement": ["m/title", "m/read-${type}"], "each": {"type": [{"case": "bit", "type": "bit", "t": "00"}, {"case": "word", "type": "word", "t": "02"}]},
     "steps": [{"send": "[54 ${t}]"}, {"expect": {"reading": "r", "long": "[55 ${t}]", "short": "[56]"}}]},
    {"id": "xgt_cnet/client/flag", "title": "a flag of a block", "level": "must", "basis": "printed rule", "statement": "m/title",
     "given": {"config": {"role": "client"}},
     "steps": [{"expect": "[54 00]"}, {"check": {"%LW512": "0001"}, "clause": "m/flag-ndr"}]}])j",
                   "f.json", set);
  EXPECT_THAT(set.problems, IsEmpty());
  for (const char* id : {"m/title", "m/read-bit", "m/read-word", "m/flag-ndr", "m/reply"})
    set.statements.push_back({id, "m", "1", "one two three four five", ""});
  set.decisions = {{"cnet/order", "One."}, {"cnet/other", "Two."}};
  return set;
}

/// What lint says of these rules, each without its braces.
std::vector<std::string> said(const std::vector<std::string>& rules) {
  const fs::path folder = fs::path(testing::TempDir()) / "citation_rules";
  fs::create_directories(folder / "citations");
  std::ofstream file(folder / "citations/r.json");
  for (std::size_t i = 0; i < rules.size(); ++i) file << (i ? ",\n{" : "[\n{") << rules[i] << '}';
  file << "]\n";
  file.close();
  return lint_citation_rules(folder, two_vectors());
}

TEST(CitationRules, AskForAStatementWhereAStepSaysSomething) {
  const std::string read =
      R"("rule": "read", "step": "send", "matches": "^\\[54 00", "says": "the type that is read", )";
  EXPECT_THAT(said({read + R"("cite": ["m/read-bit"])"}), IsEmpty());
  EXPECT_THAT(said({read + R"("cite": ["m/reply", "m/read-*"])"}),
              ElementsAre("f.json: xgt_cnet/read/bit: the type that is read: cites no m/reply "
                          "(read, citations/r.json:2)"));
  EXPECT_THAT(said({read + R"("cite": [["m/reply", "m/read-bit"]])"}), IsEmpty());
  EXPECT_THAT(said({read + R"("cite": [["m/reply", "m/read-word"]])"}),
              ElementsAre(HasSubstr("cites no m/reply or m/read-word")));
}

TEST(CitationRules, LookAtAllAlternativesAndAtWhatIsInMemory) {
  EXPECT_THAT(
      said(
          {R"("rule": "a", "step": "expect", "matches": "56", "says": "the short reply", "cite": ["m/reply"])"}),
      ElementsAre(HasSubstr("xgt_cnet/read/bit: the short reply")))
      << "both cases of the vector lack the same: that is told once";
  EXPECT_THAT(
      said(
          {R"("rule": "a", "step": "check", "matches": "%LW512=0001", "says": "a flag of P2P", "cite": ["m/flag-ndr"])"}),
      IsEmpty());
  EXPECT_THAT(
      said(
          {R"("rule": "a", "step": ["set", "check"], "matches": "^%LW512=", "says": "a flag of P2P", "cite": ["m/reply"])"}),
      ElementsAre(HasSubstr("xgt_cnet/client/flag: a flag of P2P: cites no m/reply")));
}

TEST(CitationRules, AskForDecisions) {
  const std::string read =
      R"("rule": "a", "step": "send", "matches": "54", "says": "what is decided", )";
  EXPECT_THAT(said({read + R"("decide": ["cnet/order"])"}), IsEmpty());
  EXPECT_THAT(said({read + R"("cite": ["m/reply"], "decide": ["cnet/other"])"}),
              ElementsAre(HasSubstr("cites no m/reply, names no decision cnet/other")));
}

TEST(CitationRules, AreForSomeCasesOrOneRole) {
  const std::string any =
      R"("rule": "a", "step": ["send", "expect"], "matches": "54 00", "says": "what is read", "cite": ["m/reply"])";
  EXPECT_THAT(said({any}), SizeIs(2));
  EXPECT_THAT(said({any + R"(, "role": "client")"}), ElementsAre(HasSubstr("client/flag")));
  EXPECT_THAT(said({any + R"(, "cases": "*:-*/client/*")"}), ElementsAre(HasSubstr("read/bit")));
}

/// What is done to search fewer places changes no answer.
TEST(CitationRules, FindWhatTheirPatternFindsAnywhere) {
  const auto said_of = [](const std::string& pattern) {
    return said({R"("rule": "a", "step": "send", "matches": ")" + pattern +
                 R"(", "says": "what is read", "cite": ["m/reply"])"});
  };
  for (const char* pattern : {"^\\\\[54 0[012]", "^\\\\[?5*4", "^(\\\\[54|nothing) 0",
                              "^nothing|4 00", "^\\\\[5+4", "^\\\\S54", "^[|]|00", "(^x|^.54)"})
    EXPECT_THAT(said_of(pattern),
                ElementsAre(HasSubstr("xgt_cnet/read/bit: what is read: cites no m/reply")))
        << pattern;
  for (const char* pattern : {"^54 00", "^\\\\[55", "^\\\\[54 00$"})
    EXPECT_THAT(said_of(pattern), ElementsAre(HasSubstr("no step of a case matches"))) << pattern;
}

TEST(CitationRules, ThatAreWrongAreNamed) {
  const std::string good =
      R"("rule": "a", "step": "send", "matches": "54", "says": "what is read", "cite": ["m/title"])";
  EXPECT_THAT(said({good, good}), ElementsAre("citations/r.json:3: the rule a stands twice"));
  EXPECT_THAT(
      said(
          {R"("rule": "a", "step": "send", "matches": "99", "says": "what is read", "cite": ["m/title"])"}),
      ElementsAre(HasSubstr("r.json:2: a: no step of a case matches '99'")));
  EXPECT_THAT(
      said(
          {R"("rule": "a", "step": "send", "matches": "54", "says": "what is read", "cite": [["m/title", "m/titel"]])"}),
      ElementsAre(HasSubstr("a: no statement 'm/titel'")));
  EXPECT_THAT(
      said(
          {R"("rule": "a", "step": "send", "matches": "54", "says": "what is read", "decide": ["cnet/o"])"}),
      ElementsAre(HasSubstr("no decision 'cnet/o'"), HasSubstr("names no decision")));
  EXPECT_THAT(
      said(
          {R"("rule": "a", "step": "send", "matches": "(54", "says": "what is read", "cite": ["m/title"])"}),
      ElementsAre(HasSubstr("matches: '(54' is no regular expression")));
  EXPECT_THAT(said({R"("rule": "a", "step": "send", "matches": "54", "says": "what is read")"}),
              ElementsAre(HasSubstr("asks for nothing")));
  EXPECT_THAT(
      said(
          {R"("rule": "a", "step": "sent", "matches": "54", "says": "what is read", "cite": ["m/title"])"}),
      ElementsAre(HasSubstr("did you mean 'send'?")));
}

}  // namespace
}  // namespace fieldproof::vectors::citation_rules_test
