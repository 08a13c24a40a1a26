#include "reports/html/html_page.hpp"

namespace fieldproof::html {

std::string html_page(std::string_view title, const HtmlWriter& body, std::string_view script) {
  HtmlWriter page;
  page.markup("<!DOCTYPE html>\n");
  page.element("html", {{"xmlns", "http://www.w3.org/1999/xhtml"}, {"lang", "en"}}, [&] {
    page.element("head", {}, [&] {
      page.empty("meta", {{"charset", "utf-8"}});
      page.empty("meta",
                 {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
      page.empty("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
      page.element("title", {}, title);
      page.element("style", {}, [&] { page.markup(html_style); });
    });
    page.markup("\n");
    page.element("body", {}, [&] {
      page.element("main", {}, [&] { page.markup(body.str()); });
      if (!script.empty()) page.element("script", {}, [&] { page.markup(script); });
    });
  });
  page.markup("\n");
  return page.take();
}

std::string verdict_class(results::Verdict verdict) {
  std::string name = "v-";
  for (const char c : results::to_string(verdict))
    name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return name;
}

void write_verdict(HtmlWriter& out, results::Verdict verdict) {
  out.element("span", {{"class", "verdict " + verdict_class(verdict)}},
              results::to_string(verdict));
}

}  // namespace fieldproof::html
