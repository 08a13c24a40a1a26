// What a run writes on a device is put back: after each case, and by `fieldproof restore` after a
// run that was killed. The device is the emulator in a process of its own behind two ptys, so it
// survives the run.
#include <gmock/gmock.h>

#include "suites/tool/at_moment.hpp"
#include "suites/tool/joined_ptys.hpp"
#include "suites/tool/plc_client.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;
using Memory = std::map<std::string, std::string>;

const plc::PlcModel& xbc() { return plc::plc_models().front(); }

/// These tests kill runs: what is noted of their devices is not for the user's own runs to find.
class StateFolder : public testing::Environment {
 public:
  void SetUp() override {
    folder_ = std::make_unique<TestFolder>();
    ::setenv("XDG_STATE_HOME", folder_->path().c_str(), 1);
  }
  void TearDown() override { folder_.reset(); }

 private:
  std::unique_ptr<TestFolder> folder_;
};
[[maybe_unused]] const testing::Environment* const state_folder =
    testing::AddGlobalTestEnvironment(new StateFolder);

class Restore : public testing::Test {
 protected:
  Restore() : device_({FIELDPROOF_TOOL, "emulate", "xbc-h", "--pty", folder_ / "device"}) {
    EXPECT_TRUE(device_.wait_for(folder_ / "device"));
    plug_in();
    PlcClient client(folder_ / "bench");
    client.fill(xbc());
    before_ = client.read(xbc());
  }
  /// The system gives the pty of this device to another one.
  ~Restore() override {
    std::filesystem::remove_all(std::string(::getenv("XDG_STATE_HOME")) + "/fieldproof");
  }

  /// The adapter: a pty for the bench, joined to that of the device. The device keeps its memory
  /// without it.
  void plug_in() {
    adapter_ = std::make_unique<Process>(
        std::vector<std::string>{"socat", "-d", "-d", "pty,raw,echo=0,link=" + (folder_ / "bench"),
                                 "file:" + (folder_ / "device") + ",raw,echo=0"});
    EXPECT_TRUE(adapter_->wait_for("starting data transfer loop"));
  }

  Memory memory() const { return PlcClient(folder_ / "bench").read(xbc()); }
  std::string endpoint() const { return "serial:" + (folder_ / "bench"); }
  std::string journal() const { return folder_ / "out/journal.ndjson"; }
  std::vector<std::string> run_arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run",   "--endpoint", endpoint(),     "--profile",
                                       "xbc-h", "--out",      folder_ / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  void expect_as_before() const {
    std::string changed;
    for (const auto& [name, reply] : memory())
      if (before_.at(name) != reply) changed += name + " ";
    EXPECT_EQ(changed, "");
  }

  /// A run in the middle of write cases: its journal has so many lines.
  std::unique_ptr<Process> writing_run(int lines) const {
    std::filesystem::remove_all(folder_ / "out");
    std::filesystem::create_directories(folder_ / "out");
    const FileWatch journal_watch(journal());
    auto run = std::make_unique<Process>(tool_arguments(run_arguments(
        {"--allow-write", "M100-M119", "--filter", "xgt_cnet/w*:xgt_cnet/data_types/*"})));
    EXPECT_TRUE(journal_watch.wait_until([&](const std::string& text) {
      return std::count(text.begin(), text.end(), '\n') >= lines;
    })) << lines;
    return run;
  }
  /// Of a run of one case that may write M119.
  void expect_nothing_to_doubt(const std::string& steps) {
    folder_.write("one.json", R"([{
      "id": "xgt_cnet/one/write", "title": "What one case writes to M119", "level": "info",
      "basis": "derived", "why": "nothing forbids it", "statement": "xgb-cnet-en-1.6/7.1.5-3c-frame",
      "given": {"memory": {"%MW119": "0000"}}, "steps": [)" +
                                  steps + "]}]");
    const Finished run =
        run_tool(run_arguments({"--vectors", folder_ / "one.json", "--allow-write", "M100-M119"}));
    EXPECT_EQ(run.code, 0) << run.out << run.err;
    EXPECT_EQ(run.err, "");
    expect_as_before();
  }
  /// All is as before; was there anything to put back?
  bool restores() const {
    const Finished restored = run_tool({"restore", journal()});
    EXPECT_EQ(restored.code, 0) << restored.out << restored.err;
    expect_as_before();
    return restored.out.find("restored  ") != std::string::npos;
  }
  /// One case at most has the verdict of it; the rest is not judged, and says why.
  void expect_vanished(const std::string& why) const {
    expect_reports(folder_ / "out");
    EXPECT_NE(read_text(folder_ / "out/report.html"), "");
    const Results results = read_results(folder_ / "out/results.ndjson");
    std::map<std::string, std::size_t> counts = results.counts();
    EXPECT_LE(counts["FAIL"] + counts["ERROR"], 1u);
    EXPECT_GT(counts["BLOCKED"], 100u);
    EXPECT_THAT(results.cases.back().dump(), HasSubstr(why));
  }

