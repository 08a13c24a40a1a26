#include "reports/html/html_writer.hpp"

#include <gmock/gmock.h>

#include "reports/testdata/parsed_html.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::html {
namespace {

TEST(HtmlWriter, ElementsNestAndClose) {
  HtmlWriter out;
  out.element("table", {{"class", "a b"}}, [&] {
    out.element("tr", {}, [&] {
      out.element("td", {}, "one");
      out.empty("br");
    });
  });
  EXPECT_EQ("<table class=\"a b\"><tr><td>one</td><br/></tr></table>", out.str());
}

TEST(HtmlWriter, AnEmptyElementIsClosedAsBrowsersWantIt) {
  HtmlWriter out;
  out.element("td", {}, "");
  EXPECT_EQ("<td></td>", out.str());
}

TEST(HtmlWriter, TextAndAttributesAreEscaped) {
  HtmlWriter out;
  out.element("p", {{"title", "a\"b<c>&\n"}}, "</p><script>alert('1')</script>&amp;");
  EXPECT_EQ(
      "<p "
      "title=\"a&quot;b&lt;c&gt;&amp;[0A]\">&lt;/p&gt;&lt;script&gt;alert('1')&lt;/"
      "script&gt;&amp;amp;</p>",
      out.str());
}

TEST(HtmlWriter, LinesKeepTheirBreaks) {
  HtmlWriter out;
  out.lines("a\n<b>\x05");
  EXPECT_EQ("a\n&lt;b&gt;[05]", out.str());
}

TEST(HtmlWriter, AnyBytesComeBackFromAParser) {
  std::string bytes;
  for (int first = 0; first < 256; ++first) {
    for (const char* after : {"", "a", "\x80", "<", "&"})
      bytes += static_cast<char>(first) + std::string(after);
  }
  HtmlWriter out;
  out.element("html", {{"title", bytes}}, bytes);
  const samples::ParsedHtml page(out.str());
  EXPECT_EQ(text::xml_line(bytes), page.text("/html"));
}

}  // namespace
}  // namespace fieldproof::html
