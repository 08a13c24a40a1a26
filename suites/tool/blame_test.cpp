// Devices that are right in what a case is about, or odd in something else
// (testdata/odd_device.py): nothing is blamed that the manuals do not forbid, and what is wrong is
// named where it is.
#include <gmock/gmock.h>

#include <memory>
#include <regex>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

std::string odd_device(const std::string& oddity, const std::string& protocol,
                       const std::string& bytes = "") {
  const bool network = protocol == "modbus-tcp";
  return "exec:/usr/bin/python3 -B " FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/odd_device.py " +
         oddity + " " + protocol + (network ? " {port}" : " {tty} " + bytes);
}

class Blame : public testing::Test {
 protected:
  std::vector<std::string> arguments(const std::string& oddity, const std::string& protocol,
                                     const std::string& filter, const std::string& bytes = "") {
    return {"run",          "--endpoint", odd_device(oddity, protocol, bytes),
            "--profile",    "xbc-h",      "--protocol",
            protocol,       "--role",     "server",
            "--filter",     filter,       "--out",
            folder_ / "out"};
  }
  Finished run(std::vector<std::string> arguments, std::vector<std::string> more = {}) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    Finished finished = run_tool(arguments);
    results_ = read_results(folder_ / "out/results.ndjson");
    return finished;
  }
  std::vector<json> of_verdict(const std::string& verdict) const {
    std::vector<json> found;
    for (const json& one : results_.cases)
      if (one.at("verdict") == verdict) found.push_back(one);
    return found;
  }

  TestFolder folder_;
  Results results_;
};

// ---- separate tables

/// Most Modbus devices of the world: coils and registers have no memory in common, and the
/// addresses do not end at 9999, which no manual forbids.
TEST_F(Blame, SeparateTablesAreTestedInFullButForTheOverlap) {
  const std::string profile = folder_.write("separate.json", R"({
      "name": "separate", "extends": "xbc-h", "decisions": "advisory",
      "protocols": ["modbus-rtu", "modbus-ascii", "modbus-tcp"], "config": {"tables": "separate"}})");
  std::map<std::string, std::unique_ptr<Process>> runs;
  for (const std::string way : {"rtu", "ascii", "tcp"}) {
    const std::string folder = "modbus_" + way;
    runs[way] = std::make_unique<Process>(tool_arguments(
        {"run", "--endpoint", odd_device("separate", "modbus-" + way), "--profile", profile,
         "--protocol", "modbus-" + way, "--role", "server", "--out", folder_ / way, "--filter",
         folder + "/examples/*:" + folder + "/writes/*:" + folder + "/exceptions/address_*"}));
  }
  for (const auto& [way, process] : runs) {
    const Finished finished = process->wait();
    results_ = read_results(folder_ / (way + "/results.ndjson"));
    EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
    EXPECT_GE(results_.counts()["PASS"], 10u) << way;
    EXPECT_GE(results_.counts()["NON-STRICT"], 2u) << way << ": past data address 9998";
    for (const json& one : of_verdict("NON-STRICT"))
      EXPECT_EQ(one.at("basis"), "decision") << one.at("id");
    EXPECT_TRUE(std::ranges::any_of(of_verdict("BLOCKED"), [](const json& one) {
      const std::string why = one.at("message");
      return why.find("the profile declares separate tables") != why.npos;
    })) << way;
  }
}

// ---- set-up

TEST_F(Blame, RefusedWritesOfASetUpAreOneFinding) {
  for (const auto& [protocol, filter, answer] :
       {std::tuple("xgt-cnet",
                   "xgt_cnet/rss/two_words/*:xgt_cnet/rss/bit_is_00_or_01/*:"
                   "xgt_cnet/rss/block_counts/*",
                   "NAK 0190"),
        std::tuple("modbus-ascii", "modbus_ascii/data/bits_01/*", "exception 04")}) {
    const Finished finished = run(arguments("no_writes", protocol, filter));
    EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
    const std::vector<json> failed = of_verdict("FAIL"), blocked = of_verdict("BLOCKED");
    ASSERT_EQ(failed.size(), 1u) << finished.out;
    EXPECT_THAT(failed.front().at("id"), "set_up/" + std::string(protocol) + "/1");
    EXPECT_THAT(failed.front().at("message").get<std::string>(),
                AllOf(HasSubstr("cannot set %MW"), HasSubstr(answer),
                      HasSubstr(std::to_string(blocked.size()) + " cases are BLOCKED by it")));
    EXPECT_THAT(failed.front().at("exchange").dump(), HasSubstr("sent ")) << "its bytes";
    EXPECT_GE(blocked.size(), 5u);
    for (const json& one : blocked)
      EXPECT_THAT(one.at("message").get<std::string>(), HasSubstr("set-up: cannot set "));
    expect_reports(folder_ / "out");
  }
}

