#include "reports/results/result_json.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "reports/results/test_as_json.hpp"

namespace fieldproof::results {
namespace {

using nlohmann::json;

using test::as_json;

CaseResult full_result() {
  CaseResult result;
  result.id = "xgt_cnet/rss/two_words";
  result.line = "38400-8N1";
  result.repeat = 2;
  result.dut = "c41a";
  result.rev = 3;
  result.protocol = "xgt-cnet";
  result.title = "Read two words";
  result.level = "must";
  result.basis = "printed rule";
  result.on_model = "register";
  result.manual = "xgb-cnet-en-1.6";
  result.section = "7.1.5 (1)(e)";
  result.quote = "This example supposes when 1 WORD";
  result.verdict = Verdict::non_strict;
  result.message = "command type in upper case";
  result.notes = {"station 1 -> 3", "\x05 <b> 국"};
  result.expected = "[ACK st]";
  result.expected_bytes = {0x06, 0x30};
  result.expected_hex = "06 30 ??";
  result.received = "ACK '1'";
  result.received_bytes = {0x06, 0x31};
  result.due = {3ms, 503ms};
  result.received_extract = {2000, {0x07, 0x08}, std::string(64, 'b')};
  result.differences = {{"station", "00", "01", "the request's"}, {"BCC", "4C", "4D", ""}};
  result.exchange = {{Event::Kind::sent, 0ns, 1234567ns, {0x05, 0xFF}, "ENQ FF"},
                     {Event::Kind::received, 2000001ns, 3600s + 1ns, {0x06, 0x31}, "ACK '1'"},
                     {Event::Kind::note, 5ms, 5ms, {}, "silence until here"}};
  result.exchange[1].extract = {2000, {0x07, 0x08}, std::string(64, 'b')};
  result.recording.stimulus = "0123456789abcdef";
  result.trace.axes = {{"B:1",
                        {{1ms, 0, 0}, {4ms, 12.5, -5000}},
                        {{1ms, "MOTO 10000 5000 50"}},
                        {{"min limit switch", -400, -300}}}};
  result.trace.nets = {{1, {{2, 0ns, 10ms, 6ms, 2, true}, {3, 10ms, 20ms, 0ns, 2}}, 20ms}};
  result.readings = {{"type_echo", "upper"}};
  result.response_ms = {0.765434, 12};
  result.seconds = 0.125;
  result.replay = "fieldproof run --filter xgt_cnet/rss/two_words";
  return result;
}

TEST(CaseResultJson, EveryFieldComesBack) {
  const CaseResult result = full_result();
  const json first = as_json(result);
  const auto again = json::parse(first.dump()).get<CaseResult>();
  EXPECT_EQ(first, as_json(again));
  EXPECT_EQ(result.id, again.id);
  EXPECT_EQ(2, again.repeat);
  EXPECT_EQ(Verdict::non_strict, again.verdict);
  EXPECT_EQ(result.notes, again.notes);
  EXPECT_EQ(result.expected_bytes, again.expected_bytes);
  EXPECT_EQ(result.received_bytes, again.received_bytes);
  ASSERT_EQ(2u, again.differences.size());
  EXPECT_EQ("the request's", again.differences[0].hint);
  ASSERT_EQ(3u, again.exchange.size());
  EXPECT_EQ(Event::Kind::received, again.exchange[1].kind);
  EXPECT_EQ(2000001ns, again.exchange[1].start) << "times are exact to the nanosecond";
  EXPECT_EQ(3600s + 1ns, again.exchange[1].end);
  EXPECT_EQ(result.exchange[0].bytes, again.exchange[0].bytes);
  EXPECT_EQ(result.exchange[1].extract, again.exchange[1].extract);
  EXPECT_EQ(result.received_extract, again.received_extract);
  EXPECT_EQ(result.due, again.due);
  ASSERT_EQ(1u, again.trace.axes.size());
  EXPECT_EQ("B:1", again.trace.axes[0].axis);
  EXPECT_EQ(-5000, again.trace.axes[0].samples.at(1).speed);
  EXPECT_EQ(4ms, again.trace.axes[0].samples[1].time);
  EXPECT_EQ(6ms, again.trace.nets.at(0).turns.at(0).busy);
  EXPECT_EQ(2u, again.trace.nets[0].turns[0].of);
  EXPECT_TRUE(again.trace.nets[0].turns[0].begins);
  EXPECT_EQ(20ms, again.trace.nets[0].cycle);
  EXPECT_EQ(result.readings, again.readings);
  EXPECT_EQ(result.response_ms, again.response_ms);
  EXPECT_EQ(0.125, again.seconds);
  EXPECT_EQ(result.replay, again.replay);
}

/// The start of an event of this time, as it stands in the file.
std::string written(Duration time) {
  CaseResult result;
  result.exchange = {{Event::Kind::note, time, 0ns, {}, ""}};
  std::string text;
  append_json(text, result);
  const std::string key = "\"start_ms\":";
  const std::size_t from = text.find(key) + key.size();
  return text.substr(from, text.find_first_of(",}", from) - from);
}

TEST(CaseResultJson, TimesAreMillisecondsToTheNanosecond) {
  EXPECT_EQ(written(0ns), "0.0");
  EXPECT_EQ(written(1ns), "0.000001");
  EXPECT_EQ(written(12ms), "12.0");
  EXPECT_EQ(written(1234567ns), "1.234567");
  EXPECT_EQ(written(100'200us), "100.2");
  EXPECT_EQ(written(-1'500us), "-1.5");
  EXPECT_EQ(written(Duration::min()), "-9223372036854.775808");
}

TEST(CaseResultJson, NoFieldIsForgotten) {
  // As many keys as fields, when none is empty. The binding does not compile once a field is added:
  // then extend it, full_result() and `fields`.
  const auto& [id, repeat, dut, line, rev, protocol, title, level, basis, on_model, manual, section,
               quote, verdict, message, notes, expected, expected_bytes, expected_hex, received,
               received_bytes, received_extract, due, differences, exchange, recording, trace,
               readings, response_ms, seconds, replay] = full_result();
  EXPECT_EQ(31u, as_json(full_result()).size());
}

TEST(CaseResultJson, EmptyFieldsAreLeftOut) {
  CaseResult result;
  result.id = "a/b";
  result.verdict = Verdict::pass;
  EXPECT_EQ(
      json::parse(
          R"({"id":"a/b","rev":1,"protocol":"","title":"","level":"","basis":"","verdict":"PASS","seconds":0.0})"),
      as_json(result));
}

TEST(CaseResultJson, BytesAreHex) {
  CaseResult result;
  result.id = "a/b";
  for (int b = 0; b < 256; ++b) result.received_bytes.push_back(static_cast<Byte>(b));
  const json object = as_json(result);
  EXPECT_EQ("00 01 02", object["received_bytes"].get<std::string>().substr(0, 8));
  EXPECT_EQ(result.received_bytes, object.get<CaseResult>().received_bytes);
}

TEST(CaseResultJson, ForeignShapesThrow) {
  const auto read = [](const char* text) { return json::parse(text).get<CaseResult>(); };
  EXPECT_THROW(read(R"({"verdict":"PASS"})"), json::exception);
  EXPECT_THROW(read(R"({"id":"a/b"})"), json::exception);
  EXPECT_THROW(read(R"({"id":"","verdict":"PASS"})"), json::exception);  // found by fieldproof_fuzz
  EXPECT_THROW(read(R"({"id":"a/b","verdict":"GREEN"})"), json::exception);
  EXPECT_THROW(read(R"({"id":"a/b","verdict":"PASS","notes":"x"})"), json::exception);
  EXPECT_THROW(read(R"({"id":"a/b","verdict":"PASS","received_bytes":"0G"})"), json::exception);
  EXPECT_THROW(read(R"({"id":"a/b","verdict":"PASS","exchange":[{"kind":"lost"}]})"),
               json::exception);
  EXPECT_THROW(
      read(R"({"id":"a/b","verdict":"PASS","exchange":[{"kind":"note","start_ms":1e300}]})"),
      json::exception);
  EXPECT_THROW(read(R"({"id":"a/b","verdict":"PASS","trace":{"axes":[{"axis":"1"}]}})"),
               json::exception);
  EXPECT_THROW(read("[]"), json::exception);
  EXPECT_THROW(read("null"), json::exception);
}

TEST(RunJson, HeadAndEndComeBack) {
  const RunInfo info{
      "0.1.0", "2026-11-21T12:39:03+00:00", "emulator:xbc-h", "xbc-h", "fieldproof run",
      "a1b2",  {{"station", "1"}}};
  const auto info_again = as_json(info).get<RunInfo>();
  EXPECT_EQ(as_json(info), as_json(info_again));
  EXPECT_EQ("a1b2", info_again.vectors_hash);
  EXPECT_EQ(info.properties, info_again.properties);
  EXPECT_EQ(7u, as_json(info).size()) << "what was not entered is left out";

  const RunEnd end{"2026-11-21T12:39:04+00:00", 1.5, 130, true, "interrupted"};
  const auto end_again = as_json(end).get<RunEnd>();
  EXPECT_EQ(as_json(end), as_json(end_again));
  EXPECT_EQ(130, end_again.exit_code);
  EXPECT_TRUE(end_again.interrupted);
  EXPECT_EQ("interrupted", end_again.trouble);
}

TEST(RunJson, IdentityHashesAndErrataComeBack) {
  RunInfo info;
  info.identity = {"bench-1", "LS",     "XBC-DN32H",         "S/N 7",           "V1.8",
                   "Kim",     "port 2", {{"areas", "PMLK"}}, {{"areas", "PML"}}};
  info.hashes = {{"tool", "00ff"}};
  info.sections = {{"xgb-cnet-en-1.6", {{"7.1.5", "Detail of instruction"}}}, {"m", {}}};
  info.errata = {{"cnet_7/name",
                  "wrong bytes",
                  "H2550",
                  "H255057",
                  "six characters",
                  "sends seven",
                  "check it",
                  {{"xgb-cnet-en-1.6", "7.1.5", "H2550 printed"}},
                  {{"xgb-cnet-en-1.6", "7.1.2", "the length"}},
                  {"xgt_cnet/rss/two_words"}}};
  const auto again = as_json(info).get<RunInfo>();
  // As in NoFieldIsForgotten.
  const auto& [name, maker, model, serial, firmware, operator_name, notes, fingerprint,
               fingerprint_found] = again.identity;
  EXPECT_EQ(9u, as_json(again)["identity"].size());
  EXPECT_EQ("V1.8", firmware);
  EXPECT_EQ("Kim", operator_name);
  EXPECT_EQ(info.identity.fingerprint, fingerprint);
  EXPECT_EQ(info.identity.fingerprint_found, fingerprint_found);
  EXPECT_EQ(info.hashes, again.hashes);
  EXPECT_EQ(info.sections, again.sections);
  ASSERT_EQ(1u, again.errata.size());
  const auto& [id, kind, printed, right, why, effect, doubt, places, proof, vectors] =
      again.errata[0];
  EXPECT_EQ(10u, as_json(again)["errata"][0].size());
  EXPECT_EQ("cnet_7/name wrong bytes H2550 H255057", id + " " + kind + " " + printed + " " + right);
  EXPECT_EQ("six characters, sends seven, check it", why + ", " + effect + ", " + doubt);
  EXPECT_EQ("H2550 printed", places.at(0).quote);
  EXPECT_EQ("7.1.2", proof.at(0).section);
  EXPECT_EQ("xgt_cnet/rss/two_words", vectors.at(0));
  EXPECT_EQ(as_json(info), as_json(again));
}

TEST(RunJson, SeveralDevicesComeBack) {
  RunInfo info;
  info.duts = {{"serial:/dev/a",
                {{"station", "3"}},
                {"a", "LS", "XBL-C41A", "S/N 7", "V1.8", "Kim", "", {}, {}}},
               {"serial:/dev/b", {}, {}}};
  const auto again = as_json(info).get<RunInfo>();
  ASSERT_EQ(2u, again.duts.size());
  const auto& [endpoint, properties, identity] = again.duts[0];
  EXPECT_EQ("serial:/dev/a", endpoint);
  EXPECT_EQ(info.duts[0].properties, properties);
  EXPECT_EQ("S/N 7", identity.serial);
  EXPECT_EQ(as_json(info), as_json(again));
}

}  // namespace
}  // namespace fieldproof::results