  TestFolder folder_;
  Process device_;
  std::unique_ptr<Process> adapter_;
  Memory before_;
};

TEST_F(Restore, ARunInAFewWordsLeavesTheMemoryAsItWas) {
  const Finished run =
      run_tool(run_arguments({"--allow-write", "M100-M119", "--filter",
                              "xgt_cnet/w*:xgt_cnet/errors/*:xgt_cnet/monitor_*"}));
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  expect_as_before();
  const Results results = read_results(folder_ / "out/results.ndjson");
  const auto moved = std::ranges::count_if(results.cases, [](const nlohmann::json& one) {
    return one.at("verdict") == "PASS" &&
           one.value("notes", nlohmann::json()).dump().find("transposed: %") != std::string::npos;
  });
  EXPECT_GT(moved, 200) << "cases that had to be moved into M100-M119";
}

TEST_F(Restore, ARunThatMayWriteEverythingDoesToo) {
  const Finished run =
      run_tool(run_arguments({"--allow-write", "all,P,Q,U", "--role", "server", "--filter",
                              "xgt_cnet/*:-xgt_cnet/timing/*:-xgt_cnet/line/*"}));
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  expect_as_before();
}

TEST_F(Restore, AfterAKillAtAnyMomentRestorePutsBack) {
  std::size_t left_open = 0;
  const auto kill_behind = [&](int lines) {
    const std::unique_ptr<Process> run = writing_run(lines);
    run->signal(SIGKILL);
    EXPECT_EQ(run->wait().code, 128 + SIGKILL);
    left_open += restores();
    EXPECT_THAT(run_tool({"restore", journal()}).out, HasSubstr("nothing to put back"));
  };
  for (const int lines : {1, 2, 3, 8, 25, 60}) kill_behind(lines);
  for (int lines = 4; left_open == 0 && lines < 30; ++lines) kill_behind(lines);  // all between two
  EXPECT_GT(left_open, 0u) << "no kill hit a case that was writing";
}

TEST_F(Restore, ARunToAnotherFolderFindsWhatIsOpen) {
  const auto run_elsewhere = [&](const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments =
        run_arguments({"--allow-write", "M100-M119", "--filter", "xgt_cnet/wsb/*"});
    arguments[6] = folder_ / "elsewhere";
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  };
  const auto kill_one = [&] {
    const std::unique_ptr<Process> run = writing_run(8);
    run->signal(SIGKILL);
    run->wait();
  };
  kill_one();
  folder_.write("out/journal.ndjson",
                R"({"saved":{"address":"%MW105","config":{},"endpoint":")" + endpoint() +
                    R"(","model":"xbc-h","number":1,"protocol":"xgt-cnet","station":1,)" +
                    R"("value":"1234"}})" + "\n");
  const Finished refused = run_elsewhere();
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("type: fieldproof restore " + journal()));
  EXPECT_EQ(run_tool({"restore", journal()}).code, 0);
  EXPECT_EQ(run_elsewhere().code, 0);
  kill_one();
  std::filesystem::remove_all(folder_ / "out");
  const Finished gone = run_elsewhere();
  EXPECT_EQ(gone.code, 2);
  EXPECT_THAT(gone.err, HasSubstr("stood in " + journal() + ", which is gone"));
  EXPECT_EQ(run_elsewhere({"--discard-journal"}).code, 0);
  EXPECT_EQ(run_elsewhere().code, 0) << "a run that ends leaves no note";
}

/// No value is overwritten that the journal could not take.
TEST_F(Restore, AfterAFullDiskAtAnyMomentRestorePutsBack) {
  std::size_t left_open = 0;
  for (const int moment : {40, 90, 171, 332}) {
    SCOPED_TRACE(moment);
    std::filesystem::remove_all(folder_ / "out");
    const Finished finished =
        run_tool(run_arguments({"--allow-write", "M100-M119", "--filter", "xgt_cnet/w*"}),
                 {.environment = at_moment(moment, "full"), .folder = ""});
    EXPECT_EQ(finished.code, 3) << finished.out << finished.err;
    EXPECT_THAT(finished.err, HasSubstr("no space left on device"));
    left_open += restores();
  }
  EXPECT_GT(left_open, 0u) << "the disk was never full while a case was writing";
}

