// Traceability and errata, by runs of the built tool.
#include <gmock/gmock.h>

#include "reports/testdata/parsed_html.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::ordered_json;
using samples::ParsedHtml;
using testing::HasSubstr;

ordered_json citing(ordered_json vector, const std::vector<std::string>& statements) {
  vector["statement"] = statements;
  return vector;
}

/// Ten statements in sections that sort by number: m/1 passes, m/2 fails, m/3 is outside the
/// profile, m/4 is a table, m/5 carries a reason, the others are open.
class Traceability : public testing::Test {
 protected:
  Traceability() {
    folder_.write("vectors/manuals.json",
                  R"([{"id": "m", "file": "m.txt", "title": "A <manual>", "edition": ""},
                                              {"id": "n", "file": "n.txt", "title": "not begun", "edition": ""}])");
    ordered_json statements = ordered_json::array();
    for (int i = 10; i >= 1; --i)
      statements.push_back({{"id", "m/" + std::to_string(i)},
                            {"section", "7." + std::to_string(i)},
                            {"quote", "says <b>five</b> | words of it"}});
    statements[5]["reason"] = "about the length of the cable";
    folder_.write("vectors/statements/m.json", statements.dump());
    ordered_json other = citing(small_vector("v/other"), {"m/3"});
    other["models"] = {"xec-h"};
    ordered_json table = citing(small_vector("v/table"), {"m/4"});
    table["kind"] = "table";
    table["facts"] = {{"a", "b"}};
    table.erase("steps");
    ordered_json pass = citing(small_vector("v/pass"), {"m/1", "m/2"});
    folder_.write("vectors/errata/m_7.json", erratum);
    vectors_ = write_vectors(
        folder_, {pass, citing(small_vector("v/fail", wrong_word), {"m/2"}), other, table});
  }

  static constexpr const char* erratum = R"([{"id": "m_7/bar", "kind": "wrong bytes",
    "places": ["m/1", {"manual": "m", "section": "9", "quote": "b|a too"}], "printed": "a|b",
    "right": "c", "proof": ["m/2"], "why": "the sentence above says so",
    "effect": "sends a|b to it", "doubt": "check the page"}])";

  Finished list(std::vector<std::string> more) {
    std::vector<std::string> arguments{"list", "--coverage", "--vectors", vectors_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
  std::string run() {
    run_tool(
        {"run", "--endpoint", "emulator:xbc-h", "--vectors", vectors_, "--out", folder_ / "out"});
    return folder_ / "out/results.ndjson";
  }

  TestFolder folder_;
  std::string vectors_;
};

constexpr const char* without_results = R"(m  A <manual>: 10 statements
  7.1
    m/1                                   1 vector, 1 case
  7.2
    m/2                                   2 vectors, 2 cases
  7.3
    m/3                                   1 vector, 1 case
  7.4
    m/4                                   1 vector of kind table, checked by `fieldproof lint`: no effect on the wire
  7.5
    m/5                                   no vector: about the length of the cable
  7.6
    m/6                                   no vector and no reason
)";

TEST_F(Traceability, tells_what_is_tested_and_what_not) {
  const Finished finished = list({});
  EXPECT_EQ(finished.code, 1) << "statements are open";
  EXPECT_THAT(finished.out, testing::StartsWith(without_results));
  EXPECT_THAT(finished.out, HasSubstr("\nn  not begun: no statements are listed yet\n"));
  EXPECT_THAT(
      finished.out,
      HasSubstr("\n10 statements: 4 with vectors, 1 with a reason, 5 open; coverage 40.0 %\n"));
}

TEST_F(Traceability, knows_what_a_fault_has_proved) {
  folder_.write("vectors/faults.json",
                R"([{"device": "plc", "faults": ["deaf", "mute"],
                     "cases": {"xgt_cnet/v/pass": "0-1", "xgt_cnet/v/fail": "0-1",
                               "xgt_cnet/v/other": ""}}])");
  EXPECT_THAT(list({}).out, HasSubstr("2 of those with vectors proved by a fault of a device"));
  const Finished redundant = run_tool({"list", "--redundant", "--vectors", vectors_});
  EXPECT_EQ(redundant.code, 0) << redundant.err;
  EXPECT_THAT(redundant.out,
              HasSubstr("plc: the same faults turn these red (0-1)\n  xgt_cnet/v/fail\n"
                        "  xgt_cnet/v/pass\n"));
  EXPECT_THAT(redundant.out, HasSubstr("plc: no fault turns these red\n  xgt_cnet/v/other\n"));
}

