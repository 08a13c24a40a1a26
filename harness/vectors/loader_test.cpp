#include "harness/vectors/loader.hpp"

#include <gmock/gmock.h>

#include <array>
#include <fstream>

#include "harness/test_protocol.hpp"

namespace fieldproof::vectors::loader_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string two_words = R"j({
  "id": "xgt_cnet/rss/two_words", "rev": 1, "title": "Read one word from M20 and one from P001 of station 1",
  "statement": "xgb-cnet-en-1.6/7.1.5-1e", "source": {"manual": "xgb-cnet-en-1.6", "section": "7.1.5 (1)(e)", "quote": "This example supposes when 1 WORD"},
  "level": "must", "basis": "printed",
  "given": {"config": {"station": 1}, "memory": {"%MW020": "1234"}},
  "steps": [{"send": "[ENQ st 'rSS' EOT BCC]", "wire": "05"}, {"expect": "[ACK st 'rSS' ETX BCC]"}]})j";

VectorSet load(const std::string& text, const LoadOptions& options = {}) {
  VectorSet set;
  load_vector_text(text, "test.json", set, options);
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
      HasSubstr("test.json:1: xgt_cnet/rss/two_words: steps[0]: no row of `each` gives '${r}'"));
}

TEST(Loader, NamedAlternativesKeepTheirOrder) {
  const VectorSet set = load(
      replaced(two_words, "\"[ACK st 'rSS' ETX BCC]\"",
               R"j({"reading": "type_echo", "zz_first": "[ACK ETX]", "aa_second": "[ACK EOT]"})j"));
  ASSERT_THAT(set.problems, IsEmpty());
  const Step& step = set.cases[0].steps[1];
  EXPECT_EQ(step.reading, "type_echo");
  EXPECT_EQ(step.frames[0].alternative, "zz_first");
  EXPECT_EQ(step.frames[1].alternative, "aa_second");
}

TEST(Loader, ACheckMayHaveNamedAlternatives) {
  const auto with = [](const std::string& check) {
    return replaced(two_words, R"j("steps": [)j", R"j("steps": [{"check": )j" + check + "}, ");
  };
  const VectorSet set = load(with(
      R"j({"reading": "stop", "past": {"SD2": "dec32(5)"}, "back": {"SD2": "dec32(1..2)"}})j"));
  ASSERT_THAT(set.problems, IsEmpty());
  const Step& step = set.cases[0].steps[0];
  EXPECT_EQ(step.reading, "stop");
  EXPECT_THAT(alternatives_of(step), testing::ElementsAre("past", "back"));
  EXPECT_EQ(step.memory[0].second, "00050000") << "the preferred one";
  EXPECT_EQ(step.alternatives[1].digits[0], "00010000");
  EXPECT_THAT(only_problem(with(R"j({"past": {"SD2": "01"}})j")),
              HasSubstr("'past': named alternatives need a \"reading\""));
  EXPECT_THAT(only_problem(with(R"j({"reading": "stop", "past": {"SD2": "01"}})j")),
              HasSubstr("reading 'stop' has one alternative"));
  EXPECT_THAT(
      only_problem(with(R"j({"reading": "stop", "past": {"SD2": "01"}, "back": {"SD4": "01"}})j")),
      HasSubstr("alternative 'back' has other addresses than the first"));
  EXPECT_THAT(only_problem(with(R"j({"reading": "stop", "past": "01", "back": {"SD4": "01"}})j")),
              HasSubstr("alternative 'past' is no object of addresses and values"));
}

