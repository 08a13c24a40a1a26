#include "reports/text/xml_writer.hpp"

#include "reports/text/xml_text.hpp"

namespace fieldproof::text {

void XmlWriter::start(std::string_view tag, Attributes attributes) {
  out_.append(2 * depth, ' ');
  out_ += '<';
  out_ += tag;
  for (const auto& [name, value] : attributes) {
    if (name.empty()) continue;
    out_ += ' ';
    out_ += name;
    out_ += "=\"";
    append_value(out_, xml_line(value));
    out_ += '"';
  }
}

void XmlWriter::open(std::string_view tag, Attributes attributes) {
  start(tag, attributes);
  out_ += ">\n";
  ++depth;
}

void XmlWriter::close(std::string_view tag) {
  --depth;
  out_.append(2 * depth, ' ');
  out_ += "</";
  out_ += tag;
  out_ += ">\n";
}

void XmlWriter::leaf(std::string_view tag, Attributes attributes, std::string_view text) {
  start(tag, attributes);
  if (text.empty()) {
    out_ += " />\n";
    return;
  }
  out_ += '>';
  append_content(out_, xml_text(text));
  out_ += "</";
  out_ += tag;
  out_ += ">\n";
}

}  // namespace fieldproof::text
