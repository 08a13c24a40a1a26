#include "reports/html/html_writer.hpp"

#include "reports/text/xml_text.hpp"

namespace fieldproof::html {

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

void HtmlWriter::text(std::string_view bytes) { text::append_value(html_, text::xml_line(bytes)); }
void HtmlWriter::lines(std::string_view bytes) { text::append_value(html_, text::xml_text(bytes)); }

}  // namespace fieldproof::html
