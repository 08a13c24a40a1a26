// Hostile devices and the whole suite of their protocol, over a pty and a socket: bounded reports
// and memory. The figures in the README are of such runs, and of devices that take minutes.
#include <gmock/gmock.h>

#include <memory>
#include <numeric>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Hostile {
  const char* behaviour;  // of testdata/device.py, from the 30th request on: the link was measured
  bool network = false;
};

void PrintTo(const Hostile& one, std::ostream* out) { *out << one.behaviour; }

std::string device(const std::string& behaviour, bool network) {
  return "exec:/usr/bin/python3 " FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/device.py " +
         behaviour + (network ? " {port} 30?protocol=modbus-tcp" : " {tty} 30");
}

std::uintmax_t size_of(const std::string& folder) {
  const std::filesystem::recursive_directory_iterator files(folder);
  return std::accumulate(begin(files), end(files), std::uintmax_t{0},
                         [](std::uintmax_t sum, const auto& one) { return sum + one.file_size(); });
}

/// The first of its exchange; null: there is none.
nlohmann::json extract_of(const nlohmann::json& result) {
  for (const nlohmann::json& event : result.value("exchange", nlohmann::json::array()))
    if (event.contains("extract")) return event["extract"];
  return nullptr;
}

bool has_extract(const nlohmann::json& result) { return !extract_of(result).is_null(); }

class HostileRuns : public testing::Test {
 protected:
  Finished run(const Hostile& one) {
    return run_tool({"run", "--endpoint", device(one.behaviour, one.network), "--profile", "xbc-h",
                     "--filter", one.network ? "modbus_tcp/*" : "xgt_cnet/*", "--role", "server",
                     "--max-restarts", "1", "--out", out_});
  }
  static std::string device_dying_of(const std::string& text) {
    return "exec:/usr/bin/python3 " FIELDPROOF_SOURCE_DIR
           "/suites/tool/testdata/device.py die_of {tty} " +
           text;
  }
  TestFolder folder_;
  std::string out_ = folder_ / "out";
};

class HostileDevices : public HostileRuns, public testing::WithParamInterface<Hostile> {};

TEST_P(HostileDevices, CostBoundedMemoryAndDisk) {
  const Finished finished = run(GetParam());
  EXPECT_EQ(finished.code, 3) << finished.out.substr(0, 4000) << finished.err;
  // The reports of a good device have 7 MB: each of its exchanges in full.
  EXPECT_LT(size_of(out_), 8'000'000u);
  EXPECT_LT(finished.out.size(), 1'000'000u);
#ifndef FIELDPROOF_SANITIZED  // the tool, not this test
  EXPECT_LT(finished.peak_kib, 100 * 1024);
#endif
  expect_reports(out_);
}

INSTANTIATE_TEST_SUITE_P(OnAPty, HostileDevices,
                         testing::Values(Hostile{"flood"}, Hostile{"half"}, Hostile{"die"}),
                         [](const auto& one) { return std::string(one.param.behaviour); });
INSTANTIATE_TEST_SUITE_P(OnASocket, HostileDevices, testing::Values(Hostile{"flood", true}),
                         [](const auto& one) { return std::string(one.param.behaviour); });

/// They wait more than they compute: all at once.
TEST_F(HostileRuns, OthersEndSoonOverAWholeSuiteAndSayWhy) {
  const std::pair<std::string, std::string> why[] = {
      {"mute", "the device was lost 1 times"},
      {"stuck", "the device was lost 1 times"},
      {"trickle", "the device was lost 1 times"},
      {"garbage", "no whole frame came from the device in the last cases"}};
  std::vector<std::unique_ptr<Process>> runs;
  for (const auto& [behaviour, reason] : why)
    runs.push_back(std::make_unique<Process>(tool_arguments(
        {"run", "--endpoint", device(behaviour, false), "--profile", "xbc-h", "--filter",
         "xgt_cnet/*", "--role", "server", "--max-restarts", "0", "--out", out_ + behaviour})));
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto& [behaviour, reason] = why[i];
    SCOPED_TRACE(behaviour);
    const Finished finished = runs[i]->wait();
    EXPECT_EQ(finished.code, 3) << finished.out.substr(0, 4000);
    EXPECT_THAT(finished.err, HasSubstr(reason));
    EXPECT_LT(size_of(out_ + behaviour), 8'000'000u);
    const Results results = read_results(out_ + behaviour + "/results.ndjson");
    EXPECT_LE(results.counts()["FAIL"] + results.counts()["ERROR"], 25u);
    EXPECT_GT(results.counts()["BLOCKED"], 2000u);
    expect_reports(out_ + behaviour);
  }
}

