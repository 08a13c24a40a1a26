// The HTML report as a reader meets it: in headless Chromium, with mouse, keys and printer.
#include <gmock/gmock.h>

#include <array>
#include <nlohmann/json.hpp>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::Each;
using testing::Ge;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Le;
using testing::Not;
using testing::StartsWith;

/// "chromium", or nothing.
std::string browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    if (run_program({"bash", "-c", std::string("command -v ") + name}).code == 0) return name;
  return "";
}

constexpr const char* overflow = "document.documentElement.scrollWidth - innerWidth";
constexpr const char* open_all = "document.querySelectorAll('details').forEach(d => d.open = true)";

/// A device whose every answer has a wrong BCC, with cases of other models: one run for all tests.
const std::string& red() {
  static const TestFolder folder;
  static const std::string page = [] {
    run_tool({"run", "--endpoint", std::string("exec:") + BROKEN_SERVER + " bcc_off_by_one {tty}",
              "--profile", "xbc-h", "--filter", "xgt_cnet/rss/bit_areas*", "--qualify", "--out",
              folder.path()});
    return folder / "report.html";
  }();
  return page;
}

/// The default run, which is green, as if it had been one with --qualify.
const std::string& qualified() {
  static const TestFolder folder;
  static const std::string page = [] {
    const std::string gate = R"("gate":"default")";
    std::string log = read_text(default_run().out() + "/results.ndjson");
    const std::size_t at = log.find(gate);
    if (at == std::string::npos) return std::string("no gate in the results");
    log.replace(at, gate.size(), R"("gate":"qualify")");
    const std::string html = folder / "report.html";
    run_tool({"report", folder.write("results.ndjson", log), "--html", html});
    return html;
  }();
  return page;
}

class HtmlReportInBrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (browser().empty())
      GTEST_SKIP() << "no Chromium is installed; on Debian: apt-get install chromium";
  }

  /// The results of actions, those without one left out (suites/tool/testdata/browser.py).
  std::vector<json> browse(const std::vector<json>& actions) {
    const std::string script = folder_.write("actions.json", json(actions).dump());
    const Finished done =
        run_program({"bash", "-c",
                     "/usr/bin/python3 " FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/browser.py " +
                         browser() + " <" + quoted(script)});
    EXPECT_EQ(done.code, 0) << done.err;
    std::vector<json> results;
    for (const json& one : json::parse(done.out, nullptr, false))
      if (!one.is_null()) results.push_back(one);
    return results;
  }

  TestFolder folder_;
};

TEST_F(HtmlReportInBrowser, cases_are_searched_filtered_and_sorted_by_clicks) {
  const char* count = "parseInt(document.querySelector('#find output').textContent)";
  const char* found = "document.querySelector('#found').checkVisibility()";
  const std::vector<json> seen = browse({
      {"size", 1280, 900},
      {"open", default_run().out() + "/report.html"},
      {"eval", found},
      {"click", "#find input"},
      {"type", "rss two_words"},
      {"eval", "[...document.querySelectorAll('#found tbody tr')].map(r => r.textContent)"},
      {"eval", count},
      {"eval", "location.hash"},
      {"choose", "#find [name=verdict]", "INFO"},
      {"eval", count},
      {"click", "#find [type=reset]"},
      {"eval", found},
      {"click", ".tiles .v-info"},
      {"eval", std::string(count) + " - document.querySelector('[data-count=INFO]').textContent"},
      {"click", "#find [type=reset]"},
      {"choose", "#find [name=protocol]", "modbus_rtu"},
      {"click", "#found [data-sort=ms]"},
      {"click", "#found [data-sort=ms]"},
      {"eval",
       "[...document.querySelectorAll('#found tbody tr')].map(r => +r.cells[4].textContent)"
       ".every((ms, i, all) => i == 0 || ms <= all[i - 1])"},
      {"eval", "location.hash"},
      {"click", "#found tbody a"},
      {"eval",
       "(row => row.checkVisibility() && row.getBoundingClientRect().top < innerHeight)"
       "(document.querySelector('.seen'))"},
  });
  ASSERT_EQ(seen.size(), 11u);
  EXPECT_EQ(seen[1], false) << "nothing was asked";
  EXPECT_THAT(seen[2].get<std::vector<std::string>>(),
              Each(AllOf(StartsWith("PASSxgt_cnet/rss/two_words"), HasSubstr("7.1.5 (1)(e)"),
                         HasSubstr("Individual reading of device"))));
  EXPECT_EQ(seen[3], seen[2].size());
  EXPECT_GT(seen[3], 1);
  EXPECT_EQ(seen[4], "#q=rss+two_words");
  EXPECT_EQ(seen[5], 0);
  EXPECT_EQ(seen[6], false) << "all was cleared";
  EXPECT_EQ(seen[7], 0) << "as many as the tile says";
  EXPECT_EQ(seen[8], true) << "the slowest first";
  EXPECT_EQ(seen[9], "#protocol=modbus_rtu&sort=-ms");
  EXPECT_EQ(seen[10], true) << "a result leads to its case";
}

