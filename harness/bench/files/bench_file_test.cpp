#include "harness/bench/files/bench_file.hpp"
#include "harness/device_names.hpp"

#include <gmock/gmock.h>

#include <fmt/format.h>

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* full = R"({"devices": {
  "c41a": {
    "endpoint": "serial:/dev/ttyUSB0?rs485=1", "profile": "xbc-dxxxh", "station": 3, "line": "38400-8E1",
    "identity": {"maker": "LS ELECTRIC", "model": "XBL-C41A", "serial": "2219-00417", "firmware": "V1.41"},
    "fingerprint": {"areas": "PMLK"}, "allow_write": ["M100-M199", "D0"], "operator": "J. Kim", "notes": "port 2"},
  "gateway": {"endpoint": "tcp:10.0.0.7:2000"}}})";

BenchDevice device(const std::string& text, const std::string& name) {
  const Result<BenchFile> file = parse_bench_file(text, "lab/bench.json", harness::read_word_name);
  EXPECT_TRUE(file) << file.error().message;
  const Result<BenchDevice> found = find_device(*file, name);
  EXPECT_TRUE(found) << found.error().message;
  return *found;
}

/// What is said of a file that has one device "d" of these keys.
std::string refusal(const std::string& keys) {
  const Result<BenchFile> file =
      parse_bench_file(fmt::format(R"({{"devices": {{"d": {{{}}}}}}})", keys), "lab/bench.json",
                       harness::read_word_name);
  return file ? "accepted" : file.error().message;
}

TEST(BenchFile, EveryKeyIsRead) {
  const BenchDevice c41a = device(full, "c41a");
  EXPECT_EQ(c41a.endpoint, "serial:/dev/ttyUSB0?rs485=1");
  EXPECT_EQ(c41a.profile, "xbc-dxxxh");
  EXPECT_EQ(c41a.station, 3);
  EXPECT_EQ(c41a.line, "38400-8E1");
  EXPECT_THAT(c41a.allow_write, ElementsAre("M100-M199", "D0"));
  EXPECT_EQ(c41a.identity.name, "c41a");
  EXPECT_EQ(c41a.identity.maker, "LS ELECTRIC");
  EXPECT_EQ(c41a.identity.model, "XBL-C41A");
  EXPECT_EQ(c41a.identity.serial, "2219-00417");
  EXPECT_EQ(c41a.identity.firmware, "V1.41");
  EXPECT_EQ(c41a.identity.operator_name, "J. Kim");
  EXPECT_EQ(c41a.identity.notes, "port 2");
  EXPECT_THAT(c41a.identity.fingerprint, ElementsAre(testing::Pair("areas", "PMLK")));
}

TEST(BenchFile, OnlyTheEndpointIsNeeded) {
  const BenchDevice gateway = device(full, "gateway");
  EXPECT_EQ(endpoint_of(gateway), "tcp:10.0.0.7:2000");
  EXPECT_EQ(gateway.profile, "");
  EXPECT_EQ(gateway.station, std::nullopt);
}

TEST(BenchFile, StationAndLineBecomeOptionsOfTheEndpoint) {
  EXPECT_EQ(endpoint_of(device(full, "c41a")),
            "serial:/dev/ttyUSB0?rs485=1&station=3&baud=38400&frame=8E1");
  const auto of = [](const std::string& endpoint) {
    return endpoint_of(device(
        fmt::format(R"({{"devices": {{"d": {{"endpoint": "{}", "station": 0, "line": "9600"}}}}}})",
                    endpoint),
        "d"));
  };
  EXPECT_EQ(of("emulator:xbc-h"), "emulator:xbc-h?station=0&line=9600-8N1");
  EXPECT_EQ(of("pty:xbc-h"), "pty:xbc-h?station=0&line=9600-8N1");
  EXPECT_EQ(of("rfc2217:host:2000"), "rfc2217:host:2000?station=0&baud=9600&frame=8N1")
      << "what the report says is what the port is opened with";
  EXPECT_EQ(of("tcp:host:2000"), "tcp:host:2000?station=0");
  EXPECT_EQ(of("exec:tool --what? {tty}"), "exec:tool --what? {tty}?station=0");
  EXPECT_EQ(endpoints::parse_endpoint(of("exec:tool --what? {tty}"))->option("station", ""), "0");
}

TEST(BenchFile, PathsOfProfilesStartAtItsFolder) {
  const auto of = [](const char* profile) {
    return device(fmt::format(
                      R"({{"devices": {{"d": {{"endpoint": "emulator:", "profile": "{}"}}}}}})",
                      profile),
                  "d")
        .profile;
  };
  EXPECT_EQ(of("mine.json"), "lab/mine.json");
  EXPECT_EQ(of("../shared/mine.json"), "shared/mine.json");
  EXPECT_EQ(of("/etc/mine.json"), "/etc/mine.json");
  EXPECT_EQ(of("xbc-h"), "xbc-h");
}

