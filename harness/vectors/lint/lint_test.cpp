#include "harness/vectors/lint/lint.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>

#include "harness/test_protocol.hpp"
#include "suites/checks/checks.hpp"

namespace fieldproof::vectors {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct StationOnly : harness::TestProtocol {
  notation::Checks checks() const override { return {&checks::bcc, 1}; }
  Status check_table(const nlohmann::json& facts) const override {
    return facts.at("words") == 1024 ? ok() : Status(fail("the table has 1024 words"));
  }
};

const StationOnly protocol;
const std::array<const harness::Protocol*, 1> table{&protocol};

VectorSet with_step(const std::string& step, const std::string& services = "{}") {
  VectorSet set;
  load_vector_text(
      R"j([{"id": "xgt_cnet/a/b", "rev": 1, "title": "what is tested", "level": "must", "basis": "printed rule",
    "statement": "m/1", "source": {"manual": "m", "section": "1", "quote": "one two three four five"},
    "given": {"config": {"station": 32, "services": )j" +
          services + R"j(}}, "steps": [)j" + step + "]}]",
      "f.json", set);
  set.manuals.push_back({"m", "m.txt", "M", "1"});
  set.statements.push_back({"m/1", "m", "1", "one two three four five", ""});
  EXPECT_THAT(set.problems, IsEmpty());
  return set;
}

std::vector<std::string> wires(const std::string& step) {
  return lint_wires(with_step(step), harness::Protocols(table));
}

struct Networked : harness::TestProtocol {
  std::string_view name() const override { return "networked"; }
  std::uint16_t default_port() const override { return 502; }
};

std::vector<std::string> links(const std::string& steps) {
  static const Networked networked;
  static const std::array<const harness::Protocol*, 2> both{&protocol, &networked};
  return lint_links(with_step(steps, R"({"networked": {}})"), harness::Protocols(both));
}

TEST(LintLinks, ASerialLineIsNeitherOpenedNorClosed) {
  EXPECT_THAT(links(R"j({"send": "ENQ"}, {"expect_close": "fin", "within": "1s"})j"),
              ElementsAre(HasSubstr("f.json: xgt_cnet/a/b: steps[1]: xgt-cnet runs on a serial "
                                    "line, which neither side can close; take \"expect_close\" "
                                    "out, or name a link of a protocol of a network (\"on\")")));
  EXPECT_THAT(links(R"j({"close": "rst"})j"), ElementsAre(HasSubstr("take \"close\" out")));
  EXPECT_THAT(links(R"j({"open": "a"})j"), ElementsAre(HasSubstr("which is always open")));
}

TEST(LintLinks, AnotherServiceOfTheDeviceMayHaveConnections) {
  EXPECT_THAT(
      links(R"j({"open": {"name": "a", "protocol": "networked"}}, {"close": "fin", "on": "a"},
                        {"expect_close": "any", "on": "a", "within": "1s"})j"),
      IsEmpty());
  EXPECT_THAT(links(R"j({"open": {"name": "a", "protocol": "networked"}},
                        {"open": {"name": "b", "protocol": "xgt-cnet"}},
                        {"close": "fin", "on": "b"})j"),
              ElementsAre(HasSubstr("steps[2]: xgt-cnet runs on a serial line")));
}

// Cnet EN 7.1.5 (1)(b): the worked example whose BCC is A4.
TEST(LintWires, AgreesWithTheManualsBytes) {
  EXPECT_THAT(
      wires(
          R"j({"send": "[ENQ st 'rSS' '01' name(%MW100) EOT BCC]", "wire": "05 32 30 72 53 53 30 31 30 36 25 4D 57 31 30 30 04 41 34"})j"),
      IsEmpty());
}

TEST(LintWires, NamesTheByteThatDiffers) {
  EXPECT_THAT(wires(R"j({"send": "[ENQ st EOT]", "wire": "05 32 31 04"})j"),
              ElementsAre(HasSubstr("f.json: xgt_cnet/a/b: steps[0]: wire and notation differ at "
                                    "byte 2: wire has 31, notation has 30")));
  EXPECT_THAT(wires(R"j({"send": "[ENQ st EOT]", "wire": "05 32 30"})j"),
              ElementsAre(HasSubstr("wire has nothing, notation has 04")));
  EXPECT_THAT(wires(R"j({"send": "[ENQ EOT]", "wire": "5 04"})j"),
              ElementsAre(HasSubstr("not two-digit hex bytes")));
}

TEST(LintWires, OpenPlacesStayOpenInBoth) {
  EXPECT_THAT(wires(R"j({"expect": "[ACK x:2 ETX]", "wire": "06 ?? ?? 03"})j"), IsEmpty());
  EXPECT_THAT(wires(R"j({"expect": "[ACK x:2 ETX]", "wire": "06 31 ?? 03"})j"),
              ElementsAre(HasSubstr("byte 1")));
}

TEST(LintWires, TheModelsAreTheProtocols) {
  VectorSet set = with_step(R"j({"send": "[ENQ EOT]", "wire": "05 04"})j");
  set.cases.front().models = {"test", "tast"};
  EXPECT_THAT(lint_wires(set, harness::Protocols(table)),
              ElementsAre(HasSubstr("xgt_cnet/a/b: xgt-cnet has no model 'tast'")));
}

TEST(LintWires, EveryFrameHasLiteralBytes) {
  EXPECT_THAT(wires(R"j({"send": "[ENQ EOT]"})j"), ElementsAre(HasSubstr("no wire")));
}

TEST(LintWires, EveryNamedAlternativeHasItsOwn) {
  EXPECT_THAT(
      wires(
          R"j({"expect": {"reading": "r", "a": "[ACK ETX]", "b": "[NAK ETX]"}, "wire": {"a": "06 03", "b": "15 03"}})j"),
      IsEmpty());
  EXPECT_THAT(
      wires(
          R"j({"expect": {"reading": "r", "a": "[ACK ETX]", "b": "[NAK ETX]"}, "wire": {"a": "06 03", "b": "06 03"}})j"),
      ElementsAre(HasSubstr("steps[0] b: wire and notation differ at byte 0")));
}

/// The problems of a set of two cases, the second with these changes.
std::vector<std::string> duplicates(
    const std::string& first, const std::string& second, void (*change)(Case&) = [](Case&) {}) {
  VectorSet set = with_step(first);
  Case other = with_step(second).cases.front();
  other.id = "xgt_cnet/a/c";
  change(other);
  set.cases.push_back(other);
  return lint_duplicates(set, harness::Protocols(table));
}

TEST(LintDuplicates, NamesBothCasesOfOneExchange) {
  EXPECT_THAT(duplicates(R"j({"send": "[ENQ st EOT]"})j", R"j({"send": "05 '20' EOT"})j"),
              ElementsAre(HasSubstr(
                  "f.json: xgt_cnet/a/c: repeats the exchange of xgt_cnet/a/b (f.json)")));
  EXPECT_THAT(duplicates(R"j({"silence": true})j", R"j({"silence": true})j",
                         [](Case& other) { other.title = "said in other words"; }),
              testing::SizeIs(1));
}

TEST(LintDuplicates, AnotherExchangeOrAnotherDeviceIsNone) {
  const std::string silence = R"j({"silence": true})j";
  EXPECT_THAT(duplicates(R"j({"send": "ENQ EOT"})j", R"j({"send": "ENQ ETX"})j"), IsEmpty());
  EXPECT_THAT(duplicates(R"j({"send": "ENQ EOT"})j", R"j({"send": "ENQ ~2c EOT"})j"), IsEmpty());
  EXPECT_THAT(duplicates(R"j({"expect": "ACK x:2"})j", R"j({"expect": "ACK ?? ??"})j"), IsEmpty());
  EXPECT_THAT(duplicates(R"j({"set": {"%MW1": "0001"}})j", R"j({"check": {"%MW1": "0001"}})j"),
              IsEmpty());
  EXPECT_THAT(duplicates(silence, silence, [](Case& other) { other.models = {"test"}; }),
              IsEmpty());
  EXPECT_THAT(duplicates(silence, silence, [](Case& other) { other.config["station"] = 33; }),
              IsEmpty());
  EXPECT_THAT(duplicates(silence, silence,
                         [](Case& other) {
                           other.memory = {{"%MW1", "0001"}};
                         }),
              IsEmpty());
}

TEST(LintStatements, EachNeedsAVectorOrAReason) {
  VectorSet set = with_step(R"j({"silence": true})j");
  EXPECT_THAT(lint_statements(set), IsEmpty());
  set.statements.push_back({"m/2", "m", "2", "one two three four five", ""});
  EXPECT_THAT(lint_statements(set),
              ElementsAre("statements: m/2 has neither a vector nor a reason"));
  set.statements.back().reason = "about cables";
  EXPECT_THAT(lint_statements(set), IsEmpty());
  set.cases[0].source.statements = {"m/9"};
  EXPECT_THAT(lint_statements(set),
              ElementsAre(HasSubstr("no statement 'm/9'"), HasSubstr("m/1 has neither")));
}

TEST(LintStatements, EachSectionHasATitle) {
  VectorSet set = with_step(R"j({"silence": true})j");
  set.sections = {{"m", {{"1", "General"}}}};
  EXPECT_THAT(lint_statements(set), IsEmpty());
  set.statements[0].section = "2.1 (3)";
  EXPECT_THAT(lint_statements(set),
              ElementsAre("sections.json: no title of 2.1 (3) in m, which m/1 is of"));
  set.statements[0].section = "Warranty";
  EXPECT_THAT(lint_statements(set), IsEmpty()) << "its own title";
}

TEST(LintQuotes, TitlesStandInTheManualToo) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "lint_titles";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "m.txt") << "1 General  terms: one two three four five";
  VectorSet set = with_step(R"j({"silence": true})j");
  set.sections = {{"m", {{"1", "General terms"}}}};
  EXPECT_THAT(lint_quotes(set, folder), IsEmpty());
  const std::string lock = quotes_lock(set);
  set.sections["m"]["1"] = "General remarks";
  EXPECT_THAT(lint_quotes(set, folder),
              ElementsAre(HasSubstr("sections.json: m/1: the quote does not stand in m")));
  EXPECT_THAT(lint_lock(set, lock), ElementsAre(HasSubstr("sections.json: m/1: the quote is not")));
  std::filesystem::remove_all(folder);
}