/// What sets nothing is judged, and the run does not wait for each write again.
TEST_F(Blame, UnansweredWritesOfASetUpAreOneFinding) {
  const Finished finished =
      run(arguments("mute_writes", "modbus-ascii",
                    "modbus_ascii/data/bits_01/a0*:modbus_ascii/data/bits_01/a3*:"
                    "modbus_ascii/examples/read_*_refused"));
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  ASSERT_EQ(of_verdict("FAIL").size(), 1u);
  const std::vector<json> blocked = of_verdict("BLOCKED");
  EXPECT_THAT(of_verdict("FAIL").front().at("message").get<std::string>(),
              AllOf(HasSubstr("cannot set %MW0: no answer; " + std::to_string(blocked.size())),
                    Not(HasSubstr("not tried"))));
  EXPECT_THAT(blocked.back().at("message").get<std::string>(),
              HasSubstr("no answer; not tried, as the last writes that set up a case were not"));
  EXPECT_GE(results_.counts()["PASS"], 4u);
}

// ---- what came instead

TEST_F(Blame, ARequestThatIsItsOwnReplyIsNoEcho) {
  const Finished finished =
      run(arguments("repeats", "modbus-ascii", "modbus_ascii/exceptions/address_write_one/*"));
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  for (const json& one : of_verdict("FAIL"))
    EXPECT_THAT(one.at("message").get<std::string>(),
                AllOf(ContainsRegex("got 0[56] [A-Za-z ]+, reply \\(the request came back, which "
                                    "is its normal reply\\)"),
                      Not(HasSubstr("echo")), Not(HasSubstr("wiring"))));
  EXPECT_GE(of_verdict("FAIL").size(), 5u);
}

TEST_F(Blame, AnAnswerThatComesAgainIsNamedAsThat) {
  const Finished finished = run(arguments("stale", "xgt-cnet", "xgt_cnet/rss/two_words/*"));
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  const std::vector<json> failed = of_verdict("FAIL");
  EXPECT_EQ(failed.size(), 2u);
  for (const json& one : failed)
    EXPECT_THAT(one.at("message").get<std::string>(),
                ContainsRegex("expected [rR], got w \\(an answer to what was asked before, ENQ "
                              "'01wSB.*: it came twice, or late\\)"));
}

// ---- a device that dies

TEST_F(Blame, ADeviceThatDiesIsStartedAgainAndTheFrameIsNamed) {
  const std::string four_blocks = "7253533034";  // rSS04
  const std::string filter = "xgt_cnet/rss/block_counts/*";
  Finished finished = run(arguments("dies", "xgt-cnet", filter, four_blocks));
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  ASSERT_EQ(of_verdict("FAIL").size(), 1u);
  EXPECT_THAT(of_verdict("FAIL").front().at("message").get<std::string>(),
              AllOf(HasSubstr("the device ended after ENQ '01rSS04"),
                    HasSubstr("exit status 3; it said: the device has burnt out")));
  EXPECT_GE(results_.counts()["PASS"], 5u) << "the others are judged";
  EXPECT_THAT(finished.out + finished.err, Not(HasSubstr("NOT RESTORED")));

  finished = run(arguments("dies", "xgt-cnet", filter, four_blocks), {"--max-restarts", "0"});
  EXPECT_EQ(finished.code, 3) << finished.out << finished.err;
  EXPECT_THAT(finished.out + finished.err, Not(HasSubstr("NOT RESTORED")))
      << "what it held is gone with it";
}

// ---- names of bits

/// Decimal word and hex digit are a decision; printed are such names of U, and those of an XEC.
/// Bits 0 to 9 of word 0 are what they are by any reading.
TEST(BitNames, BindAsPrintedWhereAnyReadingIsTheSame) {
  const json all = json::parse(run_tool({"list", "--json", "xgt_cnet/*", "--role", "server"}).out);
  std::size_t decided = 0;
  for (const json& one : all) {
    const std::string basis = one.at("basis"), steps = one.at("steps").dump();
    const bool of_another_model = one.at("models") == json{"xec-h"};
    static const std::regex name("name\\(%([A-TV-Z])X([0-9A-F.]+)\\)");
    for (std::sregex_iterator bit(steps.begin(), steps.end(), name), end; bit != end; ++bit) {
      decided += basis == "decision";
      // Cnet EN Appendix 3.1 prints the refusal of one.
      if (!basis.starts_with("printed") || of_another_model ||
          one.at("id") == "xgt_cnet/errors/printed_0011_bit")
        continue;
      const std::string area = (*bit)[1], digits = (*bit)[2];
      EXPECT_TRUE(area == "T" || area == "C" ||
                  digits.find_first_not_of('0') == std::string::npos ||
                  digits.find_first_not_of('0') == digits.size() - 1)
          << one.at("id") << ' ' << bit->str();
      EXPECT_TRUE(digits.back() <= '9') << one.at("id") << ' ' << bit->str();
    }
  }
  EXPECT_GT(decided, 100u);
  for (const char* id :
       {"xgt_cnet/rss/bit_is_00_or_01/lower/on_c", "xgt_cnet/wss/type_bit/xbc_h_set_lower",
        "xgt_cnet/wss/bits_of_one_word/lower"})
    EXPECT_TRUE(std::ranges::any_of(all, [&](const json& one) {
      return one.at("id") == id && one.at("basis") == "decision";
    })) << id;
}

}  // namespace
}  // namespace fieldproof::tool_tests
