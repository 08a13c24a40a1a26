// The one place that writes HTML. Well-formed by construction (every element that is opened is
// closed, every text is escaped), in the syntax that HTML and XML share: an XML parser reads the
// page as a browser does.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace fieldproof::html {

class HtmlWriter {
 public:
  using Attributes = std::initializer_list<std::pair<std::string_view, std::string_view>>;

  /// out.element("tr", {{"class", "red"}}, [&] { out.element("td", {}, id); });
  template <typename Body>
  void element(std::string_view tag, Attributes attributes, const Body& body) {
    open(tag, attributes);
    if constexpr (std::is_invocable_v<const Body&>)
      body();
    else
      text(body);
    close(tag);
  }
  /// A drawing of this `size` ("720 120"); `label` is what it shows, for who cannot see it.
  template <typename Body>
  void picture(std::string_view size, std::string_view label, const Body& body) {
    const std::string box = "0 0 " + std::string(size);
    element("svg",
            {{"xmlns", "http://www.w3.org/2000/svg"},
             {"viewBox", box},
             {"role", "img"},
             {"aria-label", label}},
            body);
  }
  /// An element that HTML knows as empty (br, hr, meta) or a shape of SVG.
  void empty(std::string_view tag, Attributes attributes = {});

  /// One line of any bytes: what XML cannot carry is shown as hex ([05], [FF]), line feeds too.
  void text(std::string_view bytes);
  /// Text of several lines, for <pre>.
  void lines(std::string_view bytes);

  /// What another writer made, or what stands in this source (never a text from outside).
  void markup(std::string_view html) { html_ += html; }

  std::size_t size() const { return html_.size(); }
  const std::string& str() const { return html_; }
  std::string take() { return std::move(html_); }

 private:
  void open(std::string_view tag, Attributes attributes);
  void close(std::string_view tag);
  void start(std::string_view tag, Attributes attributes);

  std::string html_;
};

}  // namespace fieldproof::html