TEST_F(Traceability, without_a_file_of_faults_nothing_is_redundant) {
  const Finished redundant = run_tool({"list", "--redundant", "--vectors", vectors_});
  EXPECT_EQ(redundant.code, 2);
  EXPECT_THAT(redundant.err, HasSubstr("faults.json"));
}

TEST_F(Traceability, has_the_verdicts_of_a_run) {
  const std::string results = run();
  const Finished finished = list({"--results", results});
  EXPECT_THAT(finished.out,
              HasSubstr("m/1                                   1 vector, 1 case: 1 PASS\n"));
  EXPECT_THAT(
      finished.out,
      HasSubstr("m/2                                   2 vectors, 2 cases: 1 PASS, 1 FAIL\n"));
  EXPECT_THAT(finished.out,
              HasSubstr("m/3                                   1 vector, 1 case: 1 SKIP; SKIP: "));
  EXPECT_THAT(finished.out, HasSubstr("judged in " + results +
                                      ": 2, of which 1 failed; not judged there: 1, measured "
                                      "without a requirement: 0, facts without wire effect: 1; "
                                      "coverage 20.0 %"));
}

TEST_F(Traceability, what_is_only_measured_is_not_tested) {
  ordered_json measured = citing(small_vector("v/measured"), {"m/6"});
  measured["level"] = "info";
  const std::string vectors = write_vectors(folder_, {measured});
  const Finished finished = run_tool({"list", "--coverage", "--vectors", vectors, "--json"});
  const nlohmann::json six = nlohmann::json::parse(finished.out)["manuals"][0]["statements"][5];
  EXPECT_EQ(six["state"], "measured");
  EXPECT_EQ(six["vectors"][0]["kind"], "measured");
}

TEST_F(Traceability, what_was_not_run_is_said) {
  run_tool({"run", "--endpoint", "emulator:xbc-h", "--vectors", vectors_, "--filter",
            "xgt_cnet/v/fail", "--out", folder_ / "out"});
  EXPECT_THAT(list({"--results", folder_ / "out/results.json"}).out,
              HasSubstr("m/1                                   1 vector, 1 case: not run\n"));
}

TEST_F(Traceability, every_form_counts_alike) {
  const std::string results = run();
  const nlohmann::json printed = nlohmann::json::parse(list({"--results", results, "--json"}).out);
  EXPECT_EQ(
      printed["counts"],
      nlohmann::json::parse(
          R"({"statements": 10, "with_vector": 4, "tested": 1, "failed": 1, "not_judged": 1, "measured": 0, "table": 1, "reason": 1, "open": 5, "percent": 20.0})"));
  EXPECT_EQ(printed["manuals"][0]["statements"][1]["vectors"][0]["verdicts"],
            nlohmann::json::parse(R"({"FAIL": 1})"));

  list({"--results", results, "--html", folder_ / "trace.html"});
  const std::string html = read_text(folder_ / "trace.html");
  EXPECT_TRUE(samples::xmllint_accepts(folder_ / "trace.html"));
  const ParsedHtml page(html);
  EXPECT_EQ(page.text("//h1"), "20.0 % of 10 statements were judged");
  EXPECT_EQ(page.count("//details[@class='section']"), 10u);
  std::map<std::string, int> sums;
  for (const char* column : {"held", "failed", "not judged", "tables", "reasons", "open"})
    for (const std::string& text :
         page.texts("//summary/span[@data-verdict='" + std::string(column) + "']"))
      sums[column] += text == "\u00B7" ? 0 : std::stoi(text);
  EXPECT_EQ(sums, (std::map<std::string, int>{{"held", 1},
                                              {"failed", 1},
                                              {"not judged", 1},
                                              {"tables", 1},
                                              {"reasons", 1},
                                              {"open", 5}}));
  EXPECT_THAT(page.text("//details[@class='section'][2]//td"), HasSubstr("xgt_cnet/v/fail FAIL 1"));
  EXPECT_THAT(page.text("//details[@class='section'][2]//th"),
              HasSubstr("says <b>five</b> | words"));

  const std::string markdown = list({"--results", results, "--markdown"}).out;
  EXPECT_THAT(
      markdown,
      HasSubstr("| 7.2 | m/2 | says \\<b\\>five\\</b\\> \\| words of it | xgt\\_cnet/v/fail, "
                "xgt\\_cnet/v/pass | 2 vectors, 2 cases: 1 PASS, 1 FAIL |\n"));
}

