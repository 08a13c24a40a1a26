#include "reports/junit.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <pugixml.hpp>
#include <set>

#include "reports/testdata/samples.hpp"

namespace fieldproof::reports {

using results::CaseResult;
using results::Gate;
using results::Verdict;

namespace {

using samples::with;
using testing::HasSubstr;

class Junit : public testing::Test {
 protected:
  /// Writes the report of the results and loads it again.
  void report(const std::vector<CaseResult>& results, const Gate& gate = {}, bool end = true) {
    samples::write_results(results_, results, end, gate);
    make();
  }
  void make() {
    const auto log = replay(results_, *junit_report(report_));
    ASSERT_TRUE(log) << log.error().message;
    const auto loaded = document_.load_file(report_.c_str());
    ASSERT_TRUE(loaded) << loaded.description() << " at " << loaded.offset;
  }

  /// "" when xmllint accepts the report; its complaints otherwise.
  std::string xmllint() const {
    const std::string log = folder_ / "xmllint.txt";
    const std::string schema = FIELDPROOF_SOURCE_DIR "/reports/testdata/junit-10.xsd";
    const std::string command =
        "xmllint --huge --noout --schema '" + schema + "' '" + report_ + "' >'" + log + "' 2>&1";
    return std::system(command.c_str()) == 0 ? "" : samples::read_file(log);
  }
  static bool have_xmllint() { return std::system("xmllint --version >/dev/null 2>&1") == 0; }

  pugi::xml_node root() const { return document_.child("testsuites"); }
  pugi::xml_node suite() const { return root().child("testsuite"); }
  pugi::xml_node testcase(const std::string& name) const {
    return suite().find_child_by_attribute("testcase", "name", name.c_str());
  }
  std::string property(const char* name) const {
    return suite()
        .child("properties")
        .find_child_by_attribute("name", name)
        .attribute("value")
        .value();
  }