TEST(LintQuotes, StandInTheManualWithSpaceFolded) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "lint_quotes";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "m.txt") << "Zero one\ttwo\n\n three   four five six";
  VectorSet set = with_step(R"j({"silence": true})j");
  EXPECT_THAT(lint_quotes(set, folder), IsEmpty());
  set.cases[0].source.quote = "one two three four seven";
  EXPECT_THAT(lint_quotes(set, folder),
              ElementsAre(HasSubstr("xgt_cnet/a/b: the quote does not stand in m")));
  set.cases[0].source.quote = "one two";
  EXPECT_THAT(lint_quotes(set, folder), ElementsAre(HasSubstr("shorter than five words")));
  std::filesystem::remove_all(folder);
}

TEST(LintLock, NoticesAChangedQuote) {
  VectorSet set = with_step(R"j({"silence": true})j");
  const std::string lock = quotes_lock(set);
  EXPECT_THAT(lint_lock(set, lock), IsEmpty());
  set.cases[0].source.quote += " six";
  EXPECT_THAT(lint_lock(set, lock),
              ElementsAre(HasSubstr("xgt_cnet/a/b: the quote is not the one last verified")));
}

TEST(LintQuotes, AreLockedInErrataToo) {
  const auto with_quote = [](const std::string& quote) {
    VectorSet set;
    Erratum& erratum = set.errata.emplace_back();
    erratum.id = "m_7/chapter";
    erratum.at = "errata/m_7.json:5";
    erratum.places.push_back({"", "m", "1", quote});
    return set;
  };
  const std::string lock = quotes_lock(with_quote("see chapter 9"));
  EXPECT_THAT(lint_lock(with_quote("see chapter 9"), lock), IsEmpty());
  EXPECT_THAT(lint_lock(with_quote("see chapter 8"), lock),
              ElementsAre(HasSubstr(
                  "errata/m_7.json:5: m_7/chapter: the quote is not the one last verified")));
}

TEST(LintTables, AsksTheProtocol) {
  VectorSet set = with_step(R"j({"silence": true})j");
  set.tables = set.cases;
  set.tables[0].facts = {{"words", 1024}};
  EXPECT_THAT(lint_tables(set, harness::Protocols(table)), IsEmpty());
  set.tables[0].facts = {{"words", 1000}};
  EXPECT_THAT(lint_tables(set, harness::Protocols(table)),
              ElementsAre(HasSubstr("the table has 1024 words")));
}

}  // namespace
}  // namespace fieldproof::vectors
