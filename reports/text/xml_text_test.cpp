#include "reports/text/xml_text.hpp"

#include <gtest/gtest.h>

#include <pugixml.hpp>

#include "src/base/bytes.hpp"

namespace fieldproof::text {
namespace {

TEST(XmlText, EachOfTheBytes) {
  for (unsigned value = 0; value < 256; ++value) {
    const std::string byte(1, static_cast<char>(value));
    const bool kept = value == '\n' || value == '\t' || (value >= 0x20 && value <= 0x7E);
    EXPECT_EQ(kept ? byte : "[" + hex_number(value, 2) + "]", xml_text(byte)) << value;
    EXPECT_EQ(kept && value >= 0x20 ? byte : "[" + hex_number(value, 2) + "]", xml_line(byte))
        << value;
  }
}

TEST(XmlText, AFrameReadsAsOne) {
  EXPECT_EQ("[05]00RSS0106%MW100[04]", xml_text("\x05"
                                                "00RSS0106%MW100"
                                                "\x04"));
}

TEST(XmlText, CarriageReturnIsDataNotALineBreak) { EXPECT_EQ("a[0D]\nb", xml_text("a\r\nb")); }

TEST(XmlText, Utf8IsKept) {
  for (const char* text :
       {"국번 \xC2\xB5s \xE2\x89\xA4", "\xF0\x9F\x98\x80", "\xED\x9F\xBF\xEE\x80\x80",
        "\xF4\x8F\xBF\xBD", "\xC2\xA0", "\xEF\xBF\xBD"}) {
    EXPECT_EQ(text, xml_text(text));
  }
}

TEST(XmlText, BrokenUtf8IsShownByteByByte) {
  EXPECT_EQ("[80]", xml_text("\x80"));
  EXPECT_EQ("a[C3]", xml_text("a\xC3")) << "cut off at the end";
  EXPECT_EQ("[E2][89]x", xml_text("\xE2\x89x")) << "cut off in the middle";
  EXPECT_EQ("[C3]\xC3\xA9", xml_text("\xC3\xC3\xA9")) << "the next character survives";
  EXPECT_EQ("[C0][AF]", xml_text("\xC0\xAF")) << "overlong";
  EXPECT_EQ("[E0][80][AF]", xml_text("\xE0\x80\xAF")) << "overlong";
  EXPECT_EQ("[F0][80][80][AF]", xml_text("\xF0\x80\x80\xAF")) << "overlong";
  EXPECT_EQ("[ED][A0][80]", xml_text("\xED\xA0\x80")) << "surrogate";
  EXPECT_EQ("[F4][90][80][80]", xml_text("\xF4\x90\x80\x80")) << "above U+10FFFF";
  EXPECT_EQ("[F8][88][80][80][80]", xml_text("\xF8\x88\x80\x80\x80")) << "five bytes";
}

TEST(XmlText, CharactersThatXmlForbidsAreShown) {
  EXPECT_EQ("[EF][BF][BE]", xml_text("\xEF\xBF\xBE"));
  EXPECT_EQ("[EF][BF][BF]", xml_text("\xEF\xBF\xBF"));
  EXPECT_EQ("[C2][85]", xml_text("\xC2\x85"));
}

TEST(XmlText, PairsOfBytesSurviveXml) {
  for (unsigned first = 0; first < 256; ++first) {
    pugi::xml_document document;
    std::string all;
    for (unsigned second = 0; second < 256; ++second) {
      all += static_cast<char>(first);
      all += static_cast<char>(second);
      all += '|';
    }
    const std::string text = xml_text(all);
    document.append_child("a").text().set(text.c_str());
    std::ostringstream out;
    document.save(out, "", pugi::format_raw);
    pugi::xml_document again;
    ASSERT_TRUE(again.load_string(out.str().c_str())) << first;
    EXPECT_EQ(text, again.child("a").text().get()) << first;
  }
}

}  // namespace
}  // namespace fieldproof::text
