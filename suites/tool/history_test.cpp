// `history`, `run --history`, `run --baseline last` and `compare last` of the built tool.
#include <gmock/gmock.h>

#include <list>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr const char* refused_words = "xgt_cnet/rss/refused/*";

class HistoryCommand : public testing::Test {
 protected:
  Finished history(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "history");
    arguments.insert(arguments.end(), {"--history", file_});
    return run_tool(arguments);
  }

  /// A bench with one device, a server with a fault, as that firmware.
  std::string bench(const std::string& firmware, const std::string& fault) {
    const ordered_json device{
        {"endpoint", "exec:" BROKEN_SERVER " " + fault + " {tty}"},
        {"profile", "xbc-h"},
        {"identity", {{"maker", "LS"}, {"model", "XBC"}, {"serial", "7"}, {"firmware", firmware}}}};
    return folder_.write("bench.json", ordered_json{{"devices", {{"plc", device}}}}.dump());
  }
  Finished run_firmware(const std::string& firmware, const std::string& fault,
                        std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"run",         "--bench", bench(firmware, fault),
                                       "--dut",       "plc",     "--filter",
                                       refused_words, "--out",   folder_ / ("out_" + firmware)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }
  std::string results_of(const std::string& firmware) {
    return folder_ / ("out_" + firmware + "/results.ndjson");
  }
  json list() { return json::parse(history({"list", "--json"}).out); }

  TestFolder folder_;
  const std::string file_ = folder_ / "history.sqlite";
};

TEST_F(HistoryCommand, TheLastRunOfADeviceIsTheBaselineOfItsNextFirmware) {
  const std::vector<std::string> gate{"--history", file_, "--baseline", "last"};
  const Finished first = run_firmware("V1", "none", gate);
  EXPECT_EQ(first.code, 0) << first.out << first.err;
  EXPECT_THAT(first.out, AllOf(HasSubstr("no baseline: history " + file_ +
                                         " has no earlier run of LS XBC, serial number 7"),
                               HasSubstr("history  " + file_ + ", run 1\n")));
  const Finished second = run_firmware("V2", "0011_for_1132", gate);
  EXPECT_EQ(second.code, 1);
  EXPECT_THAT(second.out, AllOf(HasSubstr("worse than " + file_ + ", run 1: 2 newly failing"),
                                HasSubstr("xgt_cnet/rss/refused/lower  PASS -> FAIL\n"
                                          "      error code: expected 1132"),
                                HasSubstr("history  " + file_ + ", run 2\n")));
  const Finished third = run_firmware("V3", "none", gate);
  EXPECT_EQ(third.code, 0) << third.out << third.err;
  EXPECT_THAT(third.out, HasSubstr("newly passing"));

  const json runs = list();
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[1]["device"], "LS XBC, serial number 7");
  EXPECT_EQ(runs[1]["firmware"], "V2");
  EXPECT_EQ(runs[1]["red"], 2);
  EXPECT_EQ(runs[1]["exit_code"], 1) << "as results.ndjson has it";
  EXPECT_THAT(history({"list"}).out, HasSubstr("LS XBC, serial number 7  V2        "));
  EXPECT_THAT(history({"show", "2"}).out,
              AllOf(HasSubstr("run 2: LS XBC, serial number 7\n"),
                    HasSubstr("FAIL     xgt_cnet/rss/refused/upper  error code: expected 1132")));

  const Finished trend = history({"trend", "--html", folder_ / "trend.html"});
  EXPECT_THAT(trend.out, AllOf(HasSubstr("2 newly failing  between run 1 (V1, "),
                               HasSubstr("2 newly passing  between run 2 (V2, ")));
  const Finished matrix =
      history({"matrix", "--by", "firmware", "--html", folder_ / "matrix.html"});
  EXPECT_THAT(matrix.out, HasSubstr("  case                        A     B     C\n"
                                    "  xgt_cnet/rss/refused/lower  PASS  FAIL  PASS\n"));
  for (const char* name : {"trend.html", "matrix.html"}) {
    pugi::xml_document html;
    EXPECT_TRUE(html.load_file((folder_ / name).c_str())) << name;
  }
}

TEST_F(HistoryCommand, ABaselineIsAsWideAsTheRun) {
  run_firmware("V1", "0011_for_1132", {"--history", file_});
  const Finished narrow = run_tool({"run", "--bench", bench("V2", "none"), "--dut", "plc",
                                    "--filter", "xgt_cnet/rss/refused/lower", "--out",
                                    folder_ / "out", "--history", file_, "--baseline", "last"});
  EXPECT_EQ(narrow.code, 0) << narrow.err;
  EXPECT_THAT(narrow.out, AllOf(HasSubstr("newly passing: red before, and holds now (1)"),
                                Not(HasSubstr("removed"))));
}