/// Unplugged: the master end of the port closes.
TEST_F(Restore, AfterTheAdapterIsPulledOutRestorePutsBack) {
  std::size_t left_open = 0;
  for (const int lines : {1, 9, 41}) {
    const std::unique_ptr<Process> run = writing_run(lines);
    adapter_.reset();
    const Finished finished = run->wait();
    EXPECT_EQ(finished.code, 3) << finished.out << finished.err;
    expect_vanished("the port failed ");
    plug_in();
    left_open += restores();
  }
  EXPECT_GT(left_open, 0u) << "no case was writing";
}

/// It loses its power, so to speak, but not its memory: the port is there, and nobody answers.
TEST_F(Restore, AfterTheDeviceFellSilentRestorePutsBack) {
  const std::unique_ptr<Process> run = writing_run(1);
  device_.signal(SIGSTOP);
  const Finished finished = run->wait();
  EXPECT_EQ(finished.code, 3) << finished.out << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("the link is dead since xgt_cnet/"));
  expect_vanished("the link is dead since ");
  device_.signal(SIGCONT);
  restores();
}

/// A bit in twelve bursts flips, both ways: in the run, which is killed, in the next one and in
/// `restore`.
TEST_F(Restore, OverANoisyLineMemoryIsAsBeforeOrNamed) {
  adapter_.reset();
  std::vector<nlohmann::ordered_json> vectors = many_vectors(6);
  for (std::size_t i = 0; i < vectors.size(); ++i)
    vectors[i]["given"]["memory"] = {{fmt::format("%MW{}", 100 + i), "1234"}, {"%MW110", "5678"}};
  const std::string written = write_vectors(folder_, vectors);
  std::string said;
  {
    Process noisy({"/usr/bin/python3", FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/noisy_line.py",
                   folder_ / "noisy", folder_ / "device", "5"});
    ASSERT_TRUE(noisy.wait_for("ready"));
    const auto arguments = [&](const std::string& out) {
      return std::vector<std::string>{"run",       "--endpoint", "serial:" + (folder_ / "noisy"),
                                      "--profile", "xbc-h",      "--vectors",
                                      written,     "--out",      folder_ / out,
                                      "--floor",   "1ms",        "--allow-write",
                                      "M100-M119"};
    };
    std::filesystem::create_directories(folder_ / "out");
    {
      const FileWatch watch(journal());
      Process killed(tool_arguments(arguments("out")));
      EXPECT_TRUE(watch.wait_until(
          [](const std::string& text) { return std::ranges::count(text, '\n') >= 5; }));
      killed.signal(SIGKILL);
      killed.wait();
    }
    const Finished restored = run_tool({"restore", journal()});
    said += restored.out;
    EXPECT_EQ(restored.code, restored.out.find("NOT RESTORED") == std::string::npos ? 0 : 3)
        << restored.out << restored.err;
    const Finished run = run_tool(arguments("whole"));
    EXPECT_THAT(run.code, testing::AnyOf(0, 1, 3)) << run.err;
    if (run.err.find("NOT RESTORED") != std::string::npos) {
      EXPECT_EQ(run.code, 3);
      const Finished again = run_tool({"restore", folder_ / "whole/journal.ndjson"});
      said += again.out;
    }
  }
  plug_in();
  for (const auto& [name, reply] : memory())
    if (before_.at(name) != reply) {
      EXPECT_THAT(said, HasSubstr("NOT RESTORED")) << name;
    }
}

