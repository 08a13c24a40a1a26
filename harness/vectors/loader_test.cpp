#include "harness/vectors/loader.hpp"

#include <gmock/gmock.h>

#include <fstream>

namespace fieldproof::vectors {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string two_words = R"j({
  "id": "xgt_cnet/rss/two_words", "rev": 1, "title": "Read one word from M20 and one from P001 of station 1",
  "source": {"manual": "xgb-cnet-en-1.6", "section": "7.1.5 (1)(e)", "statement": "xgb-cnet-en-1.6/7.1.5-1e", "quote": "This example supposes when 1 WORD"},
  "level": "must", "basis": "printed",
  "given": {"config": {"station": 1}, "memory": {"%MW020": "1234"}},
  "steps": [{"send": "[ENQ st 'rSS' EOT BCC]", "wire": "05"}, {"expect": "[ACK st 'rSS' ETX BCC]"}]})j";

VectorSet load(const std::string& text, bool with_schema = true) {
  VectorSet set;
  if (with_schema) {
    std::ifstream in(std::string(FIELDPROOF_SOURCE_DIR) + "/vectors/schema.json");
    set.schema = nlohmann::json::parse(in);
  }
  load_vector_text(text, "test.json", set);
  return set;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string only_problem(const std::string& text) {
  const VectorSet set = load(text);
  EXPECT_TRUE(set.cases.empty());
  return set.problems.empty() ? "none" : set.problems.front();
}

TEST(Loader, ReadsTheDesignsExample) {
  const VectorSet set = load("[" + two_words + "]");
  ASSERT_THAT(set.problems, IsEmpty());
  ASSERT_EQ(set.cases.size(), 1u);
  const Case& one = set.cases[0];
  EXPECT_EQ(one.protocol, "xgt-cnet");
  EXPECT_EQ(one.source.statements, std::vector<std::string>{"xgb-cnet-en-1.6/7.1.5-1e"});
  ASSERT_EQ(one.steps.size(), 2u);
  EXPECT_EQ(one.steps[0].frames[0].wire, "05");
  EXPECT_FALSE(one.steps[1].frames[0].wire);
  EXPECT_EQ(one.memory[0], std::pair(std::string("%MW020"), std::string("1234")));
}

TEST(Loader, OneVectorAloneNeedsNoArray) { EXPECT_EQ(load(two_words).cases.size(), 1u); }

TEST(Loader, EachIsAProductOfRows) {
  const std::string each =
      R"j("each": {"area": [{"case": "m", "area": "M"}, {"case": "p", "area": "P"}], "command": [{"case": "lower", "r": "r"}, {"case": "upper", "r": "R"}]}, "given")j";
  std::string text = replaced(replaced(two_words, "\"given\"", each), "'rSS'", "'${r}SS'");
  text = replaced(text, "\"%MW020\"", "\"%${area}W020\"");
  const VectorSet set = load(text);
  ASSERT_THAT(set.problems, IsEmpty());
  ASSERT_EQ(set.cases.size(), 4u);
  EXPECT_EQ(set.cases[3].id, "xgt_cnet/rss/two_words/p/upper");
  EXPECT_EQ(set.cases[3].vector_id, "xgt_cnet/rss/two_words");
  EXPECT_EQ(set.cases[3].memory[0].first, "%PW020");
  EXPECT_EQ(set.cases[3].steps[0].frames[0].text, "[ENQ st 'RSS' EOT BCC]");
}

TEST(Loader, ASubstitutionWithoutItsRowIsNamed) {
  EXPECT_THAT(
      only_problem(replaced(two_words, "'rSS'", "'${r}SS'")),
      HasSubstr("test.json: xgt_cnet/rss/two_words: steps[0]: no row of `each` gives '${r}'"));
}

TEST(Loader, NamedAlternativesKeepTheirOrder) {
  const VectorSet set = load(
      replaced(two_words, "\"[ACK st 'rSS' ETX BCC]\"",
               R"j({"reading": "type_echo", "zz_first": "[ACK ETX]", "aa_second": "[ACK EOT]"})j"));
  ASSERT_THAT(set.problems, IsEmpty());
  const Step& step = set.cases[0].steps[1];
  EXPECT_EQ(step.reading, "type_echo");
  EXPECT_EQ(step.frames[0].reading, "zz_first");
  EXPECT_EQ(step.frames[1].reading, "aa_second");
}

TEST(Loader, EveryKindOfStepIsRead) {
  std::string text = two_words;
  text = replaced(
      text, R"j("steps": [)j",
      R"j("steps": [{"silence": true}, {"wait": "1.5ms"}, {"set": {"%MX00000": "01"}}, {"check": {"%MW1": "seq(2)"}}, {"do": "stop"}, )j");
  const VectorSet set = load(text);
  ASSERT_THAT(set.problems, IsEmpty());
  const std::vector<Step>& steps = set.cases[0].steps;
  EXPECT_EQ(steps[0].kind, Step::Kind::silence);
  EXPECT_EQ(steps[1].duration, 1500us);
  EXPECT_EQ(steps[2].kind, Step::Kind::set);
  EXPECT_EQ(steps[3].memory[0].second, "00010002");
  EXPECT_EQ(steps[4].action, "stop");
}

TEST(Loader, BadInputNamesFileVectorAndKey) {
  EXPECT_THAT(only_problem(replaced(two_words, "\"level\"", "\"levle\"")),
              HasSubstr("xgt_cnet/rss/two_words"));
  EXPECT_THAT(load(replaced(two_words, "\"level\": \"must\"", "\"level\": \"must\", \"colour\": 1"))
                  .problems,
              testing::Contains(HasSubstr("unknown key 'colour'")));
  EXPECT_THAT(
      only_problem(replaced(two_words, "'rSS' EOT", "'rSS' EOX")),
      HasSubstr("steps[0]: \"[ENQ st 'rSS' EOX BCC]\": cannot read the notation at column"));
  EXPECT_THAT(only_problem(replaced(two_words, "\"station\": 1", "\"station\": 256")),
              HasSubstr("given.config.station"));
  EXPECT_THAT(only_problem(replaced(two_words, "\"1234\"", "\"12G4\"")),
              HasSubstr("%MW020: '12G4' are no hex digits"));
  EXPECT_THAT(only_problem(replaced(two_words, "\"wire\": \"05\"", "\"expect\": \"ACK\"")),
              HasSubstr("a step is one of"));
  EXPECT_THAT(
      load(replaced(two_words, "\"basis\": \"printed\"", "\"basis\": \"derived\"")).problems,
      testing::Not(IsEmpty()))
      << "derived needs why";
}

TEST(Loader, TheSecondEntryFillsInWhatTheVectorDoesNotPrint) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "loader_wires";
  std::filesystem::create_directories(folder / "wires");
  std::ofstream(folder / "a.json") << two_words;
  std::ofstream(folder / "wires" / "a.json")
      << R"({"xgt_cnet/rss/two_words": {"0": "FF", "1": "06 03"}, "xgt_cnet/no/such": {"0": "05"}})";
  VectorSet set = load_vectors(folder, std::string(FIELDPROOF_SOURCE_DIR) + "/vectors/schema.json");
  load_wires(folder, set);
  ASSERT_EQ(set.cases.size(), 1u);
  EXPECT_EQ(set.cases[0].steps[0].frames[0].wire, "05") << "what is printed stays";
  EXPECT_EQ(set.cases[0].steps[1].frames[0].wire, "06 03");
  EXPECT_THAT(set.problems, ElementsAre("wires/a.json: xgt_cnet/no/such: no such case"));
  std::filesystem::remove_all(folder);
}