/// Good for the measuring of the link and some cases; then each answer begins well, and goes on.
TEST_F(HostileRuns, AReplyThatDoesNotEndIsNamedSo) {
  const Finished finished =
      run_tool({"run", "--endpoint", device("endless", false), "--profile", "xbc-h", "--vectors",
                write_vectors(folder_, many_vectors(20)), "--max-restarts", "0", "--out", out_});
  EXPECT_EQ(finished.code, 3) << finished.out;
  const Results results = read_results(out_ + "/results.ndjson");
  EXPECT_GT(results.counts()["PASS"], 2u);
  EXPECT_EQ(results.counts()["FAIL"], 1u);
  const auto failed = std::ranges::find(results.cases, "FAIL", [](const nlohmann::json& one) {
    return one.at("verdict").get<std::string>();
  });
  ASSERT_NE(failed, results.cases.end());
  EXPECT_THAT(failed->at("message").get<std::string>(), HasSubstr("the reply does not end: "));
  EXPECT_THAT(failed->dump(), HasSubstr("link dead after this frame: it sends without end"));
}

TEST_F(HostileRuns, WhatNeverStopsIsNamedBeforeTheFirstCase) {
  const Finished finished = run_tool(
      {"run", "--endpoint",
       "exec:/usr/bin/python3 " FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/device.py flood {tty}",
       "--profile", "xbc-h", "--vectors", write_vectors(folder_, many_vectors(2)), "--out", out_});
  EXPECT_EQ(finished.code, 3) << finished.out;
  EXPECT_THAT(finished.err, HasSubstr("does not end, so that no request gets an answer"));
  EXPECT_TRUE(read_results(out_ + "/results.ndjson").cases.empty());
}

/// One frame kills it: that case names the frame, and the others are judged.
TEST_F(HostileRuns, ADeviceWithAFaultIsStartedAgain) {
  std::vector<nlohmann::ordered_json> vectors = many_vectors(3);
  vectors[1]["given"]["memory"] = {{"%MW100", "1234"}};
  const Finished finished =
      run_tool({"run", "--endpoint", device_dying_of("wSS0106%MW1001234"), "--profile", "xbc-h",
                "--vectors", write_vectors(folder_, vectors), "--out", out_});
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  const Results results = read_results(out_ + "/results.ndjson");
  EXPECT_EQ(results.counts(), (std::map<std::string, std::size_t>{{"FAIL", 1}, {"PASS", 2}}));
  EXPECT_THAT(results.of("xgt_cnet/many/n1001").at("message").get<std::string>(),
              HasSubstr("the device ended while its memory was read or set, after ENQ "
                        "'01wSS0106%MW1001234' EOT"));
}

/// As often as is allowed, and each case names its frame.
TEST_F(HostileRuns, OneThatDiesInEachCaseIsGivenUp) {
  const Finished finished =
      run_tool({"run", "--endpoint", device_dying_of("%MW100"), "--profile", "xbc-h", "--vectors",
                write_vectors(folder_, many_vectors(6)), "--max-restarts", "3", "--out", out_});
  EXPECT_EQ(finished.code, 3) << finished.out;
  EXPECT_THAT(finished.err, HasSubstr("the device was lost 4 times (it ended, fell mute or sent "
                                      "without end)"));
  EXPECT_EQ(read_results(out_ + "/results.ndjson").counts(),
            (std::map<std::string, std::size_t>{{"BLOCKED", 2}, {"FAIL", 4}}));
  EXPECT_THAT(finished.out, HasSubstr("the device ended after ENQ '01rSS0106%MW100' EOT"));
}

