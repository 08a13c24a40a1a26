#include "suites/modbus/memory_requests.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace fieldproof::modbus_suite {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

/// The messages of requests as hex, one after the other.
std::string messages(const Result<std::vector<Bytes>>& requests) {
  if (!requests) return requests.error().message;
  std::string text;
  for (const Bytes& request : *requests)
    text += (text.empty() ? "" : " | ") + to_hex(rtu_framing().unwrap(request));
  return text;
}
std::string write(std::string_view address, std::string_view hex) {
  return messages(write_requests(rtu_framing(), default_bases(), 1, address, hex));
}
std::string read(std::string_view address, std::size_t digits) {
  return messages(read_requests(rtu_framing(), default_bases(), 1, address, digits));
}

TEST(WriteRequests, WordsGoByFunctionCode10) {
  EXPECT_EQ(write("%MW100", "1234"), "01 10 00 64 00 01 02 12 34");
  EXPECT_EQ(write("%MW100", "12345678"), "01 10 00 64 00 02 04 12 34 56 78");
  EXPECT_EQ(write("%MD50", "12345678"), "01 10 00 64 00 02 04 56 78 12 34")
      << "the low word has the lower address";
  EXPECT_EQ(write("%ML25", "1122334455667788"), "01 10 00 64 00 04 08 77 88 55 66 33 44 11 22");
}

TEST(WriteRequests, BitsAndBytesGoByFunctionCode0F) {
  EXPECT_EQ(write("%MX0010A", "01"), "01 0F 00 AA 00 01 01 01");
  EXPECT_EQ(write("%MX00100", "010001"), "01 0F 00 A0 00 03 01 05");
  EXPECT_EQ(write("%MB21", "C3"), "01 0F 00 A8 00 08 01 C3");
}

TEST(WriteRequests, LongOnesAreCut) {
  std::string hex;
  for (int i = 0; i < 60; ++i) hex += "ABCD";
  const auto requests = write_requests(ascii_framing(), default_bases(), 1, "%MW0", hex);
  ASSERT_TRUE(requests);
  ASSERT_THAT(*requests, SizeIs(2));
  EXPECT_LE((*requests)[0].size(), 255u);
  EXPECT_EQ(ascii_framing().unwrap((*requests)[1]), *from_hex("01 10 00 3B 00 01 02 AB CD"));
}

TEST(WriteRequests, ErrorsSayWhyThereIsNoWay) {
  EXPECT_THAT(write("%PW1", "1234"), HasSubstr("read only"));
  EXPECT_THAT(write("%DW1", "1234"), HasSubstr("outside the Modbus bases"));
  EXPECT_THAT(write("@errors", "00"), HasSubstr("counter"));
  EXPECT_THAT(write("%MW99999", "1234"), HasSubstr("beyond the area"));
  EXPECT_THAT(write("%MW1", "12"), HasSubstr("whole number"));
  EXPECT_THAT(write("%MX0624F", "01"), HasSubstr("past data address 9998"));
  EXPECT_EQ(write("%MX0624E", "01"), "01 0F 27 0E 00 01 01 01") << "9998, the last one";
}

TEST(ReadRequests, ByAreaAndType) {
  EXPECT_EQ(read("%MW100", 8), "01 03 00 64 00 02");
  EXPECT_EQ(read("%PW1", 4), "01 04 00 01 00 01");
  EXPECT_EQ(read("%MX0010A", 2), "01 01 00 AA 00 01");
  EXPECT_EQ(read("%PX00011", 4), "01 02 00 11 00 01 | 01 02 00 12 00 01");
  EXPECT_EQ(read("%MB21", 4), "01 01 00 A8 00 10");
  EXPECT_EQ(read("%MD50", 8), "01 03 00 65 00 01 | 01 03 00 64 00 01") << "most significant first";
}