TEST_F(HtmlReportInBrowser, cases_are_filtered_by_section) {
  const std::vector<json> seen = browse({
      {"open", "file://" + red()},
      {"click", "#find input"},
      {"choose", "#find [name=section]", "xgb-cnet-en-1.6, 7.1.5"},
      {"eval", "document.querySelector('#find [name=section]').value"},
      {"eval",
       "[...document.querySelectorAll('#found tbody tr')].map(r => r.cells[2].textContent)"},
      {"eval",
       "[...document.querySelectorAll('details.section')].find(d => d.dataset.section ==="
       " document.querySelector('#find [name=section]').value)"
       ".querySelectorAll('.lines tr, .passes tr, .case').length"},
      {"eval", "location.hash.startsWith('#section=xgb-cnet-en-1.6')"},
  });
  ASSERT_EQ(seen.size(), 5u);
  const std::string section = seen[1];
  EXPECT_THAT(section, StartsWith("xgb-cnet-en-1.6, 7.1.5"));
  const std::vector<std::string> found = seen[2];
  EXPECT_THAT(found, Each(section)) << "of no other section";
  EXPECT_FALSE(found.empty());
  EXPECT_EQ(seen[3], found.size()) << "and all of it";
  EXPECT_EQ(seen[4], true);
}

/// A case that sends nothing is found by its title, not by the words in its picture.
TEST_F(HtmlReportInBrowser, cases_with_a_picture_show_their_titles) {
  const std::vector<json> seen = browse({
      {"open", default_run().out() + "/report.html"},
      {"click", "#find input"},
      {"type", "xnet/instruction_motos"},
      {"eval",
       "[...document.querySelectorAll('#found tbody tr')].map(r => r.cells[3].textContent)"},
      {"eval",
       "[...document.querySelectorAll('.passes tr')].filter(r => r.querySelector('svg') && "
       "r.cells[0].textContent.startsWith('xnet/instruction_motos')).length"},
  });
  ASSERT_EQ(seen.size(), 3u);
  const std::vector<std::string> found = seen[1];
  EXPECT_THAT(found, Each(AllOf(Not(StartsWith("motion")), Not(IsEmpty()))));
  EXPECT_GT(seen[2], 0) << "there are pictures";
}