// A client's transaction is captured in one step and answered in another.
TEST(Loader, WhatOneFrameCapturesIsAsLongInTheNext) {
  std::string text = two_words;
  text = replaced(text, R"j({"expect": "[ACK st 'rSS' ETX BCC]"})j",
                  R"j({"expect": "[{t:2} 00 {u:1}]"}, {"send": "[{t} 00 {u} {v}]"})j");
  const VectorSet set = load(text);
  ASSERT_THAT(set.problems, IsEmpty());
  const notation::Notation& answer = set.cases[0].steps[2].frames[0].notation;
  EXPECT_EQ(answer[1].number, 2);
  EXPECT_EQ(answer[3].number, 1);
  EXPECT_EQ(answer[4].number, 0) << "nobody has captured it";
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

TEST(Loader, NumbersAreWrittenAsTheManualWritesThem) {
  const std::string text = replaced(
      replaced(two_words, "\"1234\"", "\"dec32(100000)\""), R"j("steps": [)j",
      R"j("steps": [{"set": {"D0": "float(0.5)"}}, {"check": {"D0": "dec32(631..641)", "D2": "0001"}}, )j");
  const VectorSet set = load(text);
  ASSERT_THAT(set.problems, IsEmpty());
  EXPECT_EQ(set.cases[0].memory[0].second, "86A00001");
  EXPECT_EQ(set.cases[0].steps[0].memory[0].second, "00003F00");
  const Step& check = set.cases[0].steps[1];
  ASSERT_EQ(check.numbers.size(), 2u);
  EXPECT_TRUE(check.numbers[0]->is_range());
  EXPECT_FALSE(check.numbers[1]);
  EXPECT_THAT(only_problem(replaced(two_words, "\"1234\"", "\"dec(1..2)\"")),
              HasSubstr("is a range; only a check may have one"));
}

TEST(Loader, WhatIsOfAModelHasNoStepOnAWire) {
  const std::string kind = replaced(two_words, "\"level\"", "\"kind\": \"register\", \"level\"");
  EXPECT_THAT(only_problem(kind), HasSubstr("kind 'register' is of a model"));
  const std::string steps =
      kind.substr(0, kind.find("\"steps\"")) + R"j("steps": [{"check": {"%MW020": "1234"}}]})j";
  EXPECT_EQ(load(steps).cases.at(0).on_model, "register");
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
  const auto wait_with = [](const std::string& option) {
    return only_problem(
        replaced(two_words, "\"steps\": [", "\"steps\": [{\"wait\": \"1s\", " + option + "},"));
  };
  EXPECT_THAT(wait_with("\"within\": \"1s\""), HasSubstr("steps[0]: \"within\" is an option of"));
  EXPECT_THAT(wait_with("\"every\": \"1s\""), HasSubstr("\"every\" is an option of expect alone"));
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
  VectorSet set = load_vectors(folder);
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
  const VectorSet set = load_vectors(folder);
  EXPECT_EQ(set.cases.size(), 2u);
  EXPECT_THAT(set.problems, ElementsAre(HasSubstr("a.json: "),
                                        HasSubstr("the id xgt_cnet/rss/two_words is used twice")));
  std::filesystem::remove_all(folder);
}

TEST(Loader, OneFileAloneCanBeLoaded) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "one_vector.json";
  std::ofstream(file) << two_words;
  EXPECT_EQ(load_vectors(file).cases.size(), 1u);
  std::filesystem::remove(file);
}

TEST(Loader, AnAbsentFolderSaysWhatToDo) {
  EXPECT_THAT(load_vectors("no/such/folder").problems,
              ElementsAre(HasSubstr("name their folder, or one file, with --vectors")));
}

/// Two protocols that frame a shared body, and one that does not.
struct Framed : harness::TestProtocol {
  Framed(std::string_view name, const notation::Dressing* dressing)
      : name_(name), dressing_(dressing) {}
  std::string_view name() const override { return name_; }
  const notation::Dressing* dressing() const override { return dressing_; }

 private:
  std::string_view name_;
  const notation::Dressing* dressing_;
};
constexpr notation::Dressing binary_dressing{"[${station} ${body} CRC${wrong}]", false};
constexpr notation::Dressing text_dressing{"[':' ${station} ${body} CR]", true};
const Framed binary("one-binary", &binary_dressing), text("one-text", &text_dressing);
const Framed plain("plain", nullptr);
const std::array<const harness::Protocol*, 3> protocol_table{&plain, &binary, &text};
const harness::Protocols protocols(protocol_table);

const std::string shared = R"j({
  "id": "one/read/word", "rev": 1, "framings": ["one_binary", "one_text"], "title": "Read the word ${a}",
  "statement": ["m/1"], "source": {"manual": "m", "section": "1", "quote": "as it is printed"},
  "level": "must", "basis": "printed",
  "each": {"address": [{"case": "low", "a": "00 01"}, {"case": "high", "a": "01 00"}]},
  "differs": {"one_text": {"statement": ["m/2", "m/1"], "basis": "derived", "why": "the same in digits"}},
  "steps": [{"send": "pdu(03 ${a})", "wire": {"one_binary": "01 03"}}, {"expect": "pdu(83 ??)"}]})j";

