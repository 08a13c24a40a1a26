// Several devices of a bench file share one run.
#include <gmock/gmock.h>

#include <memory>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::Not;
using testing::UnorderedElementsAreArray;

/// Cases that take a while without work for the processor, so that no port gets them all.
std::vector<nlohmann::ordered_json> slow_vectors(int count) {
  std::vector<nlohmann::ordered_json> vectors = many_vectors(count);
  const nlohmann::ordered_json wait{{"wait", "120ms"}};
  for (auto& vector : vectors) vector["steps"].insert(vector["steps"].begin(), wait);
  return vectors;
}

/// A bench of small devices (testdata/device.py), one word of whose memory is asked.
class SharedRuns : public testing::Test {
 protected:
  nlohmann::ordered_json device(const std::string& behaviour, const std::string& more = "") {
    const std::string command = "/usr/bin/python3 " FIELDPROOF_SOURCE_DIR
                                "/suites/tool/testdata/device.py " +
                                behaviour + " {tty} " + more;
    return {{"endpoint", "exec:" + command},
            {"profile", "xbc-h"},
            {"identity", {{"maker", "LS"}, {"serial", "S-" + std::to_string(++made_)}}}};
  }

  Finished run(const nlohmann::ordered_json& devices, int cases,
               const std::vector<std::string>& more = {}, const ProcessOptions& options = {}) {
    std::vector<std::string> duts;
    for (const auto& [name, ignored] : devices.items()) duts.insert(duts.end(), {"--dut", name});
    duts.insert(duts.end(), more.begin(), more.end());
    return run_on(devices, slow_vectors(cases), duts, options);
  }

  /// The devices are chosen by `more`.
  Finished run_on(const nlohmann::ordered_json& devices,
                  const std::vector<nlohmann::ordered_json>& vectors,
                  const std::vector<std::string>& more, const ProcessOptions& options = {}) {
    const std::string bench =
        folder_.write("bench.json", nlohmann::ordered_json{{"devices", devices}}.dump(1));
    std::vector<std::string> arguments{
        "run",   "--bench",      bench, "--vectors", write_vectors(folder_, vectors),
        "--out", folder_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments, options);
  }

  /// On two good devices, of which every case expects what they do not hold.
  Finished run_with_wrong_words(int cases, const std::vector<std::string>& more) {
    std::vector<nlohmann::ordered_json> vectors = slow_vectors(cases);
    for (auto& vector : vectors) vector["steps"][2]["expect"] = wrong_word;
    std::vector<std::string> arguments{"--dut", "a,b"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_on(two_good(), vectors, arguments);
  }

  nlohmann::ordered_json two_good() { return {{"a", device("good")}, {"b", device("good")}}; }

  Results results() { return read_results(folder_ / "out/results.ndjson"); }
  static std::vector<std::string> ids(int cases) {
    std::vector<std::string> all;
    for (const auto& vector : many_vectors(cases)) all.push_back(vector["id"]);
    return all;
  }

  TestFolder folder_;
  int made_ = 0;
};

TEST_F(SharedRuns, EachCaseRunsOnceAndSaysWhere) {
  const Finished finished = run({{"a", device("good")}, {"b", device("good")}}, 20);
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  expect_reports(folder_ / "out");
  const Results shared = results();
  EXPECT_THAT(shared.ids(), UnorderedElementsAreArray(ids(20)));
  EXPECT_EQ(shared.counts(), (std::map<std::string, std::size_t>{{"PASS", 20}}));
  std::map<std::string, int> done;
  for (const auto& one : shared.cases) ++done[one.at("dut")];
  EXPECT_THAT(done, AllOf(Contains(Key("a")), Contains(Key("b")))) << "both ports work";
  EXPECT_EQ(shared.run["duts"][1]["identity"]["serial"], "S-2");
  EXPECT_EQ(shared.run["identity"], (nlohmann::json{{"maker", "LS"}}))
      << "what the devices have in common";
}

TEST_F(SharedRuns, EveryReportNamesTheDevice) {
  const Finished finished = run({{"a", device("good")}, {"b", device("good")}}, 20, {"--qualify"});
  EXPECT_EQ(finished.code, 0);
  EXPECT_THAT(finished.out, HasSubstr("\n  b: LS, serial number S-2, at exec:"));
  const std::string junit = read_text(folder_ / "out/junit.xml"),
                    html = read_text(folder_ / "out/report.html");
  EXPECT_THAT(junit, AllOf(HasSubstr(R"(name="dut.a" value="LS, serial number S-1, at exec:)"),
                           HasSubstr("floor 20.0 ms (20 answers by the device"),
                           HasSubstr("device a\n"), HasSubstr("device b\n")));
  EXPECT_THAT(html,
              AllOf(HasSubstr("serial number S-1"), HasSubstr("serial number S-2"),
                    HasSubstr("<small class=\"dut\">a</small>"), HasSubstr("Fingerprint of b")));
}

TEST_F(SharedRuns, WhatAVanishedDeviceLeavesGoesToTheOthers) {
  // The sanity exchange and the floor are its first 21 requests, so it dies in its second case.
  const Finished finished =
      run({{"mortal", device("die", "24")}, {"b", device("good")}}, 20, {"--max-restarts", "0"});
  EXPECT_EQ(finished.code, 3) << finished.out;
  EXPECT_THAT(finished.err, HasSubstr("mortal: the port failed in xgt_cnet/many/"));
  expect_reports(folder_ / "out");
  const Results shared = results();
  EXPECT_THAT(shared.ids(), UnorderedElementsAreArray(ids(20)));
  EXPECT_EQ(shared.counts(), (std::map<std::string, std::size_t>{{"PASS", 20}}))
      << "no case is lost, none is an error";
  int taken_over = 0;
  for (const auto& one : shared.cases)
    taken_over += one.value("notes", nlohmann::json::array())
                      .dump()
                      .find("begun on mortal, whose port failed") != std::string::npos;
  EXPECT_EQ(taken_over, 1);
}

TEST_F(SharedRuns, WithNoDeviceLeftTheRestIsBlocked) {
  const Finished finished =
      run({{"a", device("die", "25")}, {"b", device("die", "25")}}, 20, {"--max-restarts", "0"});
  EXPECT_EQ(finished.code, 3) << finished.out;
  const Results shared = results();
  EXPECT_THAT(shared.ids(), UnorderedElementsAreArray(ids(20))) << "each case has a result";
  EXPECT_GE(shared.counts()["ERROR"], 1u) << "what the ports failed in";
  EXPECT_GT(shared.counts()["BLOCKED"], 10u);
  ASSERT_FALSE(shared.cases.empty());
  EXPECT_THAT(shared.cases.back()["message"].get<std::string>(),
              AllOf(HasSubstr("no port is left: "), HasSubstr("a: "), HasSubstr("b: ")));
}

TEST_F(SharedRuns, ADeviceThatIsDumbFromTheStartLeavesAllToTheOthers) {
  const Finished finished = run({{"dumb", device("die", "0")}, {"b", device("good")}}, 10);
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, HasSubstr("dumb: "));
  EXPECT_EQ(results().counts()["PASS"], 10u);
}