/// As large as a run of all vectors may become.
TEST_F(HtmlReportInBrowser, ten_thousand_cases_are_in_it_and_searched) {
  constexpr std::size_t many = 10'000;
  std::string log;
  std::vector<std::string> cases;
  for (const std::string& line : text_lines(read_text(default_run().out() + "/results.ndjson")))
    line.starts_with(R"({"case":)") ? cases.push_back(line) : void(log += line + '\n');
  const std::size_t end = log.find(R"({"end":)");
  ASSERT_NE(end, std::string::npos);
  std::string lines;
  for (std::size_t i = 0; i < many; ++i) {
    json one = json::parse(cases[i % cases.size()]);
    one["case"]["id"] = one["case"]["id"].get<std::string>() + "/of_many_" + std::to_string(i);
    lines += one.dump() + '\n';
  }
  const std::string page = folder_ / "many.html";
  EXPECT_EQ(
      run_tool({"report", folder_.write("many.ndjson", log.insert(end, lines)), "--html", page})
          .code,
      0);
  const std::vector<json> seen = browse({
      {"size", 1280, 900},
      {"open", "file://" + page},
      {"eval",
       "[...document.querySelectorAll('.tiles [data-count]')].reduce((sum, one) => sum + "
       "parseInt(one.textContent.replace(/\\D/g, '')), 0)"},
      {"click", "#find input"},
      {"type", "of_many_9876"},
      {"eval", "parseInt(document.querySelector('#find output').textContent)"},
      {"eval",
       "[...document.querySelectorAll('#found tbody tr')].map(r => r.cells[1].textContent)"},
      {"click", "#found tbody a"},
      {"eval", "document.querySelector('.seen').checkVisibility()"},
  });
  ASSERT_EQ(seen.size(), 5u);
  EXPECT_EQ(seen[1], many);
  EXPECT_EQ(seen[2], 1);
  EXPECT_THAT(seen[3].get<std::vector<std::string>>(),
              testing::ElementsAre(HasSubstr("of_many_9876")));
  EXPECT_EQ(seen[4], true) << "the result leads to its case";
}

/// On a telephone, too: when the answer was due, and each word of a difference in one piece.
TEST_F(HtmlReportInBrowser, a_failure_can_be_read_at_400_pixels) {
  const auto inside = [](const std::string& what) {
    return "[...document.querySelectorAll('.wire')].filter(w => w.checkVisibility()).map(w => "
           "w.querySelector('" +
           what +
           "').getBoundingClientRect()).every(r => r.left >= 0 && r.right <= innerWidth && "
           "r.height "
           "> 0)";
  };
  const std::vector<json> seen = browse(
      {{"size", 400, 800},
       {"open", "file://" + red()},
       {"eval", "[...document.querySelectorAll('.wire')].filter(w => w.checkVisibility()).length"},
       {"eval", inside(".limit-text")},
       {"eval", inside(".limit")},
       {"eval",
        "Math.min(...[...document.querySelectorAll('.wire.narrow text')].filter(t => "
        "t.checkVisibility()).map(t => t.getBoundingClientRect().height))"},
       {"eval",
        "[...document.querySelectorAll('.differences td:first-child')].filter(c => "
        "c.checkVisibility() && c.textContent === 'BCC').map(c => { const r = "
        "document.createRange(); r.selectNodeContents(c); return r.getClientRects().length; })"},
       {"size", 1280, 800},
       {"eval",
        "[...document.querySelectorAll('.wire.narrow')].filter(w => w.checkVisibility()).length"}});
  ASSERT_EQ(seen.size(), 7u);
  EXPECT_GT(seen[1], 0);
  EXPECT_EQ(seen[2], true) << "the words of the limit";
  EXPECT_EQ(seen[3], true) << "its line";
  EXPECT_GT(seen[4], 9) << "letters that can be read";
  const std::vector<double> lines = seen[5];
  EXPECT_FALSE(lines.empty());
  EXPECT_THAT(lines, Each(testing::Lt(2))) << "lines of text that BCC takes";
  EXPECT_EQ(seen[6], 0) << "a window has the wide picture alone";
}

TEST_F(HtmlReportInBrowser, an_address_keeps_what_was_asked) {
  const std::vector<json> seen =
      browse({{"open", "file://" + red() + "#q=bit_areas&verdict=FAIL&sort=name"},
              {"eval",
               "[...document.querySelectorAll('#found tbody tr')].length > 0 &&"
               " [...document.querySelectorAll('#found tbody tr')].every(r => "
               "/^FAIL.*bit_areas/.test(r.textContent))"},
              {"eval", "document.querySelector('#find input').value"},
              {"click", "#found tbody a"},
              {"eval", "document.querySelector('.seen').className"}});
  ASSERT_EQ(seen.size(), 4u);
  EXPECT_EQ(seen[1], true);
  EXPECT_EQ(seen[2], "bit_areas");
  EXPECT_THAT(seen[3].get<std::string>(), StartsWith("case v-fail")) << "its block, or one alike";
}