TEST(Framings, GiveACaseEachUnderTheirIds) {
  const VectorSet set = load(shared, {protocols});
  ASSERT_THAT(set.problems, IsEmpty());
  std::vector<std::string> ids;
  for (const Case& one : set.cases) ids.push_back(one.id);
  EXPECT_THAT(ids, ElementsAre("one_binary/read/word/low", "one_binary/read/word/high",
                               "one_text/read/word/low", "one_text/read/word/high"));
  EXPECT_EQ(set.cases[0].vector_id, "one_binary/read/word");
  EXPECT_EQ(set.cases[3].protocol, "one-text");
}

TEST(Framings, DressTheBody) {
  const VectorSet set = load(shared, {protocols});
  EXPECT_EQ(set.cases[0].steps[0].frames[0].text, "[st 03 00 01 CRC]");
  EXPECT_EQ(set.cases[3].steps[0].frames[0].text, "[':' st '030100' CR]");
  EXPECT_EQ(set.cases[3].steps[1].frames[0].text, "[':' st '83' x:2 CR]");
}

constexpr notation::Dressing four_forms{.frame = "[01 ${body}]",
                                        .reply_of_device = "[02 ${body}]",
                                        .request_of_device = "[03 ${body}]",
                                        .reply_of_bench = "[04 ${body}]"};

TEST(Framings, MayDependOnWhoSpeaks) {
  const Framed four("four-forms", &four_forms);
  const std::array<const harness::Protocol*, 1> table{&four};
  const auto frames = [&](const std::string& role) {
    const std::string vector =
        R"j({"id": "four_forms/one", "title": "Who speaks is told", "statement": ["m/1"],
      "source": {"manual": "m", "section": "1", "quote": "as it is printed"}, "level": "must",
      "basis": "printed rule", "given": {"config": {"role": ")j" +
        role + R"j("}},
      "steps": [{"send": "pdu(07)"}, {"expect": "pdu(08)"}]})j";
    const VectorSet set = load(vector, {harness::Protocols(table)});
    EXPECT_THAT(set.problems, IsEmpty());
    return set.cases.at(0).steps[0].frames[0].text + set.cases.at(0).steps[1].frames[0].text;
  };
  EXPECT_EQ(frames("server"), "[01 07][02 08]");
  EXPECT_EQ(frames("client"), "[04 07][03 08]");
}

TEST(Framings, MayRestOnOtherSentencesStepByStep) {
  const auto with_clauses = [](const std::string& clauses) {
    std::string vector = shared;
    const std::string why = "\"why\": \"the same in digits\"";
    vector.replace(vector.find(why), why.size(),
                   why + ", \"models\": [\"m-1\"], \"clauses\": " + clauses);
    return load(vector, {protocols});
  };
  const VectorSet set = with_clauses(R"({"1": ["m/3", "m/1"]})");
  ASSERT_THAT(set.problems, IsEmpty());
  EXPECT_THAT(set.cases[0].steps[1].source.statements, IsEmpty());
  EXPECT_THAT(set.cases[2].steps[1].source.statements, ElementsAre("m/3", "m/1"));
  EXPECT_THAT(set.cases[0].models, IsEmpty());
  EXPECT_THAT(set.cases[2].models, ElementsAre("m-1"));
  EXPECT_THAT(with_clauses(R"({"2": "m/3"})").problems,
              ElementsAre(HasSubstr("differs: clauses: there is no step '2'; the first is 0")));
}

TEST(Framings, HaveTheirOwnBytesAndSources) {
  const VectorSet set = load(shared, {protocols});
  EXPECT_EQ(set.cases[0].steps[0].frames[0].wire, "01 03");
  EXPECT_FALSE(set.cases[2].steps[0].frames[0].wire);
  EXPECT_EQ(set.cases[0].source.statements, std::vector<std::string>{"m/1"});
  EXPECT_THAT(set.cases[2].source.statements, ElementsAre("m/2", "m/1"));
  EXPECT_EQ(set.cases[0].basis, "printed");
  EXPECT_EQ(set.cases[2].basis, "derived");
  EXPECT_EQ(set.cases[2].why, "the same in digits");
}

TEST(Framings, WhatTheyCannotBeIsNamed) {
  const auto problems = [](const std::string& from, const std::string& to) {
    return load(replaced(shared, from, to), {protocols}).problems;
  };
  EXPECT_THAT(problems("\"one_text\"]", "\"one_txt\"]"),
              ElementsAre(HasSubstr("differs: 'one_text' is none of its framings")));
  EXPECT_THAT(problems("\"one_text\"]", "\"one_text\", \"plain\"]"),
              ElementsAre(HasSubstr("no protocol frames a shared body as 'plain'")));
  EXPECT_THAT(problems("{\"one_binary\": \"01 03\"}", "{\"one_binry\": \"01 03\"}"),
              ElementsAre(HasSubstr("steps[0].wire: 'one_binry' is none of its framings")));
  EXPECT_THAT(problems("{\"one_binary\": \"01 03\"}", "\"01 03\""),
              ElementsAre(HasSubstr("steps[0].wire: say of which framing these bytes are")));
  EXPECT_THAT(problems("\"why\": \"the same in digits\"", "\"title\": \"another title\""),
              ElementsAre("test.json:1: one/read/word: differs.one_text: lacks 'why'"));
}

