// A report read back by an XML parser, as a test sees it.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace fieldproof::samples {

class ParsedHtml {
 public:
  explicit ParsedHtml(const std::string& html) {
    const pugi::xml_parse_result parsed = document_.load_buffer(
        html.data(), html.size(), pugi::parse_default | pugi::parse_ws_pcdata);
    EXPECT_TRUE(parsed) << parsed.description() << " at " << parsed.offset << ": "
                        << html.substr(static_cast<std::size_t>(parsed.offset), 80);
  }

  /// All text below the first node of an XPath; "" where there is none.
  std::string text(const std::string& path) const {
    return text_of(document_.select_node(path.c_str()).node());
  }
  std::vector<std::string> texts(const std::string& path) const {
    std::vector<std::string> all;
    for (const pugi::xpath_node& node : document_.select_nodes(path.c_str()))
      all.push_back(text_of(node.node()));
    return all;
  }
  /// An attribute of each.
  std::vector<double> numbers(const std::string& path, const char* attribute) const {
    std::vector<double> all;
    for (const pugi::xpath_node& one : document_.select_nodes(path.c_str()))
      all.push_back(one.node().attribute(attribute).as_double());
    return all;
  }
  std::size_t count(const std::string& path) const {
    return document_.select_nodes(path.c_str()).size();
  }

  /// What the tile of a verdict says; 0 without a tile.
  std::size_t tile(std::string_view verdict) const {
    const std::string text_there = text("//b[@data-count='" + std::string(verdict) + "']");
    return text_there.empty() ? 0 : std::stoul(text_there);
  }

 private:
  static std::string text_of(pugi::xml_node node) {
    std::string all;
    struct Walker : pugi::xml_tree_walker {
      explicit Walker(std::string& to) : text(to) {}
      bool for_each(pugi::xml_node& one) override {
        text += one.value();
        return true;
      }
      std::string& text;
    } walker(all);
    node.traverse(walker);
    return all;
  }

  pugi::xml_document document_;
};

/// A parser that is stricter than ours: characters, namespaces, entities. True where it is not
/// installed.
inline bool xmllint_accepts(const std::string& path) {
  if (std::system("xmllint --version >/dev/null 2>&1") != 0) return true;
  return std::system(("xmllint --huge --noout '" + path + "'").c_str()) == 0;
}

}  // namespace fieldproof::samples
