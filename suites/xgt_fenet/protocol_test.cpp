#include "suites/xgt_fenet/protocol.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::xgt_fenet_suite {
namespace {

using harness::Field;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Bytes hex_bytes(std::string_view hex) { return *from_hex(hex); }

// FEnet EN 5.2.6, tables 5-6 (its check is an erratum: 3C) to 5-9.
const Bytes read_word = hex_bytes(
    "4C 53 49 53 2D 58 47 54 00 00 00 00 A0 33 00 00 0E 00 00 3C 54 00 02 00 00 00 01 00 04 00 25 "
    "4D "
    "57 30");
const Bytes word_reply = hex_bytes(
    "4C 53 49 53 2D 58 47 54 00 00 11 01 A0 11 00 00 0E 00 03 2F 55 00 02 00 08 01 00 00 01 00 02 "
    "00 "
    "00 00");
const Bytes read_bytes = hex_bytes(
    "4C 53 49 53 2D 58 47 54 00 00 00 00 A0 33 00 01 10 00 00 3F 54 00 14 00 00 00 01 00 04 00 25 "
    "4D "
    "42 30 02 00");
const Bytes bytes_reply = hex_bytes(
    "4C 53 49 53 2D 58 47 54 00 00 02 08 A0 11 00 01 0E 00 01 26 55 00 14 00 00 00 00 00 01 00 02 "
    "00 "
    "00 00");

std::string problems(const Bytes& frame) {
  std::string all;
  for (const Field& field : protocol().explain(frame))
    if (!field.problem.empty()) all += field.name + ": " + field.problem + "\n";
  return all;
}
Bytes with(Bytes frame, std::size_t at, Byte value) {
  frame.at(at) = value;
  return frame;
}

TEST(FenetExplain, ThePrintedFramesAreFaultless) {
  for (const Bytes& frame : {read_word, word_reply, read_bytes, bytes_reply}) {
    EXPECT_EQ(problems(frame), "");
    EXPECT_EQ(protocol().frame_length(frame), frame.size());
  }
  EXPECT_EQ(problems(with(read_word, 19, 0x4E)),
            "check sum: 3C is right: the sum of the 19 bytes before it\n");
  EXPECT_EQ(problems(with(word_reply, 19, 0)), "") << "'h00 : Reserved area' (Table 5-3)";
}

TEST(FenetExplain, NamesEachField) {
  std::vector<std::string> names;
  std::size_t at = 0;
  for (const Field& field : protocol().explain(read_bytes)) {
    EXPECT_EQ(field.offset, at) << field.name;
    at += field.size;
    names.push_back(field.name);
  }
  EXPECT_EQ(at, read_bytes.size());
  EXPECT_THAT(
      names, ElementsAre("company id", "PLC info", "CPU info", "source", "invoke id", "length",
                         "position", "check sum", "command", "data type", "reserved", "block count",
                         "name length", "name", "number of data"));
  const auto fields = protocol().explain(word_reply);
  EXPECT_EQ(fields[1].text, "1101 CPU type 11, RUN");
  EXPECT_EQ(fields[6].text, "03 base 0, slot 3");
  EXPECT_EQ(fields[8].text, "5500 read reply");
  EXPECT_EQ(fields.back().text, "0000");
}

TEST(FenetExplain, SaysWhatIsWrong) {
  EXPECT_THAT(problems(with(read_word, 0, 'X')), HasSubstr("LSIS-XGT and two zeros"));
  EXPECT_THAT(problems(with(read_word, 13, 0x11)), HasSubstr("a request comes from a client"));
  EXPECT_THAT(problems(with(read_word, 16, 0x0F)), HasSubstr("0E00 is right"));
  EXPECT_THAT(problems(with(read_word, 20, 0x60)), HasSubstr("5400 reads"));
  EXPECT_THAT(problems(with(read_word, 22, 0x05)), HasSubstr("data type: 0000 bit"));
  EXPECT_THAT(problems(with(read_word, 26, 0x11)), HasSubstr("block count: 0100 to 1000"));
  EXPECT_THAT(problems(with(read_word, 28, 0x03)), HasSubstr("name length: 0400"));
  EXPECT_THAT(problems(with(read_word, 28, 0x03)), HasSubstr("surplus"));
  EXPECT_THAT(problems(with(word_reply, 30, 0x01)), HasSubstr("a word has 2 bytes"));
  for (std::size_t size = 1; size < read_bytes.size(); ++size)
    EXPECT_NE(
        problems(Bytes(read_bytes.begin(), read_bytes.begin() + static_cast<std::ptrdiff_t>(size))),
        "")
        << size;
  EXPECT_THAT(protocol().explain({}), IsEmpty());
  const auto refusal = protocol().explain(hex_bytes(
      "4C 53 49 53 2D 58 47 54 00 00 07 01 B0 11 01 00 0A 00 01 30 55 00 02 00 00 00 FF FF 04 00"));
  EXPECT_EQ(refusal.back().text, "0400 past the end of the area");
  EXPECT_EQ(refusal.back().problem, "");
}

/// The one after 5300 is 5400, with which a request begins.
TEST(FenetExplain, ARefusalOfTheCommandBeforeAKnownOneIsARefusal) {
  const auto fields = protocol().explain(hex_bytes(
      "4C 53 49 53 2D 58 47 54 00 00 07 01 B0 11 01 00 0A 00 01 30 54 00 02 00 00 00 FF FF 78 00"));
  EXPECT_EQ(fields[fields.size() - 2].name, "status");
  EXPECT_THAT(fields.back().text, HasSubstr("7800"));
  EXPECT_EQ(fields.back().name, "error code");
}

TEST(FenetProtocol, IsOfANetwork) {
  EXPECT_EQ(protocol().default_port(), 2004);
  EXPECT_EQ(protocol().datagram_port(), 2005);
  for (const std::string& model : protocol().models()) {
    const auto device = protocol().make_device(model, json{{"station", 1}});
    ASSERT_TRUE(device) << device.error().message;
    EXPECT_TRUE((*device)->network()->listens(Transport::tcp, 2004));
    EXPECT_TRUE((*device)->network()->listens(Transport::udp, 2005));
  }
}

TEST(FenetProtocol, SharesItsMemoryWithCnet) {
  const auto device =
      protocol().make_device("xbc-h", json{{"services", {{"xgt-cnet", {{"station", 1}}}}}});
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_TRUE((*device)->line(2));
}

TEST(FenetProtocol, AModuleHasOneDriver) {
  const auto device =
      protocol().make_device("xbc-h", json{{"services", {{"modbus-tcp", {{"station", 1}}}}}});
  ASSERT_FALSE(device);
  EXPECT_THAT(device.error().message, HasSubstr("two server drivers"));
}

TEST(FenetNotation, LengthAndSumAreThoseOfThePrintedFrames) {
  const auto bytes = [](std::string_view text) {
    const auto notation = notation::parse_notation(text);
    EXPECT_TRUE(notation) << notation.error().message;
    const auto frames = notation::make_templates(*notation, protocol().fields_at(1));
    EXPECT_TRUE(frames) << frames.error().message;
    return *notation::render(frames->front(), {});
  };
  const std::string body = " 54 00 02 00 00 00 01 00 name(%MW0)]";
  EXPECT_EQ(bytes("['LSIS-XGT' 00 00 00 00 A0 33 00 00 LEN 00 SUM" + body), read_word);
  EXPECT_EQ(bytes("['LSIS-XGT' 00 00 00 00 A0 33 00 00 LEN 00 SUM!" + body),
            with(read_word, 19, 0x3D));
  Bytes longer = with(with(read_word, 16, 0x0F), 19, 0x3D);
  EXPECT_EQ(bytes("['LSIS-XGT' 00 00 00 00 A0 33 00 00 LEN! 00 SUM" + body), longer);
}

TEST(FenetMemory, ReadsAndWritesByBlocksAndByRuns) {
  const auto bodies = [](const Result<std::vector<Bytes>>& requests) {
    std::vector<std::string> all;
    if (!requests) return std::vector{requests.error().message};
    for (const Bytes& one : *requests) all.push_back(to_hex(ByteView(one).subspan(20)));
    return all;
  };
  EXPECT_THAT(bodies(protocol().read_requests(1, "%MW0", 4)),
              ElementsAre("54 00 02 00 00 00 01 00 04 00 25 4D 57 30"));
  EXPECT_THAT(bodies(protocol().write_requests(1, "%MW0", "12345678")),
              ElementsAre("58 00 02 00 00 00 01 00 04 00 25 4D 57 30 02 00 34 12",
                          "58 00 02 00 00 00 01 00 04 00 25 4D 57 31 02 00 78 56"))
      << "how several blocks follow one another in a write is not printed";
  EXPECT_THAT(bodies(protocol().write_requests(1, "%MB0", "1234")),
              ElementsAre("58 00 14 00 00 00 01 00 04 00 25 4D 42 30 02 00 12 34"));
  EXPECT_EQ(bodies(protocol().read_requests(1, "%MW0", 17 * 4)).size(), 2u);
  EXPECT_EQ(bodies(protocol().read_requests(1, "%MB0", 513 * 2)).size(), 2u);
  EXPECT_THAT(bodies(protocol().write_requests(1, "%FW0", "1234")),
              ElementsAre(HasSubstr("read only")));
  EXPECT_THAT(bodies(protocol().read_requests(1, "%MX0", 4)),
              ElementsAre(HasSubstr("name each bit")));
  EXPECT_THAT(bodies(protocol().read_requests(1, "%MW0", 3)),
              ElementsAre(HasSubstr("whole number of elements")));
}

TEST(FenetMemory, RepliesAreReadMostSignificantFirst) {
  const Bytes reply = hex_bytes(
      "4C 53 49 53 2D 58 47 54 00 00 07 01 B0 11 00 00 12 00 01 37 55 00 02 00 00 00 00 00 02 00 "
      "02 "
      "00 34 12 02 00 78 56");
  EXPECT_EQ(*protocol().read_reply(reply), "12345678");
  EXPECT_EQ(*protocol().read_reply(bytes_reply), "0000");
  EXPECT_FALSE(protocol().read_reply(read_word));
  for (std::size_t size = 0; size < 24; ++size)
    EXPECT_FALSE(protocol().read_reply(Bytes(reply.begin(), reply.begin() + std::ptrdiff_t(size))));
  EXPECT_TRUE(protocol().memory()->answers(read_word, word_reply));
  EXPECT_FALSE(protocol().memory()->answers(read_word, bytes_reply));
  EXPECT_FALSE(protocol().memory()->answers(read_word, reply)) << "two words, and one was asked";
}

TEST(FenetMemory, TheFenceSeesEveryWriteThatADeviceMightSee) {
  const Bytes write = (*protocol().write_requests(1, "%MW100", "1234")).front();
  const auto areas = [](const Bytes& bytes) {
    std::string all;
    for (const auto& one : protocol().written_by(bytes))
      all += one.area + std::to_string(one.first_word) + ' ';
    return all;
  };
  EXPECT_EQ(areas(write), "M100 ");
  EXPECT_EQ(areas(read_word), "");
  Bytes two = read_word;
  two.insert(two.end(), write.begin(), write.end());
  EXPECT_EQ(areas(two), "M100 ");
  Bytes late{0x00, 0x01};
  late.insert(late.end(), write.begin(), write.end());
  EXPECT_EQ(areas(late), "M100 ");
  EXPECT_EQ(areas(Bytes(write.begin(), write.begin() + 24)), "?0 ");
  EXPECT_EQ(areas(with(write, 0, 'X')), "M100 ");
  const auto run =
      protocol().written_by((*protocol().write_requests(1, "%MB200", "11223344")).front());
  ASSERT_EQ(run.size(), 1u);
  EXPECT_EQ(run[0].first_word, 100u);
  EXPECT_EQ(run[0].last_word, 101u);
}

TEST(FenetMemory, AddressesAreTheNames) {
  const auto fields = protocol().address_fields(read_word, false);
  ASSERT_EQ(fields.size(), 1u);
  EXPECT_EQ(fields[0].offset, 30u);
  EXPECT_EQ(fields[0].names.area, "M");
  EXPECT_FALSE(protocol().moved_field(read_word, fields[0], 10)) << "%MW10 has a character more";
}

TEST(FenetProbe, HasAnInvokeIdThatTheTestedFrameDoesNotHave) {
  const Bytes first = protocol().probe(1, read_word);
  const Bytes second = protocol().probe(1, first);
  EXPECT_NE(first, second);
  EXPECT_EQ(problems(first), "");
  Bytes reply = word_reply;
  EXPECT_FALSE(protocol().is_reply_to_probe(first, reply));
  std::copy_n(first.begin() + 14, 2, reply.begin() + 14);
  EXPECT_TRUE(protocol().is_reply_to_probe(first, reply));
}

/// Found by fuzz.sh: blanks were counted as digits, and bytes behind the last one were sent.
TEST(Memory, BlanksAreNoDigits) {
  for (const char* hex : {"3D4B\t\t\t\t", "12 4", "    "})
    EXPECT_FALSE(protocol().write_requests(1, "%MW99", hex)) << hex;
}

TEST(XgtFenet, FactsOfTheRemoteServiceAreChecked) {
  const auto check = [](const char* facts) {
    const Status checked = protocol().tables()->check_table(nlohmann::json::parse(facts));
    return checked ? std::string("right") : checked.error().message;
  };
  EXPECT_EQ(
      check(R"({"service": "remote server", "transport": "tcp", "port": 2002, "channels": 1})"),
      "right");
  EXPECT_EQ(
      check(R"({"service": "remote client", "transport": "tcp", "port": 2004, "channels": 1})"),
      "its port is 2002");
  EXPECT_EQ(
      check(R"({"service": "remote client", "transport": "udp", "port": 2002, "channels": 1})"),
      "it is over tcp");
  EXPECT_EQ(
      check(R"({"service": "remote client", "transport": "tcp", "port": 2002, "channels": 2})"),
      "it has 1 channel");
  EXPECT_EQ(check(R"({"remote": [{"slot": 2}], "accepted": false, "says": "ip is ''"})"), "right");
  EXPECT_THAT(check(R"({"remote": [{"slot": 2}], "accepted": false, "says": "base"})"),
              testing::HasSubstr("it does not say 'base'"));
  EXPECT_THAT(check(R"({"remote": [{"network": "cnet"}], "accepted": false})"),
              testing::HasSubstr("it is accepted"));
}

}  // namespace
}  // namespace fieldproof::xgt_fenet_suite
