// The built tool over a stock ser2net, and two users of one port.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <memory>

#include "harness/endpoints/rfc2217_test_servers.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using endpoints::test::Ser2net;
using endpoints::test::Ser2netOptions;
using testing::AllOf;
using testing::HasSubstr;

/// Two ptys that socat joins: ser2net has one, a device the other.
class RemotePort : public testing::Test {
 protected:
  RemotePort()
      : socat_({"socat", "-d", "-d", "pty,raw,echo=0,link=" + (folder_ / "bench"),
                "pty,raw,echo=0,link=" + (folder_ / "device")}) {
    EXPECT_TRUE(socat_.wait_for("starting data transfer loop"));
    server_ = std::make_unique<Ser2net>(folder_ / "bench");
  }

  std::string endpoint() const { return "rfc2217:" + server_->where() + "?baud=115200"; }
  static std::vector<std::string> arguments(const std::string& endpoint, const std::string& out) {
    return {"run",           "--endpoint", endpoint, "--profile", "xbc-h",
            "--allow-write", "all,P,Q,U",  "--out",  out};
  }
  void serve_as_labgrid() {
    server_.reset();
    server_ = std::make_unique<Ser2net>(folder_ / "bench", Ser2netOptions::of_labgrid());
  }
  Results run(const std::string& endpoint, const std::string& filter) {
    std::vector<std::string> all = arguments(endpoint, folder_ / "out");
    all.insert(all.end(), {"--filter", filter});
    const Finished finished = run_tool(all);
    EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
    expect_reports(folder_ / "out");
    return read_results(folder_ / "out/results.ndjson");
  }

  /// testdata/device.py answers `until` requests, then tells and is silent: the bench is in the
  /// middle of something.
  std::unique_ptr<Process> device_that_tells(int until) {
    const std::string path = folder_ / "told";
    EXPECT_EQ(::mkfifo(path.c_str(), 0600), 0);
    told_.reset(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    return std::make_unique<Process>(std::vector<std::string>{
        "/usr/bin/python3", FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/device.py", "tell",
        folder_ / "device", path, std::to_string(until)});
  }
  bool told() const {
    pollfd one{told_.get(), POLLIN, 0};
    return ::poll(&one, 1, 60'000) == 1;
  }

  TestFolder folder_;
  os::UniqueFd told_;
  Process socat_;
  std::unique_ptr<Ser2net> server_;
};

TEST_F(RemotePort, gives_the_verdicts_of_the_emulator) {
  Process device({FIELDPROOF_TOOL, "emulate", "xbc-h", "--pty", folder_ / "device"});
  ASSERT_TRUE(device.wait_for(folder_ / "device"));
  const std::string filter = "xgt_cnet/rss/*";
  const Results in_process = run("emulator:xbc-h", filter), remote = run(endpoint(), filter);
  ASSERT_EQ(remote.cases.size(), in_process.cases.size());
  int judged = 0;
  for (const nlohmann::json& one : remote.cases) {
    const std::string id = one.at("id"), verdict = one.at("verdict");
    // What needs a back door, a declaration or a wire; endpoints_test.cpp holds the list of these.
    if (verdict == "BLOCKED" || verdict == "INCONCLUSIVE") continue;
    EXPECT_EQ(verdict, in_process.verdict(id)) << id << ": " << one.value("message", "");
    judged += verdict == "PASS" || verdict == "INFO";
  }
  EXPECT_GT(judged, 60);
  EXPECT_THAT(remote.run.dump(), HasSubstr("rfc2217:" + server_->where() + " 115200-8N1"));
}

TEST_F(RemotePort, a_server_killed_in_the_middle_is_trouble_with_reports) {
  // The floor is measured twice where nothing paces the port.
  const std::unique_ptr<Process> device = device_that_tells(101);
  std::vector<std::string> all = arguments(endpoint(), folder_ / "out");
  all.insert(all.end(), {"--vectors", write_vectors(folder_, many_vectors(200))});
  Process tool(tool_arguments(all));
  ASSERT_TRUE(told());
  server_->kill();
  const Finished finished = tool.wait();
  EXPECT_EQ(finished.code, 3) << finished.out << finished.err;
  const Results results = read_results(folder_ / "out/results.ndjson");
  EXPECT_EQ(results.counts().at("ERROR"), 1u);
  EXPECT_GE(results.counts().at("PASS"), 1u);
  EXPECT_EQ(results.counts().at("PASS") + 1 + results.counts().at("BLOCKED"), 200u)
      << "the rest cannot be judged";
  EXPECT_THAT(finished.out, AllOf(HasSubstr(server_->where()),
                                  HasSubstr("see that the device or serial server still runs")));
  expect_reports(folder_ / "out");
}

TEST_F(RemotePort, a_server_that_is_not_there_is_trouble) {
  const std::string where = server_->where();
  server_.reset();
  const Finished finished = run_tool(arguments("rfc2217:" + where, folder_ / "out"));
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr(where),
                    HasSubstr("nothing listens there; start the device or serial server")));
}