/// A device that keeps what was written: said once, with the word and what it held.
TEST_F(Restore, WhatCannotBePutBackIsSaidOnce) {
  const JoinedPtys line;
  Process behind({"/usr/bin/python3", FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/device.py",
                  "sticky", line.device()});
  std::vector<nlohmann::ordered_json> vectors = many_vectors(4);
  for (nlohmann::ordered_json& one : vectors) one["given"]["memory"] = {{"%MW100", "1111"}};
  const Finished run =
      run_tool({"run", "--endpoint", "serial:" + line.bench(), "--profile", "xbc-h", "--vectors",
                write_vectors(folder_, vectors), "--allow-write", "M100", "--floor", "1ms", "--out",
                folder_ / "out"});
  EXPECT_EQ(run.code, 3) << run.out << run.err;
  const std::string due = "NOT RESTORED: %MW100 = 0000; type: fieldproof restore ";
  const std::size_t first = run.err.find(due);
  ASSERT_NE(first, std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("NOT RESTORED", first + 1), std::string::npos) << run.err;
  const std::string junit = read_text(folder_ / "out/junit.xml");
  const std::size_t in_junit = junit.find("NOT RESTORED");
  ASSERT_NE(in_junit, std::string::npos);
  EXPECT_LT(junit.size(), 30'000u);
}

/// Each repetition writes and puts back 45 words: closed entries leave the journal.
TEST_F(Restore, TheJournalOfManyRepetitionsStaysSmall) {
  std::vector<nlohmann::ordered_json> vectors = many_vectors(1);
  nlohmann::ordered_json memory;
  for (int word = 110; word < 200; word += 2) memory[fmt::format("%MW{}", word)] = "1234";
  vectors[0]["given"]["memory"] = memory;
  vectors[0]["steps"][1]["expect"] = "[ACK st 'rSS' '01' '02' x:4 ETX BCC]";
  const Finished run = run_tool({"run", "--endpoint", endpoint(), "--profile", "xbc-h", "--vectors",
                                 write_vectors(folder_, vectors), "--allow-write", "M110-M199",
                                 "--floor", "1ms", "--repeat", "25", "--out", folder_ / "out"});
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  const std::vector<std::string> lines = text_lines(read_text(journal()));
  EXPECT_GT(lines.size(), 0u);
  EXPECT_LT(lines.size(), 2u * 45 * 25 - 1000) << "of all that were written";
  expect_as_before();
}

TEST_F(Restore, WhatIsNoJournalIsSaid) {
  const Finished finished = run_tool({"restore", folder_.write("letter.txt", "hello")});
  EXPECT_EQ(finished.code, 2) << finished.out;
  EXPECT_THAT(finished.err, HasSubstr("letter.txt is no journal"));
}

/// Cut off in the middle of a case, with a line that the disk has not got whole.
TEST_F(Restore, ARunDoesNotWriteOverWhatIsOpen) {
  const std::string entry =
      R"({"saved":{"address":"%MW100","config":{},"endpoint":")" + endpoint() +
      R"(","model":"xbc-h","number":1,"protocol":"xgt-cnet","station":1,"value":"1234"}})";
  folder_.write("out/journal.ndjson", entry + "\n" + entry.substr(0, 40));
  const std::vector<std::string> writes = {"--allow-write", "M100", "--filter", "xgt_cnet/wss/*"};
  const Finished refused = run_tool(run_arguments(writes));
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("type: fieldproof restore " + journal()));
  EXPECT_NE(run_tool(run_arguments({"--filter", "xgt_cnet/rss/*"})).code, 2)
      << "who writes nothing may read";
  const Finished restored = run_tool({"restore", journal()});
  EXPECT_EQ(restored.code, 0) << restored.err;
  EXPECT_THAT(restored.out, HasSubstr("restored      %MW100 = 1234 on " + endpoint()));
  EXPECT_THAT(memory().at("05%MW60"), testing::Ne(before_.at("05%MW60")))
      << "it wrote what the journal says";

  folder_.write("out/journal.ndjson", entry + "\n");
  std::vector<std::string> discards = writes;
  discards.push_back("--discard-journal");
  EXPECT_NE(run_tool(run_arguments(discards)).code, 2);
}

TEST_F(Restore, OfAWordThatIsWrittenTwiceTheLastOneIsDue) {
  expect_nothing_to_doubt(
      R"({"send": "[ENQ st 'WSS' '02' name(%MW119) '1111' name(%MW119) '2222' EOT]"},
                             {"expect": "[ACK st 'WSS' ETX]"})");
}

TEST_F(Restore, WhatIsRefusedTwiceInOneIsNothingToDoubt) {
  expect_nothing_to_doubt(
      R"({"send": "[ENQ st 'WSS' '11' name(%MW119) '1111' EOT] [ENQ st 'WSS' '11' name(%MW119) '1111' EOT]"},
                             {"expect": "[NAK st 'WSS' '0003' ETX] [NAK st 'WSS' '0003' ETX]"})");
}

TEST_F(Restore, WhatDoesNotAnswerStaysOpen) {
  const std::string entry =
      R"({"saved":{"address":"%MW100","config":{},"endpoint":"serial:/no/such/port","model":"xbc-h","number":1,)"
      R"("protocol":"xgt-cnet","station":1,"value":"1234"}})";
  folder_.write("out/journal.ndjson", entry + "\n");
  const Finished gone = run_tool({"restore", journal()});
  EXPECT_EQ(gone.code, 3);
  EXPECT_THAT(gone.out, HasSubstr("NOT RESTORED  %MW100 = 1234"));
  EXPECT_EQ(run_tool({"restore", journal(), "--endpoint", endpoint()}).code, 0)
      << "the device hangs on another port now";
  EXPECT_EQ(run_tool({"restore", folder_ / "none.ndjson"}).code, 2);
}

}  // namespace
}  // namespace fieldproof::tool_tests