TEST_F(SharedRuns, ShardsAndRepetitionsAreSharedToo) {
  EXPECT_EQ(
      run({{"a", device("good")}, {"b", device("good")}}, 10, {"--repeat", "3"},
          {.environment = {{"GTEST_TOTAL_SHARDS", "2"}, {"GTEST_SHARD_INDEX", "1"}}, .folder = ""})
          .code,
      0);
  const Results shared = results();
  EXPECT_EQ(shared.cases.size(), 15u);
  EXPECT_EQ(shared.run["properties"]["shard"], "2/2");
}

TEST_F(SharedRuns, FailFastStopsAllPorts) {
  EXPECT_EQ(run_with_wrong_words(200, {"--fail-fast"}).code, 1);
  EXPECT_LE(results().cases.size(), 2u) << "what the other port had begun is still told";
}

TEST_F(SharedRuns, BehindMaxFailuresTheRestSaysSo) {
  EXPECT_EQ(run_with_wrong_words(30, {"--max-failures", "3"}).code, 1);
  const Results shared = results();
  EXPECT_THAT(shared.ids(), UnorderedElementsAreArray(ids(30))) << "each has a result";
  std::map<std::string, std::size_t> counts = shared.counts();
  EXPECT_GE(counts["FAIL"], 3u);
  EXPECT_LE(counts["FAIL"], 4u) << "what the other port had begun is still told";
  EXPECT_EQ(counts["FAIL"] + counts["BLOCKED"], 30u);
  EXPECT_EQ(shared.cases.back().at("message"), "not run: --max-failures 3 was reached");
  expect_reports(folder_ / "out");
}

TEST_F(SharedRuns, UnlikeDevicesAreRefused) {
  nlohmann::ordered_json other = device("good");
  other["profile"] = "xbm-s";
  const Finished finished = run({{"a", device("good")}, {"b", other}}, 1);
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, HasSubstr("cannot share the cases between a and b: their profiles are "
                                      "xbc-h and xbm-s; run them apart"));
  EXPECT_THAT(run({{"a", device("good")}}, 1, {"--dut", "a"}).err,
              HasSubstr("--dut a is given twice"));
  EXPECT_THAT(
      run({{"a", device("good")}, {"b", device("good")}}, 1, {"--endpoint", "emulator:"}).err,
      HasSubstr("leave --endpoint out"));
  EXPECT_THAT(run({{"a", device("good")}, {"b", device("good")}}, 1, {"--dut", "c"}).err,
              HasSubstr("no device 'c'"));
}

