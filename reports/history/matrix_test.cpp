#include "reports/history/matrix.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "reports/history/matrix_html.hpp"
#include "reports/history/matrix_text.hpp"
#include "reports/history/test_runs.hpp"
#include "reports/testdata/parsed_html.hpp"

namespace fieldproof::history {
namespace {

using results::CaseResult;
using test::add_or_fail;
using test::open_or_fail;
using test::result_of;
using test::run_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using V = results::Verdict;

class MatrixTest : public testing::Test {
 protected:
  Matrix matrix(const MatrixOptions& options = {}) {
    Result<Matrix> found = matrix_of(history_, options);
    EXPECT_TRUE(found) << found.error().message;
    return std::move(*found);
  }
  /// "rss/a PASS FAIL -" of each row in the order of the sections.
  static std::vector<std::string> rows(const Matrix& matrix) {
    std::vector<std::string> all;
    for (const MatrixSection& section : matrix.sections)
      for (const MatrixRow& row : section.rows) {
        std::string& line = all.emplace_back(row.facts.name.substr(9));
        for (const auto& cell : row.cells)
          line += ' ' + std::string(cell ? results::to_string(*cell) : "-");
        if (row.differs) line += " differs";
        if (row.red) line += " red";
      }
    return all;
  }
  static std::vector<std::string> names(const Matrix& matrix) {
    std::vector<std::string> all;
    for (const MatrixColumn& one : matrix.columns) all.push_back(one.name);
    return all;
  }
  samples::Folder folder_;
  History history_ = open_or_fail(folder_ / "history.sqlite");
};

CaseResult in_section(CaseResult result, const std::string& section) {
  result.section = section;
  return result;
}

TEST_F(MatrixTest, DevicesSideBySide) {
  add_or_fail(history_,
              run_of({.day = 1, .serial = "7"}, {result_of("a", V::pass), result_of("b", V::fail),
                                                 in_section(result_of("c", V::skip), "7.1.10"),
                                                 in_section(result_of("d", V::fail), "7.1.2")}));
  add_or_fail(history_,
              run_of({.day = 2, .serial = "8"}, {result_of("a", V::fail), result_of("b", V::fail),
                                                 in_section(result_of("c", V::pass), "7.1.10")}));
  const Matrix found = matrix();
  EXPECT_THAT(names(found), ElementsAre("LS XBC, serial number 7", "LS XBC, serial number 8"));
  EXPECT_THAT(rows(found), ElementsAre("d FAIL - red", "a PASS FAIL differs red", "b FAIL FAIL red",
                                       "c SKIP PASS"))
      << "7.1.2, 7.1.5, 7.1.10; what a profile leaves out is no difference";
  EXPECT_EQ(section_cell(found.sections[1].tallies[0]), "1 red of 2");
  EXPECT_EQ(section_cell(found.sections[2].tallies[0]), "-");
}

TEST_F(MatrixTest, AColumnHasEachCaseAsOfItsLastRun) {
  add_or_fail(history_, run_of({.day = 1}, {result_of("a", V::fail), result_of("b", V::fail)}));
  add_or_fail(history_, run_of({.day = 2}, {result_of("a", V::pass), result_of("b", V::pass)}));
  add_or_fail(history_, run_of({.day = 3}, {result_of("b", V::fail)}));
  EXPECT_THAT(rows(matrix()), ElementsAre("a PASS", "b FAIL red"));
  EXPECT_THAT(matrix().columns[0].runs, ElementsAre(3, 2));
  add_or_fail(history_, run_of({.day = 4, .vectors = "c3d4"}, {result_of("b", V::pass)}));
  EXPECT_THAT(rows(matrix()), ElementsAre("b PASS")) << "older vectors ask something else";
}

TEST_F(MatrixTest, FirmwareVersionsOfADevice) {
  for (const auto& [day, firmware, verdict] :
       {std::tuple(1, "V1.40", V::pass), {2, "V1.41", V::fail}, {3, "V1.40", V::non_strict}})
    add_or_fail(history_, run_of({firmware, day}, {result_of("a", verdict)}));
  MatrixOptions options;
  options.by = Columns::firmware;
  EXPECT_THAT(names(matrix(options)), ElementsAre("V1.40", "V1.41"));
  EXPECT_THAT(rows(matrix(options)), ElementsAre("a NON-STRICT FAIL differs red"));
  add_or_fail(history_, run_of({"V1.40", 4, "8"}, {result_of("a", V::pass)}));
  EXPECT_THAT(names(matrix(options)),
              ElementsAre("LS XBC, serial number 7, V1.40", "LS XBC, serial number 7, V1.41",
                          "LS XBC, serial number 8, V1.40"));
  options.last = 2;
  EXPECT_THAT(names(matrix(options)),
              ElementsAre("LS XBC, serial number 7, V1.40", "LS XBC, serial number 8, V1.40"))
      << "those with the latest runs";
  EXPECT_EQ(matrix(options).left_out, 1u);
  options.device = "number 8";
  EXPECT_THAT(names(matrix(options)), ElementsAre("V1.40"));
}

TEST_F(MatrixTest, OnlyTheCasesThatAreWanted) {
  add_or_fail(history_, run_of({}, {result_of("a", V::pass), result_of("b", V::pass)}));
  MatrixOptions options;
  options.wanted = [](const std::string& name) { return name.ends_with("b"); };
  EXPECT_THAT(rows(matrix(options)), ElementsAre("b PASS"));
  options.wanted = [](const std::string&) { return false; };
  const auto none = matrix_of(history_, options);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("has no such case"));
}

TEST_F(MatrixTest, TextMarkdownAndJson) {
  add_or_fail(history_, run_of({.serial = "7"}, {result_of("a", V::pass), result_of("b", V::pass),
                                                 in_section(result_of("c", V::pass), "8")}));
  add_or_fail(history_, run_of({.serial = "8"}, {result_of("a", V::fail), result_of("b", V::pass),
                                                 in_section(result_of("c", V::pass), "8")}));
  const Matrix found = matrix();
  EXPECT_THAT(matrix_text(found), AllOf(HasSubstr("  xgb-cnet-en-1.6  7.1.5    2  1 red of 2\n"),
                                        HasSubstr("cases that differ (1)\n  case        A     B\n"
                                                  "  xgt_cnet/a  PASS  FAIL\n"),
                                        Not(HasSubstr("xgt_cnet/b")),
                                        HasSubstr("3 cases, 1 differ between the columns")));
  EXPECT_THAT(matrix_markdown(found), AllOf(HasSubstr("| xgb-cnet-en-1.6 | 8 | 1 | 1 |"),
                                            HasSubstr("| xgt\\_cnet/a | PASS | FAIL |")));
  const auto json = nlohmann::json::parse(matrix_json(found));
  EXPECT_EQ(json["columns"][1]["device"], "LS XBC, serial number 8");
  EXPECT_EQ(json["sections"][0]["cases"][1]["id"], "xgt_cnet/b");
  EXPECT_EQ(json["sections"][0]["cases"][0]["verdicts"], nlohmann::json({"PASS", "FAIL"}));
}

TEST_F(MatrixTest, HtmlShowsWhatDiffersAndFoldsTheRest) {
  std::vector<CaseResult> results;
  for (int i = 0; i < 300; ++i)
    results.push_back(
        in_section(result_of(fmt::format("case_{:03}", i), V::pass), fmt::format("7.{}", i % 10)));
  add_or_fail(history_, run_of({.serial = "7"}, results));
  results[5].verdict = V::fail;
  add_or_fail(history_, run_of({.serial = "8"}, results));
  const samples::ParsedHtml page(matrix_html(matrix()));
  EXPECT_EQ(page.text("//h1"), "1 of 300 cases differ");
  EXPECT_EQ(page.count("//main/div[@class='scroll']/table//tr[th/code]"), 1u);
  EXPECT_EQ(page.count("//details[@class='section']"), 10u);
  EXPECT_EQ(page.count("//details[@open]"), 0u);
  EXPECT_EQ(page.count("//details//tr"), 300u);
  EXPECT_EQ(page.count("//details[@class='section']//tr/td[count(span)=1]"), 299u)
      << "what is alike is said once";
  EXPECT_EQ(page.texts("//summary[span[contains(@class,'v-fail')]]/span"),
            (std::vector<std::string>{"xgb-cnet-en-1.6 7.5", "30", "1 red of 30"}));
  EXPECT_EQ(page.count("//*[@src or @href]"), 0u) << "offline";
}

}  // namespace
}  // namespace fieldproof::history
