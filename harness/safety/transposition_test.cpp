#include "harness/safety/transposition.hpp"

#include <gmock/gmock.h>

#include "harness/vectors/loader.hpp"
#include "suites/ls_bus/protocol.hpp"
#include "suites/modbus/protocol.hpp"
#include "suites/xgt_cnet/protocol.hpp"

namespace fieldproof::safety {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Moves one vector of the protocol into the fence, and prints what became of it.
class Transposed {
 public:
  Transposed(const harness::Protocol& protocol, const std::string& allowed,
             const std::string& memory, const std::string& steps, const std::string& more = "") {
    const std::string folder = protocol.name() == "xgt-cnet" ? "xgt_cnet"
                               : protocol.name() == "ls-bus" ? "ls_bus"
                                                             : "modbus_rtu";
    vectors::load_vector_text(
        R"j({"id": ")j" + folder +
            R"j(/a/b", "rev": 1, "title": "what is tested", "level": "must", "basis": "printed rule", )j" +
            more + (memory.empty() ? "" : R"j("given": {"memory": {)j" + memory + "}}, ") +
            R"j("statement": "m/1", "source": {"manual": "m", "section": "1", "quote": "as printed"}, "steps": [)j" +
            steps + "]}",
        "f.json", set_);
    EXPECT_THAT(set_.problems, IsEmpty());
    WriteFence fence;
    const auto words = [&](std::string_view name) { return protocol.read_word(name); };
    EXPECT_TRUE(fence.allow(allowed, words));
    const nlohmann::json declared = protocol.name() == "ls-bus"
                                        ? nlohmann::json{{"write_order", "address_first"}}
                                        : nlohmann::json::object();
    const auto configured = protocol.configured(protocol.models().front(), declared);
    const Result<std::vector<results::Move>> moves =
        plan_moves(set_.cases.at(0), 1, fence, **configured);
    if (!moves) {
      text = moves.error().message;
      return;
    }
    const Result<vectors::Case> moved = moved_case(set_.cases.at(0), 1, *moves, **configured);
    EXPECT_TRUE(moved) << moved.error().message;
    if (!moved) return;
    for (const results::Move& move : *moves) notes += note_of(move, **configured) + ";";
    for (const auto& [address, hex] : moved->memory) text += address + " ";
    for (const vectors::Step& step : moved->steps) {
      for (const auto& [address, hex] : step.memory) text += address + " ";
      for (const vectors::Frame& frame : step.frames) text += notation::print(frame.notation) + " ";
    }
  }

  std::string text, notes;

 private:
  vectors::VectorSet set_;
};

std::string moved(const std::string& allowed, const std::string& memory, const std::string& steps,
                  const std::string& more = "") {
  return Transposed(xgt_cnet_suite::protocol(), allowed, memory, steps, more).text;
}

const std::string write_100 =
    R"({"send": "[ENQ st 'wSS' '01' name(%MW100) '5E6F' EOT BCC]"}, {"check": {"%MW100": "5E6F", "%MW101": "4C5E"}})";
const std::string around_100 = R"("%MW99": "1B2D", "%MW101": "4C5E")";

TEST(Transposition, WhatMayBeWrittenWhereItIsStays) {
  const Transposed stays(xgt_cnet_suite::protocol(), "M99-M101", around_100, write_100);
  EXPECT_EQ(stays.notes, "");
  EXPECT_THAT(stays.text, HasSubstr("name(%MW100)"));
}

TEST(Transposition, AddressesAreReplacedThroughout) {
  const Transposed one(xgt_cnet_suite::protocol(), "M120-M139", R"("%MW101": "4C5E")", write_100);
  EXPECT_EQ(one.text, "%MW121 [ENQ st 'wSS' '01' name(%MW120) '5E6F' EOT BCC] %MW120 %MW121 ");
  EXPECT_EQ(one.notes, "transposed: %MW100-%MW101 to %MW120-%MW121;");
}

TEST(Transposition, PlacesInDoubleWordsBytesAndBitsStay) {
  EXPECT_EQ(
      moved(
          "M122-M139",
          R"("%MW098": "0001", "%MX0099A": "01", "%MB200": "12", "%MD50": "12345678", "%ML25": "123456789ABCDEF0")",
          R"({"send": "[ENQ st 'rSS' '01' name(%MD50) EOT BCC]"})"),
      "%MW122 %MX0123A %MB248 %MD62 %ML31 [ENQ st 'rSS' '01' name(%MD62) EOT BCC] ");
}

