#include "reports/html/html_writer.hpp"

#include "reports/text/xml_text.hpp"

namespace fieldproof::html {
namespace {

void append_escaped(std::string& html, std::string_view clean) {
  for (const char c : clean) {
    switch (c) {
      case '&': html += "&amp;"; break;
      case '<': html += "&lt;"; break;
      case '>': html += "&gt;"; break;
      case '"': html += "&quot;"; break;
      default: html += c;
    }
  }
}

}  // namespace

void HtmlWriter::start(std::string_view tag, Attributes attributes) {
  html_ += '<';
  html_ += tag;
  for (const auto& [name, value] : attributes) {
    html_ += ' ';
    html_ += name;
    html_ += "=\"";
    text(value);
    html_ += '"';
  }
}

void HtmlWriter::open(std::string_view tag, Attributes attributes) {
  start(tag, attributes);
  html_ += '>';
}

void HtmlWriter::close(std::string_view tag) {
  html_ += "</";
  html_ += tag;
  html_ += '>';
}

void HtmlWriter::empty(std::string_view tag, Attributes attributes) {
  start(tag, attributes);
  html_ += "/>";
}

void HtmlWriter::text(std::string_view bytes) { append_escaped(html_, text::xml_line(bytes)); }
void HtmlWriter::lines(std::string_view bytes) { append_escaped(html_, text::xml_text(bytes)); }

}  // namespace fieldproof::html