TEST(Framings, ABodyWithoutThemIsThatOfTheProtocol) {
  EXPECT_EQ(load(replaced(two_words, "[ENQ st 'rSS' EOT BCC]", "pdu(07)"), {}).problems.front(),
            "test.json:1: xgt_cnet/rss/two_words: steps[0]: \"pdu(07)\": this protocol frames no "
            "pdu(...); write the whole frame, or name the `framings` of the vector");
  std::string own = replaced(two_words, "xgt_cnet/rss", "one_binary/rss");
  own = replaced(own, "[ENQ st 'rSS' EOT BCC]", "pdu@02!(07)");
  EXPECT_EQ(load(own, {protocols}).cases.at(0).steps[0].frames[0].text, "[02 07 CRC!]");
}

TEST(Filter, LeavesTheOtherCasesUnread) {
  const std::string broken = R"j({"id": "xgt_cnet/broken/one", "colour": 1})j";
  const std::string all = "[" + two_words + "," + broken + "," + shared + "]";
  EXPECT_THAT(load(all, {protocols}).problems, testing::Not(IsEmpty()));
  const VectorSet set = load(all, {protocols, "one_text/*low"});
  EXPECT_THAT(set.problems, IsEmpty());
  ASSERT_EQ(set.cases.size(), 1u);
  EXPECT_EQ(set.cases[0].id, "one_text/read/word/low");
  EXPECT_EQ(load(all, {protocols, "xgt_cnet/rss/*"}).cases.size(), 1u);
  EXPECT_THAT(load(all, {protocols, "*one"}).problems, testing::Not(IsEmpty()));
}

TEST(Filter, LeavesStatementsThatNoCaseCites) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "loader_cited";
  std::filesystem::create_directories(folder / "statements");
  std::ofstream(folder / "a.json") << "[" << two_words << "," << shared << "]";
  std::ofstream(folder / "statements" / "m.json")
      << R"([{"id": "m/1", "section": "1", "quote": "q"}, {"id": "m/2", "section": "2", "quote": "r"}])";
  EXPECT_EQ(load_vectors(folder, {protocols}).statements.size(), 2u);
  const VectorSet set = load_vectors(folder, {protocols, "one_text/*"});
  EXPECT_EQ(set.statements.size(), 2u) << "both are cited";
  EXPECT_EQ(load_vectors(folder, {protocols, "one_binary/*"}).statements.size(), 1u);
  EXPECT_EQ(set.hash, load_vectors(folder, {protocols}).hash) << "of all files, whatever is read";
  std::filesystem::remove_all(folder);
}

TEST(Loader, OneCommaTooMuchIsOneProblemAtItsLine) {
  for (const char* broken :
       {"[\n{\"id\": \"a/b\"},\n,{}]", "[\n{\"id\": \"a/b\",\n,\"rev\": 1}]"}) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "comma.json";
    std::ofstream(file) << broken;
    EXPECT_THAT(load_vectors(file).problems,
                ElementsAre(testing::AllOf(HasSubstr("comma.json: "), HasSubstr("line 3"))))
        << broken;
    std::filesystem::remove(file);
  }
}

TEST(Loader, AVectorIsNamedByItsLine) {
  EXPECT_THAT(load("[\n" + two_words + ",\n{\"rev\": \"first\"}]").problems,
              testing::Contains("test.json:8: a vector: rev: is \"first\"; write a whole number"));
}

TEST(ConfigStation, IsANumberOrItsDigits) {
  EXPECT_EQ(config_station({{"station", 255}}, 1), 255);
  EXPECT_EQ(config_station({{"station", "32"}}, 1), 32);
  EXPECT_EQ(config_station(nlohmann::json::object(), 7), 7);
  EXPECT_FALSE(config_station({{"station", "x"}}, 1));
  EXPECT_FALSE(config_station({{"station", -1}}, 1));
}

}  // namespace
}  // namespace fieldproof::vectors::loader_test