TEST(Loader, AFolderWithABrokenFileStillShowsTheOthers) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "loader_folder";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.json") << "[{]";
  std::ofstream(folder / "b.json") << two_words;
  std::ofstream(folder / "c.json") << two_words;
  const VectorSet set =
      load_vectors(folder, std::string(FIELDPROOF_SOURCE_DIR) + "/vectors/schema.json");
  EXPECT_EQ(set.cases.size(), 2u);
  EXPECT_THAT(set.problems, ElementsAre(HasSubstr("a.json: "),
                                        HasSubstr("the id xgt_cnet/rss/two_words is used twice")));
  std::filesystem::remove_all(folder);
}

TEST(Loader, OneFileAloneCanBeLoaded) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "one_vector.json";
  std::ofstream(file) << two_words;
  EXPECT_EQ(
      load_vectors(file, std::string(FIELDPROOF_SOURCE_DIR) + "/vectors/schema.json").cases.size(),
      1u);
  std::filesystem::remove(file);
}

TEST(Loader, AnAbsentFolderSaysWhatToDo) {
  EXPECT_THAT(load_vectors("no/such/folder").problems,
              ElementsAre(HasSubstr("name their folder, or one file, with --vectors")));
}

TEST(Filter, GlobsCrossSlashesAndExclude) {
  EXPECT_TRUE(matches_filter("a/b/c", ""));
  EXPECT_TRUE(matches_filter("a/b/c", "a/*"));
  EXPECT_TRUE(matches_filter("a/b/c", "x:*c"));
  EXPECT_TRUE(matches_filter("a/b/c", "a/?/c"));
  EXPECT_FALSE(matches_filter("a/b/c", "a/b"));
  EXPECT_FALSE(matches_filter("a/b/c", "a/*:-*c"));
  EXPECT_TRUE(matches_filter("a/b/d", "-*c"));
}

TEST(ConfigStation, IsANumberOrItsDigits) {
  EXPECT_EQ(config_station({{"station", 255}}, 1), 255);
  EXPECT_EQ(config_station({{"station", "32"}}, 1), 32);
  EXPECT_EQ(config_station(nlohmann::json::object(), 7), 7);
  EXPECT_FALSE(config_station({{"station", "x"}}, 1));
  EXPECT_FALSE(config_station({{"station", -1}}, 1));
}

}  // namespace
}  // namespace fieldproof::vectors
