// XML with a line for each element, indented by its depth. Well-formed as long as what is opened is
// closed.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace fieldproof::text {

class XmlWriter {
 public:
  /// Values are any bytes, shown as one line (xml_line). One without a name is left out.
  using Attributes = std::initializer_list<std::pair<std::string_view, std::string_view>>;

  /// Appends to `out`, which outlives it.
  explicit XmlWriter(std::string& out) : out_(out) {}

  void open(std::string_view tag, Attributes attributes);
  void close(std::string_view tag);
  /// An element without others in it; `text` is any bytes (xml_text).
  void leaf(std::string_view tag, Attributes attributes, std::string_view text = {});

  /// Elements that are open around the next one.
  unsigned depth = 0;

 private:
  void start(std::string_view tag, Attributes attributes);

  std::string& out_;
};

}  // namespace fieldproof::text