TEST_F(SharedRuns, WhatIsOfOneDeviceIsRefused) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--matrix", "9600 x 8N1"},
                                               {"--duration", "1h"},
                                               {"--loop", "pty:xbc-h"}}) {
    const Finished finished = run({{"a", device("good")}, {"b", device("good")}}, 1, more);
    EXPECT_EQ(finished.code, 2);
    EXPECT_THAT(finished.err, HasSubstr(more.front() + " is of one device; give one --dut"));
  }
}

TEST_F(SharedRuns, DevicesAreChosenByWhatTheyAre) {
  nlohmann::ordered_json devices{
      {"a", device("good")}, {"b", device("good")}, {"c", device("good")}};
  for (const char* name : {"a", "b"}) devices[name]["identity"]["model"] = "XBL-C41A";
  devices["c"]["identity"]["model"] = "XBL-C21A";
  const auto run_chosen = [&](const std::string& dut) {
    return run_on(devices, slow_vectors(6), {"--dut", dut});
  };
  EXPECT_EQ(run_chosen("model=XBL-C41A").code, 0);
  EXPECT_EQ(results().run["duts"].size(), 2u);
  EXPECT_EQ(run_chosen("model=XBL-C21A").code, 0);
  EXPECT_EQ(results().run["identity"]["name"], "c") << "one alone";
  EXPECT_THAT(run_chosen("model=XBL-C42A").err,
              HasSubstr("has model=XBL-C42A; there is XBL-C21A, XBL-C41A"));
  EXPECT_THAT(run_chosen("colour=red").err,
              HasSubstr("write model=, maker=, serial= or firmware="));
}

TEST_F(SharedRuns, TheLongestCaseIsTakenFirst) {
  std::vector<nlohmann::ordered_json> vectors = slow_vectors(20);
  vectors.back()["steps"][0]["wait"] = "1s";
  EXPECT_EQ(run_on(two_good(), vectors, {"--dut", "a,b"}).code, 0);
  EXPECT_NE(results().ids().back(), vectors.back()["id"]) << "one port would wait for it";
}

TEST_F(SharedRuns, AnAbsentDeviceLeavesThePool) {
  nlohmann::ordered_json absent = device("good");
  absent["endpoint"] = "serial:" + (folder_ / "nothing");
  const nlohmann::ordered_json devices{{"a", absent}, {"b", device("good")}, {"c", device("good")}};
  const Finished finished = run(devices, 10);
  EXPECT_EQ(finished.code, 3) << finished.out;
  EXPECT_THAT(finished.err, HasSubstr("a: cannot open " + (folder_ / "nothing")));
  EXPECT_EQ(results().counts(), (std::map<std::string, std::size_t>{{"PASS", 10}}));
  EXPECT_EQ(results().run["duts"].size(), 2u);
  EXPECT_EQ(run(devices, 10, {"--skip-absent"}).code, 0);
  const Finished all = run({{"a", absent}, {"b", absent}}, 10, {"--skip-absent"});
  EXPECT_EQ(all.code, 77) << all.out;
  EXPECT_THAT(all.err, AllOf(HasSubstr("a: cannot open"), HasSubstr("b: cannot open")));
}

TEST_F(SharedRuns, ACaseGoesToWhoCouldRunIt) {
  const auto emulated = [&](const char* writes) {
    nlohmann::ordered_json one = device("good");
    one["endpoint"] = "exec:" FIELDPROOF_TOOL " emulate xbc-h --pty {tty}";
    one["allow_write"] = {writes};
    return one;
  };
  std::vector<nlohmann::ordered_json> vectors = slow_vectors(12);
  for (int i = 0; i < 12; i += 2)
    vectors[i]["steps"] = {{{"send", "[ENQ st 'wSS' '01' name(%MW100) '1234' EOT BCC]"}},
                           {{"expect", "[ACK st 'wSS' ETX BCC]"}}};
  const nlohmann::ordered_json devices{{"a", emulated("M100")}, {"b", emulated("D0")}};
  EXPECT_EQ(run_on(devices, vectors, {"--dut", "b,a"}).code, 0);
  EXPECT_EQ(results().counts(), (std::map<std::string, std::size_t>{{"PASS", 12}}));
  for (int i = 0; i < 12; i += 2) EXPECT_EQ(results().of(vectors[i]["id"])["dut"], "a");
}