TEST_F(HtmlReportInBrowser, all_is_there_without_a_script) {
  const std::vector<json> seen =
      browse({{"script", false},
              {"size", 1280, 900},
              {"open", "file://" + red()},
              {"eval", "document.querySelector('#find').checkVisibility()"},
              {"eval", "document.querySelector('.cause details').open"},
              {"click", "details.section summary"},
              {"eval", "document.querySelector('details.section').open"},
              {"eval", "document.querySelector('details.section tr').checkVisibility()"}});
  ASSERT_EQ(seen.size(), 5u);
  EXPECT_EQ(seen[1], false) << "what needs a script is not offered";
  EXPECT_EQ(seen[2], true) << "the first failure of a cause is in full";
  EXPECT_EQ(seen[3], true);
  EXPECT_EQ(seen[4], true);
}

TEST_F(HtmlReportInBrowser, nothing_is_wider_than_400_pixels) {
  // The run that is qualified has the pictures of motion and of the token, too.
  for (const std::string& page : {qualified(), red()}) {
    const std::vector<json> seen = browse({{"size", 400, 800},
                                           {"open", page + "#q=rss"},
                                           {"eval", overflow},
                                           {"eval", open_all},
                                           {"eval", overflow},
                                           {"eval", "document.querySelectorAll('svg').length"}});
    ASSERT_EQ(seen.size(), 4u);
    EXPECT_EQ(seen[1], 0) << page;
    EXPECT_EQ(seen[2], 0) << page << " with all of it open";
    EXPECT_GT(seen[3], page == qualified() ? 40 : -1) << "pictures";
  }
}

std::string sheet(std::ptrdiff_t paper) { return "sheet" + std::to_string(paper) + ".pdf"; }

/// By a program that has not made it: as many pages, and on the first who was judged, how, and
/// where to sign.
void read_by_others(const std::string& pdf, int pages) {
  if (run_program({"sh", "-c", "command -v pdfinfo pdftotext"}).code != 0) return;
  EXPECT_THAT(run_program({"pdfinfo", pdf}).out,
              testing::ContainsRegex("Pages: +" + std::to_string(pages) + "\n"));
  const std::string first = run_program({"pdftotext", "-layout", "-l", "1", pdf, "-"}).out;
  for (const char* text :
       {"Conformance of", "endpoint", "profile", "(exit ", "Tested by", "Approved by", "Signature"})
    EXPECT_THAT(first, HasSubstr(text));
}

/// Both papers: what is signed on the first page, what was not judged from the second on.
TEST_F(HtmlReportInBrowser, the_sheet_has_few_pages) {
  struct Paper {
    double width, height;  // inches
    double inside() const { return height - 30 / 25.4; }
  };
  constexpr std::array papers = {Paper{8.27, 11.69}, Paper{8.5, 11.0}};  // A4, Letter
  for (const std::string& page : {qualified(), red()}) {
    std::vector<json> actions = {{"open", page}};
    for (const Paper& paper : papers)
      actions.insert(
          actions.end(),
          {{"pdf", folder_ / sheet(&paper - papers.data()), paper.width, paper.height},
           {"paper", paper.width - 28 / 25.4, paper.inside()},
           {"eval",
            "document.querySelector('.signatures').getBoundingClientRect().bottom + scrollY"},
           {"eval", "getComputedStyle(document.querySelector('.sheet .page')).breakBefore"},
           {"eval",
            "[...document.querySelectorAll('main > :not(.sheet)')].filter(e => "
            "e.checkVisibility()).length"}});
    const std::vector<json> seen = browse(actions);
    ASSERT_EQ(seen.size(), 9u);
    for (std::size_t i = 0; i < papers.size(); ++i) {
      EXPECT_THAT(seen[4 * i + 1].get<int>(), AllOf(Ge(2), Le(6))) << papers[i].width << page;
      read_by_others(folder_ / sheet(i), seen[4 * i + 1].get<int>());
      EXPECT_LE(seen[4 * i + 2].get<double>(), papers[i].inside() * 96) << "the first page";
      EXPECT_EQ(seen[4 * i + 3], "page") << "what was not judged begins another";
      EXPECT_EQ(seen[4 * i + 4], 0) << "the sheet alone is printed";
    }
  }
}

}  // namespace
}  // namespace fieldproof::tool_tests
