#include "suites/mutants/table.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "reports/results/whole_file.hpp"

namespace fieldproof::mutants {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

std::string text_of(const std::string& source) {
  const Result<std::string> text = results::read_whole_file(FIELDPROOF_SOURCE_DIR "/" + source);
  return text ? *text : "";
}

/// The table of mutants has a source's text as its tokens stand, the source has lines.
std::string without_spaces(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isspace(c); });
  return text;
}

/// Mutants are only made where clang is, and a source may have moved on since: what an entry names
/// must still stand there.
TEST(EquivalentMutants, AreOfTextThatStandsInTheSources) {
  const json entries = json::parse(text_of("suites/mutants/equivalent.json"));
  EXPECT_GT(entries.size(), 700u);
  for (const json& entry : entries) {
    const std::string text = without_spaces(text_of(entry.at("file")));
    EXPECT_THAT(text, HasSubstr(without_spaces(entry.value("function", "")))) << entry;
    EXPECT_THAT(text, HasSubstr(without_spaces(entry.value("before", "")))) << entry;
  }
}

TEST(EquivalentMutants, AllThatFitNoneAreNamed) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "equivalent.json";
  std::ofstream(file) << R"([{"file": "a.cpp", "why": "stands"}, {"file": "b.cpp", "why": "gone"},
                            {"file": "a.cpp", "before": "x < 2", "why": "gone, too"}])";
  std::vector<Mutant> mutants(1);
  mutants[0].file = "a.cpp";
  mutants[0].before = "x < 1";
  const Status loaded = load_equivalent(file, mutants);
  std::filesystem::remove(file);
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message, HasSubstr("b.cpp"));
  EXPECT_THAT(loaded.error().message, HasSubstr("x < 2"));
  EXPECT_THAT(loaded.error().message, Not(HasSubstr("stands")));
  EXPECT_EQ(mutants[0].equivalent, "stands");
}

}  // namespace
}  // namespace fieldproof::mutants
