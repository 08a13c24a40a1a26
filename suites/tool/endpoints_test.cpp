// The same cases over every kind of link: a verdict may differ only where
// testdata/endpoint_differences.json says why.
#include <fnmatch.h>
#include <gtest/gtest.h>

#include <future>
#include <iostream>
#include <memory>

#include "suites/tool/plc_client.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using VerdictsById = std::map<std::string, std::string>;  // by id of the case

/// Real time is mostly waiting: shards run side by side, each with a device of its own.
const std::map<std::string, int> shards{{"pty", 4}, {"serial", 1}, {"exec", 2}};

/// One protocol stands for the links; the others' broken devices and peers are judged over exec: in
/// suites/.
constexpr const char* all_cases = "xgt_cnet/*";

struct KnownDifference {
  std::string pattern, verdict, reason;
  std::set<std::string> links;
};

std::vector<KnownDifference> allowed_differences() {
  std::vector<KnownDifference> result;
  for (const json& entry : json::parse(
           read_text(FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/endpoint_differences.json")))
    for (const json& pattern : entry.at("ids"))
      result.push_back({pattern, entry.at("verdict"), entry.at("reason"),
                        entry.at("links").get<std::set<std::string>>()});
  return result;
}

bool matches(const KnownDifference& one, const std::string& id) {
  return ::fnmatch(one.pattern.c_str(), id.c_str(), 0) == 0;
}

VerdictsById run(const std::string& endpoint, const std::string& filter,
                 const ProcessOptions& options) {
  const TestFolder folder;
  run_tool({"run", "--endpoint", endpoint, "--profile", "xbc-h", "--allow-write", "all,P,Q,U",
            "--filter", filter, "--out", folder / "out"},
           options);
  VerdictsById verdicts;
  for (const json& one : read_results(folder / "out/results.ndjson").cases)
    verdicts[one.at("id")] = one.at("verdict");
  return verdicts;
}

/// A way to an emulated xbc-h; each gives an endpoint of its own to a shard.
class Link {
 public:
  virtual ~Link() = default;
  virtual std::string endpoint() = 0;
};

class PtyLink : public Link {
 public:
  std::string endpoint() override { return "pty:xbc-h"; }
};

class ExecLink : public Link {
 public:
  std::string endpoint() override { return "exec:" FIELDPROOF_TOOL " emulate xbc-h --pty {tty}"; }
};

/// Two ptys that socat joins: the bench on one end, the emulator on the other, as used as a PLC on
/// a bench is.
class SerialLink : public Link {
 public:
  SerialLink()
      : socat_({"socat", "-d", "-d", "pty,raw,echo=0,link=" + (folder_ / "bench"),
                "pty,raw,echo=0,link=" + (folder_ / "device")}) {
    EXPECT_TRUE(socat_.wait_for("starting data transfer loop"));
    device_ = std::make_unique<Process>(
        std::vector<std::string>{FIELDPROOF_TOOL, "emulate", "xbc-h", "--pty", folder_ / "device"});
    EXPECT_TRUE(device_->wait_for(folder_ / "device"));
    // Whoever asks later cannot rely on zeros.
    PlcClient(folder_ / "bench").fill(plc::plc_models().front());
  }
  std::string endpoint() override { return "serial:" + (folder_ / "bench"); }

 private:
  TestFolder folder_;
  Process socat_;
  std::unique_ptr<Process> device_;
};

std::unique_ptr<Link> make_link(const std::string& kind) {
  if (kind == "pty") return std::make_unique<PtyLink>();
  if (kind == "exec") return std::make_unique<ExecLink>();
  return std::make_unique<SerialLink>();
}

/// All cases over one kind of link.
VerdictsById run_over(const std::string& kind) {
  std::vector<std::future<VerdictsById>> parts;
  const int total = shards.at(kind);
  for (int shard = 0; shard < total; ++shard)
    parts.push_back(std::async(std::launch::async, [kind, shard, total] {
      const std::unique_ptr<Link> link = make_link(kind);
      return run(link->endpoint(), all_cases,
                 {.environment = {{"GTEST_TOTAL_SHARDS", std::to_string(total)},
                                  {"GTEST_SHARD_INDEX", std::to_string(shard)}},
                  .folder = ""});
    }));
  VerdictsById verdicts;
  for (std::future<VerdictsById>& part : parts) verdicts.merge(part.get());
  return verdicts;
}

/// Runs these cases again, alone: what was only late on a busy machine is not late again; what the
/// link cannot do, it cannot do now.
void run_again(const std::string& kind, const std::vector<std::string>& ids,
               VerdictsById& verdicts) {
  if (ids.empty()) return;
  const std::string filter = filter_of(ids);
  std::cout << "again over " << kind << ": " << filter << std::endl;
  const std::unique_ptr<Link> link = make_link(kind);
  for (const auto& [id, verdict] : run(link->endpoint(), filter, {})) verdicts[id] = verdict;
}

class Links : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    emulator_ = run("emulator:xbc-h", all_cases, {});
    differences_ = allowed_differences();
    std::map<std::string, std::future<VerdictsById>> running;
    for (const char* kind : {"pty", "serial", "exec"})
      running[kind] = std::async(std::launch::async, run_over, std::string(kind));
    for (auto& [kind, future] : running) over_[kind] = future.get();
    for (auto& [kind, verdicts] : over_)
      for (int round = 0; round < 3; ++round) run_again(kind, surprises(kind), verdicts);
  }

  /// The verdict that is due over this link.
  static std::string due(const std::string& kind, const std::string& id) {
    const std::string& reference = emulator_.at(id);
    if (reference == "SKIP") return reference;  // outside the profile, whatever the link is
    for (const KnownDifference& one : differences_)
      if (one.links.contains(kind) && matches(one, id)) return one.verdict;
    return reference;
  }

  /// Within the limit still: a busy machine is late by milliseconds, which simulated time is not.
  static bool is_jitter(const std::string& verdict, const std::string& due) {
    return verdict == "MARGINAL" && due == "PASS";
  }

  static std::vector<std::string> surprises(const std::string& kind) {
    std::vector<std::string> ids;
    for (const auto& [id, verdict] : over_.at(kind))
      if (verdict != due(kind, id) && !is_jitter(verdict, due(kind, id))) ids.push_back(id);
    return ids;
  }

  static void expect_as_due(const std::string& kind) {
    EXPECT_EQ(over_.at(kind).size(), emulator_.size());
    for (const std::string& id : surprises(kind))
      ADD_FAILURE() << id << " is " << over_.at(kind).at(id) << " over " << kind << ", "
                    << due(kind, id) << " is due (" << emulator_.at(id) << " in process)";
  }

  static inline VerdictsById emulator_;
  static inline std::map<std::string, VerdictsById> over_;
  static inline std::vector<KnownDifference> differences_;
};

TEST_F(Links, pty_gives_the_verdicts_of_the_emulator) { expect_as_due("pty"); }
TEST_F(Links, serial_gives_the_verdicts_of_the_emulator) { expect_as_due("serial"); }
TEST_F(Links, exec_gives_the_verdicts_of_the_emulator) { expect_as_due("exec"); }

/// An entry that stands for nothing would hide a fault one day.
TEST_F(Links, each_allowed_difference_is_one) {
  for (const KnownDifference& one : differences_) {
    std::size_t matching = 0;
    for (const auto& [id, verdict] : emulator_) {
      if (verdict == "SKIP" || !matches(one, id)) continue;
      ++matching;
      EXPECT_NE(verdict, one.verdict)
          << one.pattern << " allows a difference where there is none: " << id << " is " << verdict
          << " in process too";
    }
    EXPECT_GT(matching, 0u) << one.pattern << " (" << one.reason << ") matches no case";
    EXPECT_FALSE(one.reason.empty()) << one.pattern;
    for (const std::string& link : one.links)
      EXPECT_TRUE(over_.contains(link)) << one.pattern << ": no link '" << link << "'";
  }
}

/// Two entries for one case would hide that one of them is wrong.
TEST_F(Links, no_case_has_two_reasons) {
  for (const auto& [id, verdict] : emulator_)
    for (const auto& [kind, verdicts] : over_) {
      std::set<std::string> reasons;
      for (const KnownDifference& one : differences_)
        if (verdict != "SKIP" && one.links.contains(kind) && matches(one, id))
          reasons.insert(one.reason);
      EXPECT_LE(reasons.size(), 1u) << id << " over " << kind << ": " << json(reasons).dump();
    }
}

/// On a real device most of the cases run: the list must not empty the suite.
TEST_F(Links, most_cases_are_judged_over_each_link) {
  for (const auto& [kind, verdicts] : over_) {
    const auto judged = std::ranges::count_if(
        verdicts, [](const auto& one) { return one.second == "PASS" || one.second == "INFO"; });
    EXPECT_GT(judged, 1700) << kind;
  }
}

/// In real time each protocol has an endpoint of its own.
TEST(EveryProtocol, speaks_over_a_pty) {
  const TestFolder folder;
  const Finished finished =
      run_tool({"run", "--endpoint", "pty:", "--filter",
                "*/examples/*:ls_bus/read/*:user_frames/px7_controller/*:xgt_cnet/rss/*", "--out",
                folder / "out"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  std::set<std::string> judged;
  for (const json& one : read_results(folder / "out/results.ndjson").cases)
    if (one.at("verdict") == "PASS") judged.insert(one.at("protocol"));
  EXPECT_EQ(judged.size(), 5u) << json(judged).dump();
}

/// `run` without a filter runs every suite, each case on a device that speaks its protocol.
TEST(EveryProtocol, is_run_by_default) {
  const Finished& finished = default_run().finished;
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  std::map<std::string, int> passed;
  for (const json& one : default_run().results.cases) {
    EXPECT_NE(one.at("verdict"), "SKIP") << one.at("id");
    if (one.at("verdict") == "PASS") ++passed[one.at("protocol")];
  }
  for (const char* protocol :
       {"xgt-cnet", "modbus-rtu", "modbus-ascii", "modbus-tcp", "ls-bus", "user-frames"})
    EXPECT_GT(passed[protocol], 100) << protocol;
}

}  // namespace
}  // namespace fieldproof::tool_tests
