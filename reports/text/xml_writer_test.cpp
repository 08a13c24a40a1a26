#include "reports/text/xml_writer.hpp"

#include <gmock/gmock.h>

#include <pugixml.hpp>

namespace fieldproof::text {
namespace {

TEST(XmlWriter, WritesALineForEachElement) {
  std::string out;
  XmlWriter xml(out);
  xml.open("suite", {{"name", "a"}, {"", "left out"}});
  xml.leaf("case", {{"n", "1"}});
  xml.leaf("said", {}, "first\nsecond");
  xml.close("suite");
  EXPECT_EQ("<suite name=\"a\">\n  <case n=\"1\" />\n  <said>first\nsecond</said>\n</suite>\n",
            out);
}

TEST(XmlWriter, AnyBytesAreReadAgainAsTheyAreShown) {
  std::string bytes;
  for (int b = 0; b < 256; ++b) bytes += static_cast<char>(b);
  bytes += "]]> &amp; <a b=\"c\"/> '";
  std::string out;
  XmlWriter(out).leaf("a", {{"b", bytes}}, bytes);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(out.c_str())) << out;
  const std::string value = document.child("a").attribute("b").value();
  EXPECT_THAT(value, testing::EndsWith("]]> &amp; <a b=\"c\"/> '"));
  EXPECT_THAT(value, testing::HasSubstr("[09][0A]"));
  EXPECT_THAT(value, testing::HasSubstr("[FE][FF]"));
  EXPECT_THAT(document.child("a").text().get(), testing::HasSubstr("\t\n[0B]"));
}

}  // namespace
}  // namespace fieldproof::text
