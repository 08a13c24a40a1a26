#include "harness/vectors/citations.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace fieldproof::vectors {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* vector = R"j([{
  "id": "p/read/word", "title": "a vector of the tests", "level": "must", "basis": "printed rule",
  "statement": ["m/${row}", "m/purpose"],
  "each": {"area": [{"case": "p", "row": "area-p"}, {"case": "t", "row": "area-t"}]},
  "steps": [{"send": "05"}, {"expect": "06", "clause": "m/ack"}, {"silence": true}]}])j";
constexpr const char* statements = R"j([
  {"id": "m/area-p", "section": "1", "quote": "P0 to P127"},
  {"id": "m/area-t", "section": "1", "quote": "T0 to T255"},
  {"id": "m/purpose", "section": "2", "quote": "reads memory"},
  {"id": "m/ack", "section": "3", "quote": "ACK is 06"}])j";

/// A set on disk, of this test alone.
class Citations : public testing::Test {
 protected:
  Citations() : folder_(std::filesystem::path(testing::TempDir()) / "citations") {
    write("p/read.json", vector);
    write("statements/m.json", statements);
  }
  ~Citations() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }

  std::filesystem::path folder_;
};

TEST_F(Citations, TheWordsAreThoseOfTheFirstStatementOfItsRow) {
  const VectorSet set = load_vectors(folder_);
  ASSERT_THAT(set.problems, IsEmpty());
  ASSERT_EQ(set.cases.size(), 2u);
  EXPECT_EQ(set.cases[0].source.quote, "P0 to P127");
  EXPECT_EQ(set.cases[1].source.quote, "T0 to T255");
  EXPECT_EQ(set.cases[1].source.manual, "m");
  EXPECT_EQ(set.cases[1].source.section, "1");
}

TEST_F(Citations, AStepHasItsOwn) {
  const VectorSet set = load_vectors(folder_);
  const Case& one = set.cases.at(0);
  EXPECT_EQ(one.steps[0].source.quote, "");
  EXPECT_EQ(one.steps[1].source.quote, "ACK is 06");
  EXPECT_EQ(one.steps[1].source.section, "3");
  EXPECT_THAT(cited_by(one), ElementsAre("m/area-p", "m/purpose", "m/ack"));
}

/// `run --vectors` of one folder, or of one file.
TEST_F(Citations, APartOfASetFindsTheStatementsBesideIt) {
  for (const char* part : {"p", "p/read.json"}) {
    const VectorSet set = load_vectors(folder_ / part);
    EXPECT_THAT(set.problems, IsEmpty()) << part;
    EXPECT_EQ(set.cases.at(0).source.quote, "P0 to P127") << part;
  }
}

/// Vectors of a user, who cites a manual of this project.
TEST_F(Citations, StatementsOfAnotherSetAreFoundWhereItIsNamed) {
  write("theirs/p/read.json", vector);
  write("theirs/statements/own.json",
        R"([{"id": "own/1", "section": "1", "quote": "of their own"}])");
  EXPECT_THAT(load_vectors(folder_ / "theirs").problems, testing::SizeIs(4));
  const VectorSet set = load_vectors(folder_ / "theirs", {.known_set = folder_});
  ASSERT_THAT(set.problems, IsEmpty());
  EXPECT_EQ(set.cases.at(0).source.quote, "P0 to P127");
  EXPECT_EQ(set.statements.size(), 5u) << "their own, and those that they cite";
}

TEST_F(Citations, AFileOfAnEarlierEditionNamesItsStatementInTheSource) {
  write("old.json", R"j([{
    "id": "p/old", "rev": 1, "title": "a vector of the tests", "level": "must", "basis": "printed rule",
    "source": {"manual": "m", "section": "9", "quote": "as it is printed", "statement": "m/ack"},
    "steps": [{"send": "05"}]}])j");
  const VectorSet set = load_vectors(folder_ / "old.json");
  ASSERT_THAT(set.problems, IsEmpty());
  EXPECT_EQ(set.cases.at(0).source.quote, "as it is printed");
  EXPECT_THAT(cited_by(set.cases.at(0)), ElementsAre("m/ack"));
}

TEST_F(Citations, WhatIsNotThereIsNamedWithTheNearest) {
  write("statements/m.json", R"([{"id": "m/area-p", "section": "1", "quote": "P0 to P127"}])");
  EXPECT_THAT(
      load_vectors(folder_).problems,
      testing::Contains(HasSubstr(
          "p/read/word/t: no statement 'm/area-t' in statements/; did you mean 'm/area-p'?")));
}

}  // namespace
}  // namespace fieldproof::vectors