TEST(Replies, GiveDataOrTheReasonOfRefusal) {
  const Framing& rtu = rtu_framing();
  EXPECT_EQ(*read_reply(rtu, rtu.wrap(*from_hex("01 03 04 12 34 56 78"))), "12345678");
  EXPECT_THAT(read_reply(rtu, rtu.wrap(*from_hex("01 83 02"))).error().message,
              HasSubstr("02 Illegal Address"));
  EXPECT_THAT(read_reply(rtu, {}).error().message, HasSubstr("no answer"));
  EXPECT_TRUE(write_reply(rtu, rtu.wrap(*from_hex("01 10 00 64 00 01"))));
  EXPECT_THAT(write_reply(rtu, rtu.wrap(*from_hex("01 90 03"))).error().message,
              HasSubstr("Illegal Data Value"));
  EXPECT_FALSE(write_reply(ascii_framing(), to_bytes("noise")));
}

/// "M1-M2 ?" for what a message writes.
std::string written(std::string_view hex) {
  std::string text;
  for (const Framing* framing : {&rtu_framing(), &ascii_framing()}) {
    std::string one;
    for (const harness::Protocol::Written& range :
         written_by(*framing, default_bases(), framing->wrap(*from_hex(hex))))
      one += (one.empty() ? "" : " ") + (range.area == "?"
                                             ? "?"
                                             : range.area + std::to_string(range.first_word) + "-" +
                                                   std::to_string(range.last_word));
    if (framing == &rtu_framing()) text = one;
    EXPECT_EQ(text, one) << "RTU and ASCII";
  }
  return text;
}

TEST(WrittenBy, WordsOfTheDefaultBases) {
  EXPECT_EQ(written("01 03 00 64 00 01"), "");
  EXPECT_EQ(written("01 06 00 64 12 34"), "M100-100");
  EXPECT_EQ(written("01 10 00 64 00 02 04 12 34 56 78"), "M100-101");
  EXPECT_EQ(written("01 05 06 40 FF 00"), "M100-100");
  EXPECT_EQ(written("01 0F 06 4F 00 02 01 03"), "M100-101");
  EXPECT_EQ(written("00 06 00 64 12 34"), "M100-100") << "a broadcast";
}

TEST(WrittenBy, ADeviceMayBelieveCountOrByteCount) {
  EXPECT_EQ(written("01 10 00 64 00 01 04 12 34 56 78"), "M100-101");
  EXPECT_EQ(written("01 10 00 64 00 04 02 12 34"), "M100-103");
}

/// A device that keeps its bits in K from word 4 on, and its words in D from 1000 on.
const Bases& moved_bases() {
  static const Bases bases = *declared_bases(
      "xbc-h",
      {{"bit_write_base", "K0040"}, {"word_write_base", "D1000"}, {"word_read_base", "M0"}});
  return bases;
}

TEST(DeclaredBases, RequestsAndFenceFollowThem) {
  EXPECT_EQ(messages(write_requests(rtu_framing(), moved_bases(), 1, "%DW1002", "1234")),
            "01 10 00 02 00 01 02 12 34");
  EXPECT_EQ(messages(read_requests(rtu_framing(), moved_bases(), 1, "%KX00041", 2)),
            "01 01 00 01 00 01");
  EXPECT_THAT(messages(write_requests(rtu_framing(), moved_bases(), 1, "%MW1", "1234")),
              HasSubstr("read only"));
  EXPECT_THAT(messages(write_requests(rtu_framing(), moved_bases(), 1, "%DW999", "1234")),
              HasSubstr("outside the Modbus bases"));
  const Bases flags = *declared_bases("xbc-h", {{"word_write_base", "F100"}});
  EXPECT_THAT(messages(write_requests(rtu_framing(), flags, 1, "%FW100", "1234")),
              HasSubstr("%FW100 is read only over the protocol"));
  EXPECT_EQ(messages(read_requests(rtu_framing(), flags, 1, "%FW100", 4)), "01 03 00 00 00 01");
  const auto word =
      written_by(rtu_framing(), moved_bases(), rtu_framing().wrap(*from_hex("01 06 00 64 12 34")))
          .at(0);
  EXPECT_EQ(word.area + std::to_string(word.first_word), "D1100");
  const auto bit =
      written_by(rtu_framing(), moved_bases(), rtu_framing().wrap(*from_hex("01 05 00 10 FF 00")))
          .at(0);
  EXPECT_EQ(bit.area + std::to_string(bit.first_word), "K5");
}