/// What came is in every report by both ends, count and hash; nobody judges it again from them.
TEST_F(HostileRuns, OfAFloodTheReportsHaveAnExtract) {
  const std::string vectors = write_vectors(folder_, many_vectors(1));
  const Finished finished =
      run_tool({"run", "--endpoint", device("flood", false), "--profile", "xbc-h", "--vectors",
                vectors, "--repeat", "20", "--out", out_, "--capture", out_ + "/run.pcapng"});
  // 3: the floods came so close together that the bench gave the device up.
  EXPECT_THAT(finished.code, testing::AnyOf(1, 3)) << finished.out << finished.err;
  const Results results = read_results(out_ + "/results.ndjson");
  const auto flooded = std::ranges::find_if(results.cases, has_extract);
  ASSERT_NE(flooded, results.cases.end());
  const nlohmann::json extract = extract_of(*flooded);
  EXPECT_GT(extract.at("count"), 16'384);
  const std::string hash = extract.at("sha256");
  EXPECT_EQ(hash.size(), 64u);
  EXPECT_LT(flooded->dump().size(), 10'000u);
  for (const char* report : {"junit.xml", "report.html", "results.json", "run.pcapng"})
    EXPECT_THAT(read_text(out_ + '/' + report), HasSubstr(hash)) << report;
  EXPECT_THAT(finished.out, HasSubstr("bytes in all, sha256 " + hash));
  const Finished decoded =
      run_program({"tshark", "-r", out_ + "/run.pcapng", "-Y", "frame.cap_len < frame.len"});
  EXPECT_EQ(decoded.code, 0) << decoded.err;
  EXPECT_NE(decoded.out, "") << "a packet of which less was captured than there was";

  const std::string file = out_ + "/results.ndjson";
  const Finished judged =
      run_tool({"judge", file, "--vectors", vectors, "--out", folder_ / "judged"});
  EXPECT_THAT(judged.out, HasSubstr("not all bytes were kept"));
  const Results again = read_results(folder_ / "judged/results.ndjson");
  for (std::size_t i = 0; i < again.cases.size(); ++i)
    if (has_extract(results.cases[i])) {
      EXPECT_EQ(again.cases[i].at("verdict"), "INCONCLUSIVE") << i;
    }
  EXPECT_GT(again.counts().at("INCONCLUSIVE"), 0u);

  const Finished compared = run_tool({"compare", file, file});
  EXPECT_EQ(compared.code, 0) << compared.out << compared.err;
  const Finished merged = run_tool({"merge", file, "--out", folder_ / "merged"});
  EXPECT_EQ(read_results(folder_ / "merged/results.ndjson").cases, results.cases)
      << merged.out << merged.err;
}

/// What fails for the same reason again and again is one finding with its count, at the end of the
/// console, in JUnit and in HTML.
TEST_F(HostileRuns, TheSameFailureIsToldOnce) {
  std::vector<nlohmann::ordered_json> vectors;
  for (int i = 0; i < 5; ++i)
    vectors.push_back(small_vector("many/n" + std::to_string(i), wrong_word));
  const Finished finished =
      run_tool({"run", "--endpoint", device("good", false), "--profile", "xbc-h", "--vectors",
                write_vectors(folder_, vectors), "--out", out_});
  EXPECT_THAT(finished.out, HasSubstr("red:\n  "));
  EXPECT_THAT(finished.out, HasSubstr(" cases: "));
  EXPECT_THAT(finished.out, HasSubstr(" (first: xgt_cnet/"));
  EXPECT_THAT(read_text(out_ + "/junit.xml"), AllOf(HasSubstr("<property name=\"finding 1\""),
                                                    HasSubstr("finding 1, as xgt_cnet/")));
  EXPECT_THAT(read_text(out_ + "/report.html"), HasSubstr("<section class=\"cause\">"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
