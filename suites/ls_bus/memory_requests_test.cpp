#include "suites/ls_bus/memory_requests.hpp"

#include <gmock/gmock.h>

namespace fieldproof::ls_bus_suite {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Bytes reply(char header, std::string_view body) {
  Bytes frame = request(body);
  frame[0] = static_cast<Byte>(header);
  return frame;
}

/// "H 4656-4657 1230", one an entry.
std::vector<std::string> shown(const std::vector<harness::Protocol::Written>& written) {
  std::vector<std::string> texts;
  for (const harness::Protocol::Written& one : written)
    texts.push_back(one.area + ' ' + std::to_string(one.first_word) + '-' +
                    std::to_string(one.last_word) + ' ' + one.address);
  return texts;
}

TEST(LsMemoryRequests, AreTheManualsFrames) {
  EXPECT_EQ(to_hex(read_requests("01", "1230", 4)->front()), "05 30 31 52 31 32 33 30 31 41 41 04");
  EXPECT_EQ(to_hex(write_requests("01", "h1230", "00FF")->front()),
            "05 30 31 57 31 32 33 30 31 30 30 46 46 39 42 04");
}

TEST(LsMemoryRequests, CarryAtMostEightWords) {
  const std::string seventeen =
      "11111111111111111111111111111111"
      "22222222222222222222222222222222"
      "3333";
  EXPECT_THAT(
      *write_requests("0A", "12F0", seventeen),
      ElementsAre(request("0AW12F0811111111111111111111111111111111"),
                  request("0AW12F8822222222222222222222222222222222"), request("0AW130013333")));
  EXPECT_THAT(*read_requests("0A", "0FFC", 36),
              ElementsAre(request("0AR0FFC8"), request("0AR10041")));
}

TEST(LsMemoryRequests, SayWhyThereIsNone) {
  EXPECT_THAT(read_requests("01", "%MW100", 4).error().message, HasSubstr("four hex digits"));
  EXPECT_THAT(read_requests("01", "@errors", 4).error().message, HasSubstr("counter"));
  EXPECT_THAT(read_requests("01", "1230", 6).error().message, HasSubstr("whole number of words"));
  EXPECT_THAT(write_requests("01", "1230", "").error().message, HasSubstr("whole number of words"));
  EXPECT_THAT(write_requests("01", "FFFF", "00010002").error().message, HasSubstr("beyond FFFF"));
}

TEST(LsMemoryRequests, WriteNothingThatIsReadOnly) {
  EXPECT_THAT(write_requests("01", "0003", "0001").error().message,
              HasSubstr("0000 to 0003 are read only"));
  EXPECT_THAT(write_requests("01", "0004", "000100020003000400050006").error().message,
              HasSubstr("0009 to 000F are read only"));
  EXPECT_THAT(write_requests("01", "000F", "00010002").error().message, HasSubstr("read only"));
  EXPECT_TRUE(write_requests("01", "0004", "00010002000300040005"));
  EXPECT_TRUE(write_requests("01", "0010", "0001"));
}

TEST(LsMemoryRequests, ReadReplies) {
  EXPECT_EQ(*read_reply(reply('\x06', "01R123456789ABC")), "123456789ABC");
  EXPECT_EQ(*read_reply(to_bytes("\x06"
                                 "01R12347D\x04\x06"
                                 "01R12347D\x04")),
            "1234")
      << "a second reply is none of it";
  EXPECT_TRUE(write_reply(reply('\x06', "01W1234")));
  EXPECT_THAT(read_reply(reply('\x15', "01RIA")).error().message,
              HasSubstr("NAK IA no such address"));
  EXPECT_THAT(write_reply(reply('\x15', "01WWM")).error().message,
              HasSubstr("NAK WM not writable"));
  EXPECT_THAT(write_reply({}).error().message, HasSubstr("no answer"));
  EXPECT_THAT(read_reply(reply('\x06', "01R")).error().message, HasSubstr("no data"));
  EXPECT_THAT(read_reply(to_bytes("?")).error().message, HasSubstr("neither ACK nor NAK"));
}

TEST(LsWrittenBy, NamesTheParametersOfAWrite) {
  EXPECT_THAT(shown(written_by(request("01W1230200FF1234"))), ElementsAre("H 4656-4657 1230"));
  EXPECT_THAT(shown(written_by(request("01w1230200FF1234"))), ElementsAre("H 4656-4657 1230"));
  EXPECT_THAT(written_by(request("01R12302")), IsEmpty());
  EXPECT_THAT(written_by(reply('\x06', "01W1234")), IsEmpty());
}

TEST(LsWrittenBy, WhatCanBeReadInBothOrdersCountsInBoth) {
  EXPECT_THAT(shown(written_by(request("01W1230100FF"))),
              ElementsAre("H 4656-4656 1230", "H 8961-8961 2301 (read count first)"));
  EXPECT_THAT(shown(written_by(request("01W2123000FF1234"))),
              ElementsAre("H 8483-8484 2123", "H 4656-4657 1230 (read count first)"));
}

TEST(LsWrittenBy, ADamagedWriteIsReadInBothOrders) {
  EXPECT_THAT(shown(written_by(request("01W1230200FF"))),
              ElementsAre("H 4656-4657 1230", "H 8962-8962 2302 (read count first)"));
  EXPECT_THAT(shown(written_by(request("01W123030"))),
              ElementsAre("H 4656-4658 1230", "H 8963-8963 2303 (read count first)"));
  EXPECT_THAT(shown(written_by(request("01W12300"))), ElementsAre("H 4656-4656 1230"))
      << "no data: at most one word";
}

TEST(LsWrittenBy, WithoutAnAddressItCouldWriteAnywhere) {
  EXPECT_THAT(shown(written_by(request("01W12G0100FF"))), ElementsAre(HasSubstr("? 0-")));
  EXPECT_THAT(shown(written_by(to_bytes("\x05"
                                        "01W"))),
              ElementsAre(HasSubstr("? 0-")));
}

TEST(WriteRequests, GoOutInTheDeclaredOrder) {
  EXPECT_EQ(write_requests("01", "1230", "00FF", true)->front(), request("01W1123000FF"));
}

TEST(WrittenBy, ADeclaredOrderIsTheOnlyReading) {
  EXPECT_THAT(shown(written_by(request("01W1230100FF"), false)), ElementsAre("H 4656-4656 1230"));
  EXPECT_THAT(shown(written_by(request("01W1123000FF"), true)), ElementsAre("H 4656-4656 1230"));
}

TEST(Places, LeaveOutWhatIsReadOnly) {
  std::string text;
  for (const harness::Protocol::Place& one : places({"H", 0x0002, 0x0011, ""}))
    text += one.address + ":" + std::to_string(one.digits) + (one.declared ? " " : "? ");
  EXPECT_EQ(text, "0004:20 0010:8 ");
  EXPECT_FALSE(places({"H", 0x1000, 0x1000, ""}).at(0).declared);
}

TEST(Addresses, MoveByWords) {
  EXPECT_EQ(moved("1230", 4), "1234");
  EXPECT_EQ(moved("h12FF", 1), "h1300");
  EXPECT_FALSE(moved("0001", -2));
  EXPECT_FALSE(moved("12G0", 1));
  EXPECT_EQ(named("1230", 8)->last_word, 0x1231u);
}

TEST(Addresses, StandInRequests) {
  const auto at = [](const Bytes& frame, bool count_first) {
    const auto fields = address_fields(frame, count_first);
    return fields.empty() ? std::string("none")
                          : std::to_string(fields[0].offset) + " " + fields[0].names.address;
  };
  EXPECT_EQ(at(request("01R12302"), false), "4 1230");
  EXPECT_EQ(at(request("01W1230100FF"), false), "4 1230");
  EXPECT_EQ(at(request("01W1123000FF"), true), "5 1230");
  EXPECT_EQ(at(request("01W12G0100FF"), false), "none");
}

}  // namespace
}  // namespace fieldproof::ls_bus_suite
