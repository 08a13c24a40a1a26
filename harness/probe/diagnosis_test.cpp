#include "harness/probe/diagnosis.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/line/uart.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::probe {
namespace {

Trial trial(const char* protocol = "xgt-cnet", int station = 1, const char* line = "9600-8N1") {
  return {*line::parse_line_settings(line), suites::protocols().find(protocol), station};
}
Bytes question(const Trial& t) { return t.protocol->probe(t.station, {}); }

/// What an emulated device of this station answers to the question for `asked` (the same when -1).
Bytes answer(const Trial& t, int asked = -1) {
  auto device = t.protocol->make_device(t.protocol->models().front(), {{"station", t.station}});
  Bytes bytes = t.protocol->probe(asked < 0 ? t.station : asked, {});
  line::Device& line = *(*device)->line();
  line.receive({bytes, 0s, 0s});
  for (int i = 0; i < 20; ++i) {
    const auto wake = line.wake_at();
    if (!wake) break;
    if (Bytes reply = line.advance(*wake); !reply.empty()) return reply;
  }
  return {};
}

Bytes joined(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Heard heard(Bytes after, std::string errors = "") {
  Heard result{.before = {}, .asked_until = 30ms, .after = {}, .errors = std::move(errors)};
  if (!after.empty()) result.after.push_back({std::move(after), 42ms, 1ms});
  return result;
}

/// The reply as a receiver with the bench's settings reads it when the device sends with others.
Heard read_with_other_settings(const Trial& t, const char* device) {
  const line::LineSettings sender = *line::parse_line_settings(device);
  const line::Reading reading =
      line::read_burst({answer(t), 42ms, sender.character_time()}, sender, t.line);
  Heard result{.before = {}, .asked_until = 30ms, .after = reading.bursts, .errors = ""};
  if (reading.errors.parity) result.errors += "3 parity errors";
  if (reading.errors.framing) result.errors += "3 framing errors";
  return result;
}

Diagnosis of(const Trial& t, const Heard& h) { return diagnose(t, h, suites::protocols()); }

class EachProtocol : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, EachProtocol,
                         testing::Values("xgt-cnet", "modbus-rtu", "modbus-ascii", "ls-bus"),
                         [](const auto& p) {
                           std::string name = p.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(EachProtocol, ReplyWithItsTime) {
  const Trial t = trial(GetParam(), 5);
  const Diagnosis d = of(t, heard(answer(t)));
  EXPECT_EQ(d.symptom, Symptom::reply);
  EXPECT_EQ(d.station, 5);
  EXPECT_EQ(d.response_time, 12ms);
  EXPECT_FALSE(d.echo);
  EXPECT_EQ(d.stray, 0u);
}

TEST_P(EachProtocol, EchoAlone) {
  const Trial t = trial(GetParam());
  const Diagnosis d = of(t, heard(question(t)));
  EXPECT_TRUE(d.echo);
  EXPECT_EQ(d.symptom, Symptom::silence);
}

TEST_P(EachProtocol, EchoBeforeTheReply) {
  const Trial t = trial(GetParam());
  const Diagnosis d = of(t, heard(joined(question(t), answer(t))));
  EXPECT_TRUE(d.echo);
  EXPECT_EQ(d.symptom, Symptom::reply);
  EXPECT_EQ(d.frame, answer(t));
  EXPECT_EQ(d.response_time, 12ms + question(t).size() * 1ms);
}

TEST_P(EachProtocol, TwoReplies) {
  const Trial t = trial(GetParam());
  EXPECT_EQ(of(t, heard(joined(answer(t), answer(t)))).symptom, Symptom::second_reply);
}

TEST_P(EachProtocol, ReplyOfAnotherStation) {
  const Trial t = trial(GetParam(), 1), three = trial(GetParam(), 3);
  const Diagnosis d = of(t, heard(answer(three)));
  EXPECT_EQ(d.symptom, Symptom::other_station);
  EXPECT_EQ(d.station, 3);
}

TEST_P(EachProtocol, AReplyThatGoesWrong) {
  const Trial t = trial(GetParam());
  Bytes broken = answer(t);
  broken[broken.size() / 2 + 1] ^= 0x22;
  EXPECT_EQ(of(t, heard(broken)).symptom, Symptom::damaged);
}

TEST_P(EachProtocol, InvertedBits) {
  const Trial t = trial(GetParam());
  Bytes bytes = answer(t);
  for (Byte& b : bytes) b = static_cast<Byte>(~b);
  EXPECT_EQ(of(t, heard(bytes)).symptom, Symptom::inverted);
}

TEST_P(EachProtocol, StrayBytesAroundTheReply) {
  const Trial t = trial(GetParam());
  const Diagnosis d = of(t, heard(joined({0x00, 0xFF}, answer(t))));
  EXPECT_EQ(d.symptom, Symptom::reply);
  EXPECT_EQ(d.stray, 2u);
}

TEST_P(EachProtocol, AFrameOfAnotherProtocol) {
  const Trial t = trial(GetParam()),
              other = trial(GetParam() == std::string("ls-bus") ? "modbus-ascii" : "ls-bus", 7);
  const Diagnosis d = of(t, heard(answer(other)));
  EXPECT_EQ(d.symptom, Symptom::foreign_frame);
  EXPECT_EQ(d.protocol, other.protocol);
  EXPECT_EQ(d.station, 7);
}

TEST_P(EachProtocol, AnotherMasterIsNoReply) {
  const Trial t = trial(GetParam()), two = trial(GetParam(), 2);
  EXPECT_EQ(of(t, heard(question(two))).symptom, Symptom::foreign_frame);
}

TEST(Diagnosis, ARefusalIsAReply) {
  const Bytes refusal = to_bytes(
      "\x15"
      "01RFE3E\x04");
  EXPECT_FALSE(trial("ls-bus").protocol->is_reply_to_probe(question(trial("ls-bus")), refusal));
  EXPECT_EQ(of(trial("ls-bus"), heard(refusal)).symptom, Symptom::reply);
}

TEST(Diagnosis, SilenceAndGarbage) {
  EXPECT_EQ(of(trial(), heard({})).symptom, Symptom::silence);
  EXPECT_EQ(of(trial(), heard({}, "1 break")).symptom, Symptom::garbage);
  EXPECT_EQ(of(trial(), heard({0x00, 0xFF, 0xFF, 0x80})).symptom, Symptom::garbage);
}

TEST(Diagnosis, WhatComesBeforeTheQuestionIsNoReplyToIt) {
  const Trial t = trial();
  Heard h = heard({});
  h.before.push_back({answer(t), 1ms, 1ms});
  EXPECT_EQ(of(t, h).symptom, Symptom::foreign_frame);
}

TEST(Diagnosis, ListeningReadsFramesOfAnyProtocol) {
  Heard h = heard({});
  h.before.push_back({joined({0xFE}, question(trial("modbus-rtu", 9))), 1ms, 1ms});
  const Diagnosis d = of(Trial{}, h);
  EXPECT_EQ(d.symptom, Symptom::foreign_frame);
  EXPECT_EQ(d.protocol->name(), "modbus-rtu");
  EXPECT_EQ(d.station, 9);
}

struct Mismatch {
  const char *bench, *device;
};
class Format : public testing::TestWithParam<Mismatch> {};
INSTANTIATE_TEST_SUITE_P(
    All, Format,
    testing::Values(Mismatch{"9600-8N1", "9600-7E1"}, Mismatch{"9600-8N1", "9600-7O1"},
                    Mismatch{"9600-8N1", "9600-7N2"}, Mismatch{"9600-8N1", "9600-8E1"},
                    Mismatch{"9600-8N1", "9600-8O1"}, Mismatch{"9600-8E1", "9600-8O1"},
                    Mismatch{"9600-8O1", "9600-8E1"}, Mismatch{"9600-7E1", "9600-7O1"},
                    Mismatch{"9600-7E1", "9600-8N1"}),
    [](const auto& p) {
      return std::string(p.param.bench).substr(5) + "_reads_" +
             std::string(p.param.device).substr(5);
    });

/// The device understands us, but its replies are in another format: which one shows in what is
/// left of them.
TEST_P(Format, IsNamed) {
  const Trial t = trial("xgt-cnet", 1, GetParam().bench);
  const Diagnosis d = of(t, read_with_other_settings(t, GetParam().device));
  ASSERT_EQ(d.symptom, Symptom::format) << to_hex(d.frame);
  line::LineSettings right = *line::parse_line_settings(GetParam().device);
  right.stop_bits = 1;  // a second one reads the same
  EXPECT_EQ(line::to_string(*d.right_format), line::to_string(right));
}

TEST(Diagnosis, AWrongSpeedIsNoWrongFormat) {
  for (const char* device : {"19200-8N1", "4800-8N1", "38400-8E1", "1200-8N1"}) {
    const Trial t = trial();
    EXPECT_THAT(of(t, read_with_other_settings(t, device)).symptom,
                testing::AnyOf(Symptom::garbage, Symptom::silence))
        << device;
  }
}

}  // namespace
}  // namespace fieldproof::probe