/// A shard is a part of a run: kept, and nobody's baseline. What `merge` makes of all is one.
TEST_F(HistoryCommand, AShardIsNoBaseline) {
  std::vector<std::string> parts;
  for (const char* index : {"0", "1"}) {
    const std::string out = folder_ / (std::string("shard") + index);
    EXPECT_EQ(run_tool({"run", "--bench", bench("V1", "none"), "--dut", "plc", "--filter",
                        refused_words, "--history", file_, "--out", out},
                       {.environment = {{"GTEST_TOTAL_SHARDS", "2"}, {"GTEST_SHARD_INDEX", index}},
                        .folder = ""})
                  .code,
              0);
    parts.push_back(out + "/results.ndjson");
  }
  EXPECT_EQ(list().size(), 2u);
  EXPECT_THAT(run_firmware("V2", "none", {"--history", file_, "--baseline", "last"}).out,
              HasSubstr("no baseline"));
  ASSERT_EQ(run_tool({"merge", parts[0], parts[1], "--out", folder_ / "merged"}).code, 0);
  const Finished added = history({"add", folder_ / "merged/results.ndjson"});
  EXPECT_THAT(added.out, HasSubstr("run 4, LS XBC, serial number 7: 2 PASS"));
  const json runs = list();
  EXPECT_EQ(std::ranges::count(runs, json(true), [](const json& run) { return run["complete"]; }),
            2)
      << "the run of V2, and what was merged";
}

TEST_F(HistoryCommand, ARunStandsOnceWhicheverOfItsFilesIsAdded) {
  ASSERT_EQ(run_firmware("V1", "none", {"--history", file_}).code, 0);
  const Finished added = history({"add", results_of("V1"), folder_ / "out_V1/results.json"});
  EXPECT_EQ(added.code, 0) << added.err;
  EXPECT_THAT(added.out, AllOf(HasSubstr("results.ndjson: run 1, which was there already, LS XBC"),
                               HasSubstr("results.json: run 1, which was there already, LS XBC")));
  EXPECT_EQ(list().size(), 1u);
  EXPECT_THAT(
      history({"add", folder_ / "out_V1/junit.xml"}).err,
      HasSubstr("it does not say which revisions of the vectors it is of; give results.ndjson"));
}

TEST_F(HistoryCommand, CompareTakesTheLastRunBefore) {
  run_firmware("V1", "none", {"--history", file_});
  run_firmware("V2", "0011_for_1132", {"--history", file_});
  const Finished compared = run_tool({"compare", "last", results_of("V2"), "--history", file_});
  EXPECT_EQ(compared.code, 1) << compared.err;
  EXPECT_THAT(compared.out,
              AllOf(HasSubstr("A  " + file_ + ", run 1\n"), HasSubstr("A to B: 2 newly failing")));
  const Finished first = run_tool({"compare", "last", results_of("V1"), "--history", file_});
  EXPECT_EQ(first.code, 2);
  EXPECT_THAT(first.err, HasSubstr("has no earlier run of LS XBC, serial number 7"));
}

/// A history is made by whoever asks for it, and in the user's own place where no other is named.
TEST_F(HistoryCommand, NothingIsAddedUnasked) {
  const ProcessOptions user{.environment = {{"XDG_DATA_HOME", folder_ / "data"}}, .folder = ""};
  const std::string own = folder_ / "data/fieldproof/history.sqlite";
  const std::vector<std::string> run{"run", "--filter", refused_words, "--out", folder_ / "out"};
  ASSERT_EQ(run_tool(run, user).code, 0);
  EXPECT_FALSE(std::filesystem::exists(own));
  const Finished none = run_tool({"history", "list"}, user);
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("cannot read history " + own +
                                  ": there is none; `fieldproof "
                                  "history add RESULT` makes it"));
  std::vector<std::string> with_baseline = run;
  with_baseline.insert(with_baseline.end(), {"--baseline", "last"});
  EXPECT_EQ(run_tool(with_baseline, user).code, 2) << "before anything is sent";

  EXPECT_EQ(run_tool({"history", "add", folder_ / "out/results.ndjson"}, user).code, 0);
  EXPECT_EQ(run_tool(with_baseline, user).code, 0);
  EXPECT_EQ(json::parse(run_tool({"history", "list", "--json"}, user).out).size(), 1u)
      << "--baseline reads alone";
}

TEST_F(HistoryCommand, ProgramsThatAddAtOnceAreAllKept) {
  ASSERT_EQ(run_firmware("V1", "none").code, 0);
  std::list<Process> writers;
  for (int i = 0; i < 4; ++i) {
    std::vector<std::string> arguments{"history", "add", "--history", file_};
    for (int n = 0; n < 5; ++n) {
      std::string text = read_text(results_of("V1"));
      const std::string serial = R"("serial":"7")";
      text.replace(text.find(serial), serial.size(), fmt::format(R"("serial":"{}.{}")", i, n));
      arguments.push_back(folder_.write(fmt::format("w{}_{}.ndjson", i, n), text));
    }
    writers.emplace_back(tool_arguments(arguments));
  }
  for (Process& one : writers) {
    const Finished finished = one.wait();
    EXPECT_EQ(finished.code, 0) << finished.err;
  }
  EXPECT_EQ(list().size(), 20u);
}

