// What a run writes on a device is put back: after each case, and by `fieldproof restore` after a
// run that was killed. The device is the emulator in a process of its own behind two ptys, so it
// survives the run.
#include <gmock/gmock.h>

#include "suites/tool/at_moment.hpp"
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
      run_tool(run_arguments({"--allow-write", "all,P,Q,U", "--filter",
                              "xgt_cnet/areas/*:xgt_cnet/w*:xgt_cnet/data_types/*"}));
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
