// The timing suite: figures on simulated time are exact to a character, limits come from the
// profile with their units, and repetitions are one row of figures in every report.
#include <gmock/gmock.h>

#include <cmath>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;

class Timing : public testing::Test {
 protected:
  Finished run(std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "--out", out_});
    return run_tool(more);
  }
  Results results() { return read_results(out_ + "/results.ndjson"); }

  TestFolder folder_;
  std::string out_ = folder_ / "out";
};

constexpr double character = 10 / 9.6;  // ms at 9600-8N1

/// A reply is delayed by the parameter, from the moment at which the device knows that the request
/// is over: at its tail, or in RTU after 3.5 characters of 11 bits.
TEST_F(Timing, DelaysAreExactToACharacter) {
  EXPECT_EQ(run({"--filter", "*/timing/delay/*"}).code, 0);
  const Results all = results();
  EXPECT_EQ(all.cases.size(), 27u);
  for (const nlohmann::json& one : all.cases) {
    const std::string id = one["id"];
    const double delay = std::stod(id.substr(id.rfind('d') + 1));
    const double due = delay + (id.starts_with("modbus_rtu") ? 3.5 * 11 / 9.6 : 0);
    EXPECT_LE(std::abs(one["response_ms"][0].get<double>() - due), character + 1e-6) << id;
  }
}

TEST_F(Timing, RepetitionsAreOneRowOfFigures) {
  const Finished finished =
      run({"--filter", "xgt_cnet/timing/delay/d10:xgt_cnet/timing/back_to_back", "--repeat", "50"});
  EXPECT_THAT(finished.out, HasSubstr("  xgt_cnet/timing/back_to_back       200      0.000      "
                                      "0.000      0.000      0.000\n"));
  EXPECT_THAT(finished.out, HasSubstr("  xgt_cnet/timing/delay/d10           50     10.000     "
                                      "10.000     10.000     10.000\n"));
  const auto written = nlohmann::json::parse(read_text(out_ + "/results.json"))["timing"];
  EXPECT_EQ(written["cases"]["xgt_cnet/timing/delay/d10"], (nlohmann::json{{"replies", 50},
                                                                           {"min_ms", 10.0},
                                                                           {"median_ms", 10.0},
                                                                           {"p99_ms", 10.0},
                                                                           {"max_ms", 10.0}}));
  EXPECT_EQ(written["groups"]["xgt_cnet/timing"]["replies"], 250);
  Junit junit;
  read_junit(out_ + "/junit.xml", junit);
  EXPECT_EQ(junit.document.select_node("//property[@name='reply times xgt_cnet/timing/delay/d10']")
                .node()
                .attribute("value")
                .value(),
            std::string("50 replies: min 10.000, median 10.000, p99 10.000, max 10.000 ms"));
  EXPECT_THAT(read_text(out_ + "/report.html"), HasSubstr("99 %"));
}

/// A reply of Modbus RTU begins 5.05 ms behind its request, in simulated time.
TEST_F(Timing, ALimitOfTheProfileIsMissedByAReplyBehindIt) {
  nlohmann::ordered_json vector = small_vector("v/delayed");
  vector["id"] = "modbus_rtu/v/reply";
  vector["steps"] = {{{"send", "[st 03 00 63 00 01 CRC]"}}, {{"expect", "[st 03 02 ?? ?? CRC]"}}};
  const std::string vectors = write_vectors(folder_, {vector});
  const auto verdict = [&](const std::string& limit) {
    const std::string profile = folder_.write(
        "p.json",
        R"({"name": "p", "extends": "xbc-h", "timing": {"response_max": ")" + limit + R"("}})");
    run({"--endpoint", "emulator:xbc-h", "--vectors", vectors, "--profile", profile});
    return results().verdict("modbus_rtu/v/reply");
  };
  EXPECT_EQ(verdict("6ms"), "PASS");
  EXPECT_EQ(verdict("5200us"), "MARGINAL");
  EXPECT_EQ(verdict("5ms"), "FAIL");
}

/// A reply after 10 ms, against limits around it.
TEST_F(Timing, LimitsOfTheProfileHaveUnitsAndAGuardBand) {
  nlohmann::ordered_json vector = small_vector("v/delayed");
  vector["given"]["config"] = {{"rs485", true}, {"delay_ms", 10}};
  const std::string vectors = write_vectors(folder_, {vector});
  const auto verdict = [&](const std::string& timing) {
    const std::string profile =
        folder_.write("p.json", R"({"name": "p", "extends": "xbc-h", "timing": {)" + timing + "}}");
    run({"--endpoint", "emulator:xbc-h", "--vectors", vectors, "--profile", profile});
    return results().verdict("xgt_cnet/v/delayed");
  };
  EXPECT_EQ(verdict(R"("response_max": "2ms")"), "PASS");
  EXPECT_EQ(verdict(R"("response_max": "1ms")"), "MARGINAL") << "it begins behind the delay";
  EXPECT_EQ(verdict(R"("turnaround_min": "9ms")"), "PASS");
  EXPECT_EQ(verdict(R"("turnaround_min": "0.0095s")"), "MARGINAL");
  EXPECT_EQ(verdict(R"("turnaround_min": "10100us")"), "FAIL");
}

}  // namespace
}  // namespace fieldproof::tool_tests