TEST(DeclaredBases, MistakesAreNamed) {
  EXPECT_THAT(declared_bases("xbc-h", {{"bit_write_base", "Z0"}}).error().message,
              HasSubstr("bit_write_base"));
  EXPECT_THAT(declared_bases("xbc-j", {}).error().message, HasSubstr("xbc-j"));
  const auto xec = declared_bases("xec-h", nlohmann::json::object());
  ASSERT_TRUE(xec) << xec.error().message;
  EXPECT_EQ(messages(read_requests(rtu_framing(), *xec, 1, "%IW1", 4)), "01 04 00 01 00 01");
}

/// "%MW100:4"
std::string shown(const std::vector<harness::Protocol::Place>& all) {
  std::string text;
  for (const harness::Protocol::Place& one : all)
    text += (text.empty() ? "" : " ") + one.address + ":" + std::to_string(one.digits) +
            (one.declared ? "" : "?");
  return text;
}

TEST(Places, AreReachedByWordsElseByBits) {
  EXPECT_EQ(shown(places(default_bases(), {"M", 100, 101, ""})), "%MW100:8");
  EXPECT_EQ(shown(places(moved_bases(), {"K", 5, 5, ""})), "%KB10:4")
      << "the words of K have no data address there";
  EXPECT_EQ(shown(places(default_bases(), {"M", 1023, 1024, ""})), "%MW1023:4 %MW1024:4?");
}

TEST(AddressFields, OfRequestsAndOfRepliesThatRepeatThem) {
  for (const Framing* framing : {&rtu_framing(), &ascii_framing()}) {
    const Bytes frame = framing->wrap(*from_hex("01 10 00 64 00 02 04 12 34 56 78"));
    const auto fields = address_fields(*framing, default_bases(), frame, false);
    ASSERT_THAT(fields, SizeIs(1));
    EXPECT_EQ(fields[0].names.first_word, 100u);
    EXPECT_EQ(fields[0].names.last_word, 101u);
    Bytes moved = frame;
    std::ranges::copy(*moved_field(*framing, default_bases(), frame, fields[0], 20),
                      moved.begin() + static_cast<std::ptrdiff_t>(fields[0].offset));
    EXPECT_EQ(written_by(*framing, default_bases(), moved).at(0).first_word, 120u);
    EXPECT_THAT(
        address_fields(*framing, default_bases(), framing->wrap(*from_hex("01 03 02 12 34")), true),
        SizeIs(0));
    EXPECT_FALSE(moved_field(*framing, default_bases(), frame, fields[0], -101))
        << "there is no data address below 0";
  }
  const Bytes bit = rtu_framing().wrap(*from_hex("01 05 06 40 FF 00"));
  EXPECT_EQ(*moved_field(rtu_framing(), default_bases(), bit,
                         address_fields(rtu_framing(), default_bases(), bit, true).at(0), 4),
            *from_hex("06 80"));
}

TEST(AddressFields, AtTheEndOfATableCannotBeMoved) {
  const auto moved = [](std::string_view message) {
    const Bytes frame = rtu_framing().wrap(*from_hex(message));
    return moved_field(rtu_framing(), default_bases(), frame,
                       address_fields(rtu_framing(), default_bases(), frame, false).at(0), -600);
  };
  EXPECT_TRUE(moved("01 01 27 00 00 08"));
  EXPECT_FALSE(moved("01 01 27 0E 00 01")) << "9998, the last coil";
  EXPECT_FALSE(moved("01 01 27 08 00 08")) << "with it";
  EXPECT_FALSE(moved("01 05 27 10 FF 00")) << "past it";
}

TEST(WrittenBy, DamagedRequestsNameNoPlace) {
  EXPECT_EQ(written("01 10 00"), "?");
  EXPECT_EQ(written("01 16 00 04 00 F2 00 25"), "?")
      << "a function of the standard that the manual does not have";
  Bytes wrong = rtu_framing().wrap(*from_hex("01 06 00 64 12 34"));
  wrong.back() ^= 1;
  ASSERT_THAT(written_by(rtu_framing(), default_bases(), wrong), SizeIs(1));
  EXPECT_EQ(written_by(rtu_framing(), default_bases(), wrong)[0].first_word, 100u);
  EXPECT_THAT(written_by(ascii_framing(), default_bases(), to_bytes(":01060064123")), SizeIs(1))
      << "without its end";
}

}  // namespace
}  // namespace fieldproof::modbus_suite