TEST_F(SharedRuns, WhatOnlyADeadDeviceCouldRunIsBlockedWithItsName) {
  nlohmann::ordered_json mortal = device("die", "23"), other = device("good");
  mortal["allow_write"] = {"M100"};
  other["allow_write"] = {"D0"};
  std::vector<nlohmann::ordered_json> vectors = slow_vectors(12);
  for (int i = 6; i < 12; ++i)
    vectors[i]["steps"].push_back({{"send", "[ENQ st 'wSS' '01' name(%MW100) '1234' EOT BCC]"}});
  const Finished finished =
      run_on({{"a", mortal}, {"b", other}}, vectors, {"--dut", "a,b", "--max-restarts", "0"});
  EXPECT_EQ(finished.code, 3) << finished.out;
  EXPECT_EQ(results().cases.size(), 12u);
  EXPECT_THAT(results().of(vectors[11]["id"])["message"].get<std::string>(),
              HasSubstr("only a could run it: a: the port failed in"));
}

/// Each device has a journal of its own: what is open of one is put back, or forgotten, without the
/// other.
TEST_F(SharedRuns, EachDeviceHasItsJournal) {
  std::map<std::string, std::unique_ptr<Process>> wires, plcs;
  nlohmann::ordered_json devices;
  for (const std::string name : {"a", "b"}) {
    plcs[name] = std::make_unique<Process>(std::vector<std::string>{
        FIELDPROOF_TOOL, "emulate", "xbc-h", "--pty", folder_ / ("plc_" + name)});
    ASSERT_TRUE(plcs[name]->wait_for(folder_ / ("plc_" + name)));
    wires[name] = std::make_unique<Process>(
        std::vector<std::string>{"socat", "-d", "-d", "pty,raw,echo=0,link=" + (folder_ / name),
                                 "file:" + (folder_ / ("plc_" + name)) + ",raw,echo=0"});
    ASSERT_TRUE(wires[name]->wait_for("starting data transfer loop"));
    devices[name] = {{"endpoint", "serial:" + (folder_ / name)},
                     {"profile", "xbc-h"},
                     {"allow_write", {"M100-M119"}}};
  }
  const std::string bench =
      folder_.write("bench.json", nlohmann::ordered_json{{"devices", devices}}.dump());
  const auto journal = [&](const std::string& name) {
    return folder_ / ("out/journal-" + name + ".ndjson");
  };
  const auto run_both = [&](const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run",      "--bench",        bench,   "--dut",        "a,b",
                                       "--filter", "xgt_cnet/wsb/*", "--out", folder_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  };
  const auto open = [&](const std::string& name) {
    folder_.write(
        "out/journal-" + name + ".ndjson",
        R"({"saved":{"address":"%MW105","config":{},"endpoint":"serial:)" + (folder_ / name) +
            R"(","model":"xbc-h","number":1,"protocol":"xgt-cnet","station":1,"value":"1234"}})" +
            "\n");
  };
  EXPECT_EQ(run_both().code, 0);
  for (const std::string name : {"a", "b"}) {
    EXPECT_THAT(read_text(journal(name)), AllOf(HasSubstr("saved"), HasSubstr(folder_ / name)));
    EXPECT_THAT(run_tool({"restore", journal(name)}).out, HasSubstr("nothing to put back"));
  }
  open("a");
  open("b");
  EXPECT_THAT(run_both().err, HasSubstr("type: fieldproof restore " + journal("a")));
  EXPECT_EQ(run_tool({"restore", journal("a")}).code, 0);
  EXPECT_THAT(run_both().err, HasSubstr("type: fieldproof restore " + journal("b")));
  EXPECT_EQ(run_both({"--discard-journal"}).code, 0);
  EXPECT_THAT(run_tool({"restore", journal("b")}).out, HasSubstr("nothing to put back"));
}

TEST_F(SharedRuns, CtrlCEndsAllPorts) {
  const std::string fifo = folder_ / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  const std::string bench = folder_.write(
      "bench.json",
      nlohmann::ordered_json{
          {"devices", {{"a", device("tell", fifo + " 25")}, {"b", device("mute", "25")}}}}
          .dump());
  Process tool(
      tool_arguments({"run", "--bench", bench, "--dut", "a", "--dut", "b", "--vectors",
                      write_vectors(folder_, slow_vectors(500)), "--out", folder_ / "out"}));
  EXPECT_EQ(read_text(fifo), "asked");
  tool.signal(SIGINT);
  const Finished finished = tool.wait();
  EXPECT_EQ(finished.code, 130) << finished.out << finished.err;
  expect_reports(folder_ / "out");
  EXPECT_EQ(results().end["interrupted"], true);
}

}  // namespace
}  // namespace fieldproof::tool_tests