/// labgrid's exporter lets ten clients in. Whichever of the two is there first, the other one meets
/// it in its claim.
TEST_F(RemotePort, two_runs_on_one_port_fail_nothing_and_say_why) {
  serve_as_labgrid();
  Process device({FIELDPROOF_TOOL, "emulate", "xbc-h", "--pty", folder_ / "device"});
  ASSERT_TRUE(device.wait_for(folder_ / "device"));
  const std::string vectors = write_vectors(folder_, many_vectors(600));
  const auto begin = [&](const std::string& out) {
    std::vector<std::string> all = arguments(endpoint(), folder_ / out);
    all.insert(all.end(), {"--vectors", vectors});
    return std::make_unique<Process>(tool_arguments(all));
  };
  const auto first = begin("first"), second = begin("second");
  const Finished ends[] = {first->wait(), second->wait()};
  int told = 0;
  for (int i = 0; i < 2; ++i) {
    const Results results =
        read_results(folder_ / (i == 0 ? "first/results.ndjson" : "second/results.ndjson"));
    EXPECT_EQ(results.counts().count("FAIL"), 0u) << ends[i].out << ends[i].err;
    EXPECT_EQ(results.counts().count("ERROR"), 0u) << ends[i].out << ends[i].err;
    const bool says = ends[i].err.find("somebody else speaks on rfc2217:") != std::string::npos;
    EXPECT_EQ(ends[i].code, says ? 3 : 0) << ends[i].out << ends[i].err;
    told += says;
  }
  EXPECT_GE(told, 1);
}

TEST_F(RemotePort, the_delay_of_ser2net_is_named_with_the_line_that_ends_it) {
  Process device({FIELDPROOF_TOOL, "emulate", "xbc-h", "--pty", folder_ / "device"});
  ASSERT_TRUE(device.wait_for(folder_ / "device"));
  const std::string filter = "xgt_cnet/rss/two_words/lower";
  const auto floor = [&] { return run(endpoint(), filter).run["properties"].at("floor").dump(); };
  EXPECT_THAT(floor(), testing::Not(HasSubstr("ser2net")));
  serve_as_labgrid();
  EXPECT_THAT(floor(), AllOf(HasSubstr("if ser2net is between"), HasSubstr("`chardelay: false`")));
}

/// Behind it is a pty, which takes a request at once: its answers are not of the speed that was
/// set.
TEST_F(RemotePort, a_port_that_nothing_paces_has_no_wire) {
  serve_as_labgrid();
  Process device({FIELDPROOF_TOOL, "emulate", "xbc-h", "--pty", folder_ / "device"});
  ASSERT_TRUE(device.wait_for(folder_ / "device"));
  const Results slow =
      run("rfc2217:" + server_->where() + "?baud=1200", "xgt_cnet/rss/two_words/lower");
  EXPECT_THAT(slow.run["properties"].at("floor").get<std::string>(),
              HasSubstr("no wire: answers came up to "));
  for (const nlohmann::json& one : slow.cases)
    for (const double ms : one.at("response_ms")) EXPECT_GT(ms, 0) << one.at("id");
}

/// The first one waits for an answer for longer than the others take to start, on a busy machine
/// too: the sanity exchange and the floor are 21 requests, and the next is not answered.
TEST_F(RemotePort, a_second_user_is_told_of_the_first) {
  server_.reset();
  const std::unique_ptr<Process> device = device_that_tells(21);
  nlohmann::ordered_json patient = small_vector("patient");
  patient["steps"][1]["within"] = "100s";
  const std::string vectors = write_vectors(folder_, {patient});
  const auto user = [&](const std::string& out) {
    std::vector<std::string> all = arguments("serial:" + (folder_ / "bench"), folder_ / out);
    all.insert(all.end(), {"--vectors", vectors});
    return tool_arguments(all);
  };
  Process first(user("first"));
  ASSERT_TRUE(told());
  const Finished second = run_program(user("second"));
  EXPECT_EQ(second.code, 3);
  EXPECT_THAT(second.err, AllOf(HasSubstr("cannot open " + (folder_ / "bench") +
                                          ": the port is in use by process "),
                                HasSubstr(" (fieldproof) since 20"),
                                HasSubstr("end that process or choose another port")));
  Process fourth([&] {
    std::vector<std::string> all = user("fourth");
    all.insert(all.end(), {"--wait-port", "10m"});
    return all;
  }());
  EXPECT_TRUE(fourth.wait_for("waiting: cannot open " + (folder_ / "bench")));
  fourth.signal(SIGINT);
  EXPECT_EQ(fourth.wait().code, 130) << "Ctrl-C ends the waiting";
  // Killed, it leaves its lock: the next user takes it over and says so.
  first.signal(SIGKILL);
  EXPECT_EQ(first.wait().code, 128 + SIGKILL);
  Process third(user("third"));
  EXPECT_TRUE(third.wait_for("took over the lock of " + (folder_ / "bench")));
  third.signal(SIGINT);
  EXPECT_EQ(third.wait().code, 130);
}

}  // namespace
}  // namespace fieldproof::tool_tests
