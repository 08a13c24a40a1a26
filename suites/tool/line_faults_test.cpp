// Faults of the wiring over a port in real time: what `run` says of them, and what `probe` does.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;

struct LineFault {
  const char* name;
  std::string device;  // of testdata/device.py
  std::string run, probe;
};

void PrintTo(const LineFault& one, std::ostream* out) { *out << one.name; }

class LineFaults : public testing::TestWithParam<LineFault> {
 protected:
  static std::string endpoint() {
    return "exec:/usr/bin/python3 " FIELDPROOF_SOURCE_DIR "/suites/tool/testdata/device.py " +
           GetParam().device + " {tty}";
  }
  TestFolder folder_;
};

TEST_P(LineFaults, AreNamedByARun) {
  const Finished finished =
      run_tool({"run", "--endpoint", endpoint(), "--profile", "xbc-h", "--vectors",
                write_vectors(folder_, many_vectors(3)), "--out", folder_ / "out"});
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr(GetParam().run));
  EXPECT_EQ(read_results(folder_ / "out/results.ndjson").counts(),
            (std::map<std::string, std::size_t>{{"FAIL", 3}}));
  expect_reports(folder_ / "out");
}

TEST_P(LineFaults, AreNamedByTheProbe) {
  const Finished finished =
      run_tool({"probe", endpoint(), "--station", "1", "--protocol", "xgt-cnet", "--wait", "200"});
  EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr(GetParam().probe));
}

INSTANTIATE_TEST_SUITE_P(
    Over, LineFaults,
    testing::Values(LineFault{"two_devices", "twice",
                              "(a whole frame: do two devices have this station number?)",
                              "two devices   "},
                    LineFault{"wrong_parity", "parity", "station: expected 01, got 0<B1> (not hex)",
                              "wrong format  the device answers with another character format"}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace fieldproof::tool_tests