TEST(BenchFile, ErrorsNameFileKeyAndWhatToWrite) {
  EXPECT_EQ(
      refusal(R"("endpoint": "emulator:", "statoin": 3)"),
      "cannot read bench file lab/bench.json: devices.d: unknown key 'statoin'; did you mean "
      "'station'?; the keys are endpoint, profile, "
      "station, line, identity, fingerprint, allow_write, operator, notes, stimulus, control, "
      "aux");
  EXPECT_THAT(refusal(R"("endpoint": "emulator:", "identity": {"vendor": "LS"})"),
              HasSubstr("devices.d.identity: unknown key 'vendor'"));
  EXPECT_THAT(refusal(R"("station": 3)"), HasSubstr("devices.d: has no \"endpoint\""));
  EXPECT_THAT(refusal(R"("endpoint": "serail:/dev/ttyUSB0")"),
              HasSubstr("devices.d.endpoint: cannot read endpoint"));
  EXPECT_THAT(refusal(R"("endpoint": "serail:/dev/ttyUSB0")"), HasSubstr("did you mean 'serial'"));
  EXPECT_THAT(refusal(R"("endpoint": 5)"), HasSubstr("devices.d.endpoint: must be a text"));
  EXPECT_THAT(refusal(R"("endpoint": "emulator:", "identity": "LS")"),
              HasSubstr("devices.d.identity: must be an object"));
  EXPECT_THAT(refusal(R"("endpoint": "emulator:", "identity": {"serial": 7})"),
              HasSubstr("devices.d.identity.serial: must be a text"));
  EXPECT_THAT(refusal(R"("endpoint": "emulator:", "fingerprint": {"areas": ["P"]})"),
              HasSubstr("devices.d.fingerprint.areas: must be a text"));
}

TEST(BenchFile, StationsAreNumbersFrom0To255) {
  for (const char* good : {"0", "255"})
    EXPECT_EQ(refusal(fmt::format(R"("endpoint": "emulator:", "station": {})", good)), "accepted")
        << good;
  for (const char* bad : {"-1", "256", "1.5", "\"3\"", "null", "99999999999"})
    EXPECT_THAT(refusal(fmt::format(R"("endpoint": "emulator:", "station": {})", bad)),
                HasSubstr("devices.d.station: must be a number from 0 to 255"))
        << bad;
}

TEST(BenchFile, LinesAndRangesAreChecked) {
  EXPECT_THAT(refusal(R"("endpoint": "emulator:", "line": "9600-9X9")"),
              HasSubstr("devices.d.line: "));
  EXPECT_THAT(refusal(R"("endpoint": "emulator:", "allow_write": "M")"),
              HasSubstr("devices.d.allow_write: must be a list"));
  EXPECT_THAT(refusal(R"("endpoint": "emulator:", "allow_write": [1])"),
              HasSubstr("devices.d.allow_write: must be a list of texts"));
  EXPECT_THAT(refusal(R"("endpoint": "emulator:", "allow_write": ["M9-M1"])"),
              HasSubstr("devices.d.allow_write: "));
}

TEST(BenchFile, TheEndpointMustNotContradictTheKeys) {
  EXPECT_THAT(refusal(R"("endpoint": "emulator:xbc-h?station=2", "station": 3)"),
              HasSubstr("devices.d.station: the endpoint says a station, too"));
  EXPECT_THAT(refusal(R"("endpoint": "serial:/dev/x?baud=9600", "line": "38400-8N1")"),
              HasSubstr("devices.d.line: the endpoint says 'baud', too"));
}

TEST(BenchFile, ACopiedDeviceMustBeRenamed) {
  const Result<BenchFile> file = parse_bench_file(
      R"({"devices": {"d": {"endpoint": "emulator:"}, "d": {"endpoint": "emulator:xbc-h"}}})",
      "bench.json", harness::read_word_name);
  ASSERT_FALSE(file);
  EXPECT_THAT(file.error().message, HasSubstr("key 'd' stands twice"));
  // Equal keys of two devices are no twins.
  EXPECT_TRUE(parse_bench_file(
      R"({"devices": {"d": {"endpoint": "emulator:"}, "e": {"endpoint": "emulator:"}}})",
      "bench.json", harness::read_word_name));
}

TEST(BenchFile, WhatIsNoBenchFileIsRefused) {
  const auto refused = [](const char* text) {
    const Result<BenchFile> file = parse_bench_file(text, "bench.json", harness::read_word_name);
    return file ? "accepted" : file.error().message;
  };
  EXPECT_THAT(refused("{\n\"devices\": {,}}"), HasSubstr("line 2"));
  EXPECT_THAT(refused("[]"), HasSubstr("must be an object"));
  EXPECT_THAT(refused("{}"), HasSubstr("has no \"devices\""));
  EXPECT_THAT(refused(R"({"device": {}})"), HasSubstr("did you mean 'devices'"));
  EXPECT_THAT(refused(R"({"devices": []})"), HasSubstr("has no \"devices\""));
  EXPECT_THAT(refused(R"({"devices": {"d": []}})"), HasSubstr("devices.d: must be an object"));
  EXPECT_THAT(refused(""), HasSubstr("cannot read bench file bench.json"));
  EXPECT_THAT(
      load_bench_file("/nonexistent/bench.json", harness::read_word_name).error().message,
      HasSubstr("cannot read bench file /nonexistent/bench.json: no such file or directory"));
}

TEST(BenchFile, AnUnknownDeviceSuggestsANearOne) {
  const Result<BenchFile> file = parse_bench_file(full, "bench.json", harness::read_word_name);
  ASSERT_TRUE(file);
  EXPECT_EQ(find_device(*file, "gatway").error().message,
            "no device 'gatway' in bench file bench.json; did you mean 'gateway'?; there is c41a, "
            "gateway");
  EXPECT_THAT(find_device(BenchFile{"bench.json", {}}, "x").error().message,
              HasSubstr("there is none"));
}

}  // namespace
}  // namespace fieldproof::bench