TEST_F(HistoryCommand, WhatIsNoHistoryIsLeftAlone) {
  ASSERT_EQ(run_firmware("V1", "none").code, 0);
  folder_.write("history.sqlite", "these are my notes");
  for (const std::vector<std::string>& command : {std::vector<std::string>{"add", results_of("V1")},
                                                  {"list"},
                                                  {"show"},
                                                  {"matrix"},
                                                  {"trend"}}) {
    const Finished finished = history(command);
    EXPECT_EQ(finished.code, 2) << command[0];
    EXPECT_THAT(finished.err, HasSubstr("it is no SQLite file; name another with --history"));
  }
  const Finished run = run_firmware("V2", "none", {"--history", file_});
  EXPECT_EQ(run.code, 2);
  EXPECT_FALSE(std::filesystem::exists(results_of("V2"))) << "before anything is sent";
  EXPECT_EQ(read_text(file_), "these are my notes");
}

/// A file that may not grow stands for a full disk. The run is done and its reports say so.
TEST_F(HistoryCommand, AFullDiskIsBenchTrouble) {
  ASSERT_EQ(run_firmware("V1", "none", {"--history", file_}).code, 0);
  const std::string before = read_text(file_);
  const std::string command =
      fmt::format("trap '' XFSZ; ulimit -f {}; exec {} history add --history {} {}",
                  before.size() / 1024, FIELDPROOF_TOOL, file_, results_of("V2"));
  ASSERT_EQ(run_tool({"run", "--filter", "xgt_cnet/rs*", "--out", folder_ / "out_V2"}).code, 0);
  const Finished full = run_program({"bash", "-c", command});
  EXPECT_EQ(full.code, 3) << full.out;
  EXPECT_THAT(full.err, HasSubstr("cannot write history " + file_));
  EXPECT_EQ(list().size(), 1u);
}

/// The emulator with a delay, real reply times of real runs; their dates are ours.
TEST_F(HistoryCommand, TrendNamesTheVersionThatBecameSlower) {
  std::vector<std::string> add{"add"};
  int day = 1;
  for (const auto& [firmware, delay] : {std::pair("V1.40", 0), {"V1.41", 10}}) {
    ordered_json vector = small_vector("t/read");
    vector["given"]["config"] = {{"rs485", true}, {"delay_ms", delay}};
    const TestFolder vectors;
    const ordered_json device{{"endpoint", "emulator:xbc-h"},
                              {"profile", "xbc-h"},
                              {"identity", {{"serial", "7"}, {"firmware", firmware}}}};
    const std::string bench =
        folder_.write("bench.json", ordered_json{{"devices", {{"plc", device}}}}.dump());
    const std::string out = folder_ / firmware;
    ASSERT_EQ(run_tool({"run", "--bench", bench, "--dut", "plc", "--vectors",
                        write_vectors(vectors, {vector}), "--out", out})
                  .code,
              0);
    const std::string text = read_text(out + "/results.ndjson");
    const std::string key = R"("started":")";
    const std::size_t at = text.find(key) + key.size();
    for (int i = 0; i < 6; ++i, ++day)
      add.push_back(folder_.write(
          fmt::format("run{}.ndjson", day),
          std::string(text).replace(at, text.find('"', at) - at,
                                    fmt::format("2026-01-{:02}T12:00:00+00:00", day))));
  }
  ASSERT_EQ(history(add).code, 0);
  const Finished trend = history({"trend"});
  EXPECT_EQ(trend.code, 0) << trend.err;
  EXPECT_THAT(trend.out,
              AllOf(StartsWith("serial number 7\n12 runs, 2026-01-01 to 2026-01-12, firmware "
                               "V1.40, V1.41\n"),
                    HasSubstr("changes between run 6 (V1.40, 2026-01-06) and run 7 (V1.41, "
                              "2026-01-07); new there: firmware V1.40 to V1.41"),
                    HasSubstr("reply times  slower  0.000 to 10.000 ms (+10.000 ms)  p 0.011")));
  EXPECT_THAT(history({"trend", "--device", "XEC"}).err,
              HasSubstr("'XEC' is no device of this history; it has:\n  serial number 7"));
}

TEST_F(HistoryCommand, SaysWhichRunsAndCommandsThereAre) {
  run_firmware("V1", "none", {"--history", file_});
  EXPECT_THAT(history({"show", "9"}).err, HasSubstr("the history has no run '9'"));
  EXPECT_THAT(history({"matrix", "--filter", "modbus_rtu/*"}).err, HasSubstr("no such case"));
  const Finished wrong = run_tool({"history", "lst"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'list'?"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