TEST(Transposition, RunsThatAreApartStayApartAndInOrder) {
  EXPECT_EQ(moved("M200-M211", R"("%MW100": "12345678", "%MW900": "0001")", write_100),
            "%MW200 %MW204 [ENQ st 'wSS' '01' name(%MW200) '5E6F' EOT BCC] %MW200 %MW201 ");
}

TEST(Transposition, OnlyTheAreaThatMustMoves) {
  EXPECT_EQ(
      moved("M120-M139,P", R"("%PW001": "5678")",
            R"({"send": "[ENQ st 'wSS' '02' name(%MW100) '0001' name(%PW001) '0002' EOT BCC]"})"),
      "%PW001 [ENQ st 'wSS' '02' name(%MW120) '0001' name(%PW001) '0002' EOT BCC] ");
}

TEST(Transposition, NamesInHexAreNamesToo) {
  EXPECT_THAT(moved("M120-M139", R"("%MW100": "3A7C")",
                    R"({"send": "[ENQ st 'rSS' '01' '06' 25 4D 57 31 30 30 EOT BCC]"})"),
              HasSubstr("'06' '%' 'M' 'W' '1' '2' '0' EOT"));
}

TEST(Transposition, ReadsAloneStay) {
  EXPECT_THAT(moved("M120-M139", "", R"({"send": "[ENQ st 'rSS' '01' name(%MW100) EOT BCC]"})"),
              HasSubstr("name(%MW100)"));
}

TEST(Transposition, WhatCannotBeMovedSaysWhy) {
  EXPECT_THAT(moved("D0", around_100, write_100),
              testing::EndsWith("allow it with --allow-write M99"));
  EXPECT_THAT(moved("M120-M121", around_100, write_100),
              HasSubstr("M120-M121 has no room, with as many digits, for M99-M101"));
  EXPECT_THAT(moved("M100-M199", R"("%MW1023": "4C5E")", write_100),
              HasSubstr("it is about the end of M"));
  EXPECT_THAT(
      moved("M100-M199", "", R"({"send": "[ENQ st 'wSS' '01' name(%MW0) '5E6F' EOT BCC]"})"),
      HasSubstr("it is about the beginning of M"));
  EXPECT_THAT(moved("M1000-M1010", R"("%MW100": "3A7C")", write_100),
              HasSubstr("has no room, with as many digits"));
  EXPECT_THAT(moved("M120-M139", R"("%MW100": "3A7C")",
                    R"({"send": "[ENQ st 'qSS' '01' '%MW100' EOT BCC]"})"),
              HasSubstr("%MW100 stands in its frame where it is no address"));
}

TEST(Transposition, TheFlagOfAVectorStays) {
  EXPECT_THAT(moved("M120-M139", "", write_100, R"("transpose": false, )"),
              HasSubstr("name(%MW100)"));
}

TEST(Transposition, ModbusFramesMoveByTheirDataAddress) {
  const Transposed words(
      modbus_suite::rtu(), "M120-M139", R"("%MW100": "1111")",
      R"({"send": "[st 10 00 64 00 01 02 12 34 CRC]"}, {"expect": "[st 10 00 64 00 01 CRC]"})");
  EXPECT_EQ(words.text, "%MW120 [st 10 00 'x' 00 01 02 12 34 CRC] [st 10 00 'x' 00 01 CRC] ");
  const Transposed bits(
      modbus_suite::rtu(), "M120-M139", R"("%MX00640": "01")",
      R"({"send": "[st 05 04 00 FF 00 CRC]"}, {"expect": "[st 05 04 00 FF 00 CRC]"})");
  EXPECT_EQ(bits.text, "%MX01200 [st 05 07 80 FF 00 CRC] [st 05 07 80 FF 00 CRC] ");
}

TEST(Transposition, ParametersMoveByTheirAddress) {
  const Transposed one(ls_bus_suite::protocol(), "h1240-h124F", R"("1230": "1A2B")",
                       R"({"send": "[ENQ st 'R' '1230' '1' SUM EOT]"})");
  EXPECT_EQ(one.text, "1240 [ENQ st 'R' '1240' '1' SUM EOT] ");
  EXPECT_EQ(one.notes, "transposed: 1230 to 1240;");
}

}  // namespace
}  // namespace fieldproof::safety