  samples::Folder folder_;
  std::string results_ = folder_ / "results.ndjson";
  std::string report_ = folder_ / "junit.xml";
  pugi::xml_document document_;
};

std::vector<CaseResult> one_of_each() {
  std::vector<CaseResult> results;
  for (Verdict verdict : text::Tally::verdicts) {
    results.push_back(samples::with(
        verdict, "xgt_cnet/each/v" + std::to_string(static_cast<int>(verdict)), "because"));
    results.back().seconds = 0.001;
  }
  return results;
}

/// Each count of the attributes must be the number of such children.
void expect_counts_equal_children(pugi::xml_node root) {
  std::map<std::string, unsigned> all;
  for (pugi::xml_node suite : root.children("testsuite")) {
    std::map<std::string, unsigned> found;
    for (pugi::xml_node testcase : suite.children("testcase")) {
      ++found["tests"];
      found["failures"] += testcase.child("failure") ? 1 : 0;
      found["errors"] += testcase.child("error") ? 1 : 0;
      found["skipped"] += testcase.child("skipped") ? 1 : 0;
    }
    for (const char* name : {"tests", "failures", "errors", "skipped"}) {
      ASSERT_TRUE(suite.attribute(name)) << name;
      EXPECT_EQ(found[name], suite.attribute(name).as_uint()) << name;
      all[name] += found[name];
    }
  }
  for (const char* name : {"tests", "failures", "errors"})
    EXPECT_EQ(all[name], root.attribute(name).as_uint(99999)) << name;
}

TEST(JunitNames, FolderAndGroupAreTheClass) {
  const auto name = [](const std::string& id, int repeat = 0) {
    auto result = samples::with(Verdict::pass, id);
    result.repeat = repeat;
    const auto [classname, rest] = junit_name(result);
    return classname + "|" + rest;
  };
  EXPECT_EQ("fieldproof.xgt_cnet.rss|two_words", name("xgt_cnet/rss/two_words"));
  EXPECT_EQ("fieldproof.xgt_cnet.rss|two_words #3", name("xgt_cnet/rss/two_words", 2));
  EXPECT_EQ("fieldproof.xgt_cnet.rss|each/lower/p", name("xgt_cnet/rss/each/lower/p"));
  EXPECT_EQ("fieldproof.xgt_cnet|sanity", name("xgt_cnet/sanity"));
  EXPECT_EQ("fieldproof|sanity", name("sanity"));
}

TEST_F(Junit, AFailureIsComplete) {
  report({samples::failure()});
  const pugi::xml_node node = testcase("one_word").child("failure");
  EXPECT_STREQ("FAIL", node.attribute("type").value());
  EXPECT_STREQ("BCC: expected 0F, received 09 (the sum leaves out the header)",
               node.attribute("message").value());
  const std::string body = node.text().get();
  for (const char* part :
       {"FAIL: BCC: expected 0F, received 09", "xgb-cnet-en-1.6, 7.1.5 (1)(e)",
        "BCC is the low byte of the sum", "sent      ENQ '01rSS0106%MW100' EOT 'A3'",
        "expected  [ACK st 'rSS'", "0010  46", "received  ACK '01rSS01021234' ETX '09'",
        "0010  39\n                ^^", "BCC    0F        09", "reply after 4.208 ms",
        "24.000      4.208  <--", "replay    fieldproof run --filter xgt_cnet/rss/one_word"}) {
    EXPECT_THAT(body, HasSubstr(part));
  }
  EXPECT_STREQ("fieldproof.xgt_cnet.rss", testcase("one_word").attribute("classname").value());
  EXPECT_STREQ("0.013", testcase("one_word").attribute("time").value());
}

TEST_F(Junit, EachVerdictHasItsElement) {
  report(one_of_each());
  std::map<std::string, std::string> found;
  for (pugi::xml_node node : suite().children("testcase")) {
    const pugi::xml_node outcome = node.first_child();
    found[outcome.attribute("type").value()] += outcome.name();
  }
  EXPECT_EQ(
      (std::map<std::string, std::string>{{"", "system-outsystem-outsystem-out"},  // PASS is plain
                                          {"FAIL", "failure"},
                                          {"XPASS", "failure"},
                                          {"ERROR", "error"},
                                          {"XFAIL", "skipped"},
                                          {"SKIP", "skipped"},
                                          {"BLOCKED", "skipped"},
                                          {"INCONCLUSIVE", "skipped"}}),
      found);
  EXPECT_FALSE(testcase("v0").first_child());
  EXPECT_THAT(testcase("v1").child("system-out").text().get(), HasSubstr("MARGINAL: because"));
  EXPECT_STREQ("BLOCKED: because", testcase("v8").child("skipped").attribute("message").value());
}

TEST_F(Junit, ACaseOfAModelSaysItsKind) {
  CaseResult passed = samples::with(Verdict::pass, "xnet/a/passed");
  CaseResult failed = samples::with(Verdict::fail, "xnet/a/failed", "because");
  passed.on_model = failed.on_model = "timing";
  report({passed, failed, samples::with(Verdict::pass, "xnet/a/wire")});
  const std::string kind = "kind timing: of a model, not on a wire\n";
  EXPECT_EQ(testcase("passed").child("system-out").text().get(), kind);
  EXPECT_THAT(testcase("failed").child("failure").text().get(), HasSubstr(kind));
  EXPECT_FALSE(testcase("wire").first_child());
}

TEST_F(Junit, FailuresFollowTheGate) {
  report(one_of_each(), {.strict = true, .fail_on_marginal = true, .qualify = true});
  EXPECT_STREQ("NON-STRICT", testcase("v2").child("failure").attribute("type").value());
  EXPECT_STREQ("MARGINAL", testcase("v1").child("failure").attribute("type").value());
  EXPECT_TRUE(testcase("v8").child("skipped")) << "BLOCKED stays skipped";
  EXPECT_TRUE(testcase("v9").child("skipped")) << "INCONCLUSIVE stays skipped";
  EXPECT_EQ("strict, fail-on marginal, qualify", property("gate"));
  expect_counts_equal_children(root());
}

TEST_F(Junit, CountsEqualTheChildren) {
  for (int bits = 0; bits < 8; ++bits) {
    report(one_of_each(), {.strict = (bits & 1) != 0,
                           .fail_on_marginal = (bits & 2) != 0,
                           .qualify = (bits & 4) != 0});
    EXPECT_EQ(11u, root().attribute("tests").as_uint());
    expect_counts_equal_children(root());
  }
}

TEST_F(Junit, OneSuiteAProtocolInOrderOfAppearance) {
  auto modbus = samples::with(Verdict::pass, "modbus/fc3/one");
  modbus.protocol = "modbus-rtu";
  report({samples::with(Verdict::pass, "xgt_cnet/rss/a"), modbus,
          samples::with(Verdict::fail, "xgt_cnet/rss/b")});
  std::string layout;
  for (pugi::xml_node node : root().children("testsuite")) {
    layout += std::string(node.attribute("name").value()) + ":";
    for (pugi::xml_node child : node.children("testcase"))
      layout += std::string(" ") + child.attribute("name").value();
    layout += "; ";
  }
  EXPECT_EQ("xgt-cnet: a b; modbus-rtu: one; ", layout);
  expect_counts_equal_children(root());
}

TEST_F(Junit, TheRunIsInThePropertiesOfTheSuite) {
  report({samples::failure()});
  EXPECT_EQ("emulator:xbc-h?station=1", property("endpoint"));
  EXPECT_EQ("xbc-h", property("profile"));
  EXPECT_EQ("9600-8N1", property("line"));
  EXPECT_EQ("7", property("seed"));
  EXPECT_EQ("1", property("exit_code"));
  EXPECT_EQ("", property("ended_early"));
  EXPECT_STREQ("2026-11-21T12:39:03+00:00", suite().attribute("timestamp").value());
  EXPECT_FALSE(testcase("one_word").child("properties"));
}

TEST_F(Junit, RepetitionsHaveNamesOfTheirOwn) {
  std::vector<CaseResult> results(3, samples::with(Verdict::pass, "xgt_cnet/rss/a"));
  results[1].repeat = 1;
  results[2].repeat = 2;
  report(results);
  std::set<std::string> names;
  for (pugi::xml_node node : suite().children("testcase"))
    names.insert(node.attribute("name").value());
  EXPECT_EQ((std::set<std::string>{"a", "a #2", "a #3"}), names);
}

TEST_F(Junit, NothingThatADeviceSendsBreaksTheFile) {
  std::vector<CaseResult> results;
  for (int b = 0; b < 256; ++b) {
    auto result = samples::failure();
    result.id += std::to_string(b);
    result.received_bytes = {static_cast<Byte>(b)};
    result.message = result.received = std::string("got ") + static_cast<char>(b);
    result.verdict = b == 5 ? Verdict::xpass : Verdict::fail;  // not alike: told in full
    results.push_back(result);
  }
  auto hostile = samples::failure();
  hostile.message = hostile.title = hostile.received = hostile.quote =
      "<script>alert(\"1\")</script> ]]> & &#5; \xED\xA0\x80 \xEF\xBF\xBF <!-- --";
  results.push_back(hostile);
  report(results);
  expect_counts_equal_children(root());
  EXPECT_EQ(257u, suite().attribute("tests").as_uint());
  EXPECT_STREQ("got [05]", testcase("one_word5").child("failure").attribute("message").value());
  EXPECT_THAT(testcase("one_word5").child("failure").text().get(),
              HasSubstr("received  got [05]\n          0000  05\n                ^^\n"));
  EXPECT_THAT(testcase("one_word").child("failure").text().get(),
              HasSubstr("<script>alert(\"1\")</script> ]]> & &#5; "));
  EXPECT_EQ(std::string::npos, samples::read_file(report_).find("<script"));
  if (have_xmllint()) {
    EXPECT_EQ("", xmllint());
  }
}

/// head -c 1048576 /dev/zero | tr '\\0' '\\025' | sha256sum
const std::string mebibyte_of_nak =
    "f9c0c8ea7970297fbf51afb2343fdeed507dfb68529aaa8eae7dd04ecbca490d";

TEST_F(Junit, OfAFrameOfAMebibyteItHasAnExtract) {
  auto result = samples::failure();
  result.received_bytes.assign(1 << 20, 0x15);
  report({result, samples::with(Verdict::pass, "xgt_cnet/rss/after")});
  const std::string body = testcase("one_word").child("failure").text().get();
  EXPECT_THAT(body, HasSubstr("0030  15 15"));
  EXPECT_THAT(body, HasSubstr("... 1,048,448 bytes left out\n"));
  EXPECT_THAT(body, HasSubstr("FFFF0  15 15"));
  EXPECT_THAT(body, HasSubstr("1,048,576 bytes in all, sha256 " + mebibyte_of_nak));
  EXPECT_LT(body.size(), 10'000u);
  expect_counts_equal_children(root());
  if (have_xmllint()) {
    EXPECT_EQ("", xmllint());
  }
}

/// Each case has its verdict and its message; what the first of a kind says at length the others
/// refer to.
TEST_F(Junit, TheSameFailureIsToldOnce) {
  std::vector<CaseResult> results;
  for (int i = 1; i <= 200; ++i) {
    results.push_back(samples::failure());
    results.back().id = "xgt_cnet/rss/n" + std::to_string(i);
  }
  report(results);
  const pugi::xml_node suite = document_.child("testsuites").child("testsuite");
  EXPECT_EQ(200u, suite.attribute("failures").as_uint());
  std::size_t in_full = 0;
  for (const pugi::xml_node one : suite.children("testcase")) {
    EXPECT_EQ(samples::failure().message, one.child("failure").attribute("message").value());
    const std::string body = one.child("failure").child_value();
    EXPECT_THAT(body, HasSubstr("replay    "));
    in_full += body.find("clause ") != body.npos;
    EXPECT_NE(body.find("clause ") != body.npos,
              body.find("finding 1, as xgt_cnet/rss/n1,") != body.npos);
  }
  EXPECT_EQ(3u, in_full);
  const pugi::xml_node property =
      suite.child("properties").find_child_by_attribute("name", "finding 1");
  EXPECT_EQ("200 cases: " + samples::failure().message +
                " (first: xgt_cnet/rss/n1, xgt_cnet/rss/n2, xgt_cnet/rss/n3)",
            std::string(property.attribute("value").value()));
}

TEST_F(Junit, LongIdsStayWhole) {
  const std::string part(4000, 'x');
  report({samples::with(Verdict::fail, part + "/" + part + "/" + part)});
  EXPECT_EQ("fieldproof." + part + "." + part,
            suite().child("testcase").attribute("classname").value());
  EXPECT_EQ(part, suite().child("testcase").attribute("name").value());
}

TEST_F(Junit, IsValidUnderTheSchema) {
  if (!have_xmllint()) GTEST_SKIP() << "xmllint is not installed (package libxml2-utils)";
  auto results = one_of_each();
  results.push_back(samples::failure());
  report(results);
  EXPECT_EQ("", xmllint());
  report(results, {.strict = true, .fail_on_marginal = true, .qualify = true}, false);
  EXPECT_EQ("", xmllint());
  report({});
  EXPECT_EQ("", xmllint());
}

TEST_F(Junit, TheSchemaRefusesWhatJenkinsAndGitLabRefuse) {
  if (!have_xmllint()) GTEST_SKIP() << "xmllint is not installed (package libxml2-utils)";
  report({samples::failure()});
  const std::string good = samples::read_file(report_);
  const auto complaint = [&](const std::string& what, const std::string& with_this) {
    std::string bad = good;
    const std::size_t at = bad.find(what);
    EXPECT_NE(std::string::npos, at) << what;
    std::ofstream(report_, std::ios::binary) << bad.replace(at, what.size(), with_this);
    return xmllint();
  };
  EXPECT_THAT(complaint("<failure", "<properties/><failure"),
              HasSubstr("'properties': This element is not expected"));
  EXPECT_THAT(complaint(" time=\"0.013\"", " time=\"0,013\""),
              HasSubstr("'0,013' is not accepted"));
  EXPECT_THAT(complaint("+00:00\">", "\">"), HasSubstr("timestamp"));
  EXPECT_THAT(complaint("<testcase ", "<testcase status=\"run\" "), HasSubstr("'status'"));
  const std::string twin =
      "<testcase classname=\"fieldproof.xgt_cnet.rss\" name=\"one_word\" time=\"0.000\"/>";
  EXPECT_THAT(complaint("<testcase ", twin + "<testcase "), HasSubstr("Duplicate key-sequence"));
  EXPECT_THAT(complaint("FAIL: ", "\x05"), HasSubstr("PCDATA invalid Char value 5"));
}

TEST_F(Junit, AKilledRunSaysSo) {
  report({samples::failure(), samples::with(Verdict::pass, "xgt_cnet/rss/a")}, {}, false);
  std::ofstream(results_, std::ios::app | std::ios::binary) << "{\"case\":{\"id\":\"xgt";
  make();
  EXPECT_EQ("missing", property("end"));
  EXPECT_EQ("the run was killed: 2 results were written before, and one incomplete",
            property("ended_early"));
  EXPECT_STREQ("the run was killed: 2 results were written before, and one incomplete",
               suite().child("system-err").text().get());
  EXPECT_EQ(2u, suite().attribute("tests").as_uint());
  EXPECT_STREQ("killed",
               root().last_child().child("testcase").child("error").attribute("type").value());
  expect_counts_equal_children(root());
}

TEST_F(Junit, EachReasonThatNoCaseShowsIsACaseOfItsOwn) {
  auto end = samples::run_end(0);
  end.add({1, "verdicts", "conformance failed: 1 FAIL"});
  end.add({1, "min-judged", "too little judged: 1 of 9"});
  end.add({3, "trouble", "bench trouble: the port failed"});
  end.add({3, "trouble", "bench trouble: the disk is full"});
  {
    auto writer = results::NdjsonWriter::create(results_);
    ASSERT_TRUE(writer);
    samples::hand_over(*writer, samples::run_info(), {samples::failure()}, end);
  }
  make();
  const pugi::xml_node gate = root().find_child_by_attribute("testsuite", "name", "gate");
  const auto says = [&](const char* name, const char* element) {
    return std::string(gate.find_child_by_attribute("testcase", "name", name)
                           .child(element)
                           .attribute("message")
                           .value());
  };
  EXPECT_EQ(3u, gate.attribute("tests").as_uint());
  EXPECT_EQ("too little judged: 1 of 9", says("min-judged", "failure"));
  EXPECT_EQ("bench trouble: the port failed", says("trouble", "error"));
  EXPECT_EQ("bench trouble: the disk is full", says("trouble #2", "error"));
  expect_counts_equal_children(root());
  if (have_xmllint()) {
    EXPECT_EQ("", xmllint());
  }
}

TEST_F(Junit, ARunWithoutResultsSaysWhy) {
  {
    auto writer = results::NdjsonWriter::create(results_);
    ASSERT_TRUE(writer);
    auto end = samples::run_end(3);
    end.trouble = "nothing answers on emulator:xbc-h";
    samples::hand_over(*writer, samples::run_info(), {}, end);
  }
  make();
  EXPECT_EQ(0u, suite().attribute("tests").as_uint(1));
  EXPECT_EQ("nothing answers on emulator:xbc-h", property("ended_early"));
  EXPECT_EQ("emulator:xbc-h?station=1", property("endpoint"));
}

TEST_F(Junit, DamagedResultsLeaveTheOldReport) {
  report({samples::failure()});
  const std::string before = samples::read_file(report_);
  std::ofstream(results_, std::ios::app) << "rubbish\n";
  const auto log = replay(results_, *junit_report(report_));
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().message, HasSubstr("results.ndjson, line 4: "));
  EXPECT_EQ(before, samples::read_file(report_));
  EXPECT_EQ(2u, folder_.files()) << "nothing temporary is left";
}

}  // namespace
}  // namespace fieldproof::reports
