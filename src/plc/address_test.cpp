#include "src/plc/address.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

namespace fieldproof::plc {
namespace {

/// "M X 170", "T X contact 5", or the fault.
std::string parsed(std::string_view model_name, std::string_view name) {
  const PlcModel& model = *find_plc_model(model_name);
  const ParsedAddress p = parse_address(model, name);
  constexpr std::array faults{"none", "percent", "area", "type", "form", "range"};
  if (!p) return faults[static_cast<std::size_t>(p.fault)];
  return std::string{model.areas[p.address.area].letter, ' ', p.address.type, ' '} +
         (p.address.contact ? "contact " : "") + std::to_string(p.address.index);
}

TEST(DeviceAddress, ElementsOfXbc) {
  EXPECT_EQ(parsed("xbc-h", "%MW100"), "M W 100");
  EXPECT_EQ(parsed("xbc-h", "%MB200"), "M B 200");
  EXPECT_EQ(parsed("xbc-h", "%MD50"), "M D 50");
  EXPECT_EQ(parsed("xbc-h", "%ML25"), "M L 25");
  EXPECT_EQ(parsed("xbc-h", "%DB2468"), "D B 2468");
  EXPECT_EQ(parsed("xbc-h", "%DD0"), "D D 0");
  EXPECT_EQ(parsed("xbc-h", "%DL0"), "D L 0");
  EXPECT_EQ(parsed("xbc-h", "%TW7"), "T W 7");
}

TEST(DeviceAddress, BitNamesOfXbcEndInAHexBit) {
  EXPECT_EQ(parsed("xbc-h", "%MX0010A"), "M X 170");
  EXPECT_EQ(parsed("xbc-h", "%MX0010a"), "M X 170");
  EXPECT_EQ(parsed("xbc-h", "%MX5"), "M X 5");
  EXPECT_EQ(parsed("xbc-h", "%MXF"), "M X 15");
  EXPECT_EQ(parsed("xbc-h", "%MX1023F"), "M X 16383");
  EXPECT_EQ(parsed("xbc-h",
                   "%MX1024"
                   "0"),
            "range");
  EXPECT_EQ(parsed("xbc-h", "%MX0A0"), "range");  // the word is decimal
  EXPECT_EQ(parsed("xbc-h", "%UX343"),
            "U X 547");  // Cnet KO: U01.02.3 = (1 * 32 + 2) words and bit 3
  EXPECT_EQ(parsed("xbc-h", "%UX2334"), "U X 3732");  // Cnet KO: U07.09.4
  EXPECT_EQ(parsed("xbc-h", "%UW103"), "U W 103");    // Cnet KO: U03.07
}

TEST(DeviceAddress, ContactsGoByNumber) {
  EXPECT_EQ(parsed("xbc-h", "%TX0010"), "T X contact 10");
  EXPECT_EQ(parsed("xbc-h", "%CX1023"), "C X contact 1023");
  EXPECT_EQ(parsed("xbc-h", "%CX1024"), "range");
  EXPECT_EQ(parsed("xbc-h", "%TX1A"), "range");
  EXPECT_EQ(parsed("xbm-s", "%TX255"), "T X contact 255");
  EXPECT_EQ(parsed("xbm-s", "%TX256"), "range");
}

TEST(DeviceAddress, BitNamesOfXecAreFlat) {
  EXPECT_EQ(parsed("xec-h", "%LX8192"), "L X 8192");  // App. 2.1: L512 bit 0
  EXPECT_EQ(parsed("xec-h", "%MX170"), "M X 170");
  EXPECT_EQ(parsed("xec-h", "%MX131071"), "M X 131071");
  EXPECT_EQ(parsed("xec-h", "%MX131072"), "range");
  EXPECT_EQ(parsed("xec-h", "%MX1A"), "range");
}

TEST(DeviceAddress, DottedNamesOfXec) {
  EXPECT_EQ(parsed("xec-h", "%IW0.0.0"), "I W 0");
  EXPECT_EQ(parsed("xec-h", "%IW15.15.3"), "I W 1023");
  EXPECT_EQ(parsed("xec-h", "%QW1.2.3"), "Q W 75");
  EXPECT_EQ(parsed("xec-h", "%IX0.0.5"), "I X 5");
  EXPECT_EQ(parsed("xec-h", "%IX0.1.63"), "I X 127");
  EXPECT_EQ(parsed("xec-h", "%IX0.1.64"), "range");
  EXPECT_EQ(parsed("xec-h", "%IB0.1.7"), "I B 15");
  EXPECT_EQ(parsed("xec-h", "%IB0.1.8"), "range");
  EXPECT_EQ(parsed("xec-h", "%QD0.1.1"), "Q D 3");
  EXPECT_EQ(parsed("xec-h", "%QD0.1.2"), "range");
  EXPECT_EQ(parsed("xec-h", "%QL0.1.0"), "Q L 1");
  EXPECT_EQ(parsed("xec-h", "%QL0.1.1"), "range");
  EXPECT_EQ(parsed("xec-h", "%IW0.0.4"), "range");
  EXPECT_EQ(parsed("xec-h", "%IW0.16.0"), "range");
  EXPECT_EQ(parsed("xec-h", "%IW16.0.0"), "range");
  EXPECT_EQ(parsed("xec-h", "%UW0.15.31"), "U W 511");
  EXPECT_EQ(parsed("xec-h", "%UX0.1.511"), "U X 1023");
  EXPECT_EQ(parsed("xec-h", "%UW1.0.0"), "range");
  EXPECT_EQ(parsed("xec-h", "%UW0.0.32"), "range");
  EXPECT_EQ(parsed("xec-h", "%IW00.00.01"), "I W 1");
  EXPECT_EQ(parsed("xec-h", "%IW5"), "I W 5");
  EXPECT_EQ(parsed("xec-h", "%IW0.A.0"), "range");
}

TEST(DeviceAddress, DotsElsewhereAreNoForm) {
  for (const char* name : {"%MW0.0.0", "%LX1.2", "%IW0.0", "%IW0.0.0.0", "%IW..", "%IW0..0",
                           "%IW.0.0", "%IW0.0.", "%IW0.^.0"}) {
    EXPECT_EQ(parsed("xec-h", name), "form") << name;
  }
  EXPECT_EQ(parsed("xbc-h", "%UX00.00.0"), "form");
  EXPECT_EQ(parsed("xbc-h", "%UW00.00"), "form");
  EXPECT_EQ(parsed("xbc-h", "%PX.1"), "form");
}

TEST(DeviceAddress, StagesInOrder) {
  EXPECT_EQ(parsed("xbc-h", ""), "percent");
  EXPECT_EQ(parsed("xbc-h", "MW10"), "percent");
  EXPECT_EQ(parsed("xbc-h", "$ZZ?"), "percent");
  EXPECT_EQ(parsed("xbc-h", "%"), "area");
  EXPECT_EQ(parsed("xbc-h", "%ZQ?"), "area");
  EXPECT_EQ(parsed("xbc-h", "%IW0"), "area");
  EXPECT_EQ(parsed("xec-h", "%DW0"), "area");
  EXPECT_EQ(parsed("xec-h", "%TW0"), "area");
  EXPECT_EQ(parsed("xbm-s", "%RW0"), "area");
  EXPECT_EQ(parsed("xbc-h", "%M"), "type");
  EXPECT_EQ(parsed("xbc-h", "%MK10"), "type");
  EXPECT_EQ(parsed("xbc-h", "%DX0?"), "type");
  EXPECT_EQ(parsed("xbc-h", "%MW"), "form");
  EXPECT_EQ(parsed("xbc-h", "%MX"), "form");
  EXPECT_EQ(parsed("xbc-h", "%MW^&"), "form");
  EXPECT_EQ(parsed("xbc-h", "%MWF^"), "form");
  EXPECT_EQ(parsed("xbc-h", "%MX^0"), "form");
  EXPECT_EQ(parsed("xbc-h", "%MX0^"), "form");
  EXPECT_EQ(parsed("xbc-h", "%MW-1"), "form");
  EXPECT_EQ(parsed("xbc-h", "%MW 1"), "form");
  EXPECT_EQ(parsed("xbc-h", std::string_view("%MW1\0", 5)), "form");
  EXPECT_EQ(parsed("xbc-h", "%MWFFFFF"), "range");  // Appendix 3.1
  EXPECT_EQ(parsed("xbc-h", "%MW00A"), "range");
  EXPECT_EQ(parsed("xbc-h", "%MW4294967296"), "range");
  EXPECT_EQ(parsed("xbc-h", "%MW9999999999999"), "range");
  EXPECT_EQ(parsed("xbc-h", "%MX999999999999F"), "range");
}

TEST(DeviceAddress, LeadingZerosAndLetterCase) {
  EXPECT_EQ(parsed("xbc-h", "%MW0000000000100"), "M W 100");
  EXPECT_EQ(parsed("xbc-h", "%mw100"), "M W 100");
  EXPECT_EQ(parsed("xec-h", "%iw0.0.1"), "I W 1");
}

TEST(DeviceAddress, FirstLastAndFirstInvalidOfEveryAreaAndType) {
  for (const PlcModel& model : plc_models()) {
    for (const DeviceArea& area : model.areas) {
      for (const char type : {'B', 'W', 'D', 'L'}) {
        const std::string prefix{'%', area.letter, type};
        const std::uint32_t elements = area.words * 2 / type_bytes(type);
        EXPECT_TRUE(parse_address(model, prefix + '0')) << prefix;
        EXPECT_TRUE(parse_address(model, prefix + std::to_string(elements - 1))) << prefix;
        EXPECT_EQ(parse_address(model, prefix + std::to_string(elements)).fault,
                  AddressFault::range)
            << prefix;
      }
    }
  }
}

TEST(DeviceAddress, Fits) {
  const PlcModel& model = *find_plc_model("xbm-s");
  const DeviceAddress last = parse_address(model, "%PW127").address;
  EXPECT_TRUE(fits(model, last, 1));
  EXPECT_FALSE(fits(model, last, 2));
  EXPECT_TRUE(fits(model, last + 1, 0));
  EXPECT_FALSE(fits(model, last + 2, 0));
  EXPECT_FALSE(fits(model, last, 0xFFFFFFFF));
  EXPECT_FALSE(fits(model, {200, 'W', false, 0}));
}

TEST(DeviceAddress, AnyBytesAreANameOrAFault) {
  std::mt19937 random(4711);
  constexpr std::string_view likely = "%PMKFTCLNDURIQWXBWDL0123456789AF.a^";
  int right = 0;
  for (int i = 0; i < 200'000; ++i) {
    std::string name(random() % 12, '\0');
    for (char& c : name)
      c = random() % 8 == 0 ? static_cast<char>(random()) : likely[random() % likely.size()];
    if (random() % 2)
      name = std::string{'%', "PMKFTCLNDURIQW"[random() % 14], "XBWDL"[random() % 5]} +
             name.substr(0, random() % 5);
    for (const PlcModel& model : plc_models()) {
      const ParsedAddress p = parse_address(model, name);
      if (!p) continue;
      ++right;
      EXPECT_TRUE(fits(model, p.address)) << name;
    }
  }
  EXPECT_GT(right, 1000);
}

}  // namespace
}  // namespace fieldproof::plc