TEST_F(Traceability, gates_by_a_share) {
  const Finished below = list({"--min-coverage", "40.1"});
  EXPECT_EQ(below.code, 1);
  EXPECT_THAT(below.err, HasSubstr("coverage is 40.0 %, below --min-coverage 40.1"));
  EXPECT_EQ(list({"--min-coverage", "40"}).err, "");
  EXPECT_EQ(list({"--min-coverage", "101"}).code, 2);
}

TEST_F(Traceability, our_own_manuals_have_nothing_open) {
  EXPECT_THAT(run_tool({"list", "--coverage"}).out, HasSubstr(" with a reason, 0 open; "));
}

TEST_F(Traceability, sections_have_the_titles_of_the_manuals) {
  EXPECT_EQ(run_tool({"list", "--coverage", "--html", folder_ / "own.html"}).code, 0);
  const ParsedHtml page(read_text(folder_ / "own.html"));
  EXPECT_GT(page.count("//summary/span[@class='name']/i"), 300u);
  EXPECT_THAT(page.texts("//summary/span[starts-with(text(), '7.1.5 (1)')]/i"),
              testing::Contains(HasSubstr("Individual reading of device")));
}

TEST_F(Traceability, bad_options_are_named) {
  EXPECT_EQ(run_tool({"list", "--markdown"}).code, 2);
  EXPECT_EQ(list({"--filter", "x"}).code, 2);
  EXPECT_EQ(list({"--json", "--markdown"}).code, 2);
  const Finished missing = list({"--results", folder_ / "none.ndjson"});
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("none.ndjson"));
  EXPECT_EQ(list({"--html", folder_ / "no/such/folder.html"}).code, 3);
}

TEST_F(Traceability, errata_have_three_forms) {
  EXPECT_EQ(run_tool({"errata", "--vectors", vectors_}).out,
            "m_7/bar: wrong bytes\n"
            "  place:   m 7.1: \"says <b>five</b> | words of it\"\n"
            "  place:   m 9: \"b|a too\"\n"
            "  printed: a|b\n  right:   c\n"
            "  proof:   m 7.2: \"says <b>five</b> | words of it\"\n"
            "  why:     the sentence above says so\n  effect:  sends a|b to it\n"
            "  doubt:   check the page\n\n1 errata: 1 wrong bytes\n");
  const std::string markdown = run_tool({"errata", "--vectors", vectors_, "--markdown"}).out;
  EXPECT_THAT(markdown, HasSubstr("# Errata of the manuals\n\n1 errata: 1 wrong bytes\n\n## m\n\n"
                                  "| section | kind | printed | right | proof | what a reader "
                                  "would do wrong | id |\n"));
  EXPECT_THAT(markdown, HasSubstr("\n| 7.1; 9 | wrong bytes | a\\|b | c | the sentence above says "
                                  "so. m 7.2: "));
  EXPECT_THAT(markdown, HasSubstr(" | sends a\\|b to it \\(check the page\\) | m\\_7/bar |\n"));
  const nlohmann::json printed =
      nlohmann::json::parse(run_tool({"errata", "--vectors", vectors_, "--json"}).out);
  EXPECT_EQ(printed.size(), 1u);
  EXPECT_EQ(printed[0]["printed"], "a|b");
}

}  // namespace
}  // namespace fieldproof::tool_tests
