#include "reports/html/html_find.hpp"

#include <array>
#include <string>

namespace fieldproof::html {

void write_find(HtmlWriter& out) {
  out.element("form", {{"id", "find"}, {"hidden", "hidden"}}, [&] {
    out.empty("input", {{"type", "search"},
                        {"name", "q"},
                        {"placeholder", "Search: id, title, message, bytes"},
                        {"aria-label", "Search the cases"},
                        {"autocomplete", "off"}});
    for (const char* name : {"verdict", "protocol", "section"})
      out.element("select", {{"name", name}, {"aria-label", name}}, [&] {
        out.element("option", {{"value", ""}}, std::string("any ") + name);
      });
    out.element("button", {{"type", "reset"}}, "Clear");
    out.element("output", {}, "");
  });
  constexpr std::array heads = {std::pair{"verdict", "verdict"}, std::pair{"name", "case"},
                                std::pair{"section", "section"}, std::pair{"text", "what"},
                                std::pair{"ms", "reply ms"}};
  out.element("table", {{"id", "found"}, {"class", "found"}, {"hidden", "hidden"}}, [&] {
    out.element("thead", {}, [&] {
      out.element("tr", {}, [&] {
        for (const auto& [key, head] : heads)
          out.element("th", {}, [&] {
            out.element("button", {{"type", "button"}, {"data-sort", key}}, head);
          });
      });
    });
    out.element("tbody", {}, "");
  });
  out.element("button", {{"id", "more"}, {"type", "button"}, {"hidden", "hidden"}}, "Show all");
}

// The page is XML too: this stands in a CDATA section. Text from the page goes back into it as
// text only.
const char* const html_script = R"js(//<![CDATA[
(function () {
"use strict";
var form = document.getElementById("find"), table = document.getElementById("found");
var more = document.getElementById("more"), body = table.tBodies[0], count = form.querySelector("output");
var fields = ["q", "verdict", "protocol", "section"], first = 200, all = false, sort = "", cases = null;
var gravity = ["ERROR", "FAIL", "XPASS", "NON-STRICT", "MARGINAL", "XFAIL", "BLOCKED", "INCONCLUSIVE", "INFO", "PASS", "SKIP"];

function text(row, selector) {
  var node = row.querySelector(selector);
  return node ? node.textContent.trim() : "";
}
// What a cell says, without the words in its picture.
function line_of(cell) {
  if (!cell.querySelector("details")) return cell.textContent;
  var copy = cell.cloneNode(true);
  copy.querySelectorAll("details").forEach(function (picture) { picture.remove(); });
  return copy.textContent;
}
// The cases stand in the rows and blocks of their sections.
function read() {
  cases = [];
  document.querySelectorAll("details.section").forEach(function (section) {
    var where = section.dataset.section;
    section.querySelectorAll(":scope > .lines tr, :scope > .passes tr, :scope > .case").forEach(function (row) {
      var is_row = row.tagName === "TR", name = text(row, is_row ? "th" : "b");
      var cells = is_row ? row.cells : [], last = cells.length ? cells[cells.length - 1].textContent : "";
      var is_pass = is_row && row.parentNode.parentNode.className === "passes";
      var title = is_pass ? row.cells[0].title : text(row, ".title");
      var what = !is_row ? text(row, ".message") || title : is_pass ? line_of(cells[1]) || title : last;
      cases.push({row: row, name: name, verdict: is_pass ? "PASS" : text(row, ".verdict"), section: where,
        protocol: name.split("/")[0], text: what, ms: is_pass ? parseFloat(last) : NaN, at: cases.length,
        hay: (name + " " + title + " " + what + " " + where).toLowerCase()});
    });
  });
}
function fill(name, values) {
  values.forEach(function (value) { form.elements[name].add(new Option(value, value)); });
}
function distinct(key) {
  return Array.from(new Set(cases.map(function (one) { return one[key]; })));
}
// Opens what it stands in, and brings it into view.
function show(node) {
  for (var at = node; at; at = at.parentElement) if (at.tagName === "DETAILS") at.open = true;
  node.scrollIntoView({block: "center"});
  document.querySelectorAll(".seen").forEach(function (other) { other.classList.remove("seen"); });
  node.classList.add("seen");
}
function target(one) {
  var link = one.row.querySelector("th a");
  return (link && document.getElementById(link.getAttribute("href").slice(1))) || one.row;
}
function ordered(found) {
  var key = sort.replace("-", ""), sign = sort[0] === "-" ? -1 : 1;
  if (!key) return found;
  return found.sort(function (a, b) {
    var x = a[key], y = b[key];
    if (key === "verdict") { x = gravity.indexOf(x); y = gravity.indexOf(y); }
    if (key === "section") { x = a.at; y = b.at; }
    if (key === "ms") { if (isNaN(x) || isNaN(y)) return (isNaN(x) ? 1 : 0) - (isNaN(y) ? 1 : 0) || a.at - b.at; }
    return (x > y ? sign : y > x ? -sign : 0) || a.at - b.at;
  });
}
function add(one) {
  var row = body.insertRow(), verdict = document.createElement("span"), link = document.createElement("a");
  verdict.className = "verdict v-" + one.verdict.toLowerCase();
  verdict.textContent = one.verdict;
  row.insertCell().append(verdict);
  link.href = "#";
  link.textContent = one.name;
  link.addEventListener("click", function (event) { event.preventDefault(); show(target(one)); });
  row.insertCell().append(link);
  row.insertCell().textContent = one.section;
  row.insertCell().textContent = one.text.length > 160 ? one.text.slice(0, 160) + " ..." : one.text;
  row.insertCell().textContent = isNaN(one.ms) ? "" : one.ms.toFixed(3);
}
function asked() {
  return fields.some(function (name) { return form.elements[name].value; }) || sort;
}
function update() {
  if (!cases) read();
  var words = form.elements.q.value.toLowerCase().split(/\s+/).filter(Boolean);
  var found = !asked() ? [] : cases.filter(function (one) {
    return fields.slice(1).every(function (name) {
      return !form.elements[name].value || form.elements[name].value === one[name];
    }) && words.every(function (word) { return one.hay.includes(word); });
  });
  body.replaceChildren();
  ordered(found).slice(0, all ? found.length : first).forEach(add);
  count.textContent = asked() ? found.length.toLocaleString("en") + " of " + cases.length.toLocaleString("en") + " cases" : "";
  table.hidden = !found.length;
  more.hidden = all || found.length <= first;
  table.querySelectorAll("[data-sort]").forEach(function (head) {
    var on = sort.replace("-", "") === head.dataset.sort;
    head.parentNode.setAttribute("aria-sort", !on ? "none" : sort[0] === "-" ? "descending" : "ascending");
  });
}
function keep() {
  var parts = fields.map(function (name) { return [name, form.elements[name].value]; }).concat([["sort", sort]]);
  var query = new URLSearchParams(parts.filter(function (part) { return part[1]; })).toString();
  history.replaceState(null, "", query ? "#" + query : location.href.split("#")[0]);
}
function changed() { all = false; update(); keep(); }
function arrive() {
  var hash = location.hash.slice(1), there = hash && document.getElementById(hash);
  if (there && there.tagName === "DETAILS") show(there);
  if (!hash.includes("=")) return;
  if (!cases) start();
  var query = new URLSearchParams(hash);
  fields.forEach(function (name) { form.elements[name].value = query.get(name) || ""; });
  sort = query.get("sort") || "";
  update();
}
// The lists are made when somebody asks: a page that is only read does not wait for them.
function start() {
  read();
  fill("verdict", gravity.filter(function (verdict) { return distinct("verdict").includes(verdict); }));
  fill("protocol", distinct("protocol").sort());
  fill("section", distinct("section"));
}
form.hidden = false;
form.addEventListener("pointerdown", function () { if (!cases) start(); });
form.addEventListener("focusin", function () { if (!cases) start(); });
form.addEventListener("input", changed);
form.addEventListener("submit", function (event) { event.preventDefault(); });
form.addEventListener("reset", function () { sort = ""; setTimeout(changed); });
more.addEventListener("click", function () { all = true; update(); });
table.addEventListener("click", function (event) {
  var key = event.target.dataset.sort;
  if (!key) return;
  sort = sort === key ? "-" + key : sort === "-" + key ? "" : key;
  changed();
});
document.querySelectorAll(".tiles [data-count]").forEach(function (tile) {
  var item = tile.parentNode;
  item.classList.add("link");
  item.addEventListener("click", function () {
    if (!cases) start();
    form.elements.verdict.value = tile.dataset.count;
    changed();
    form.scrollIntoView({block: "start"});
  });
});
addEventListener("hashchange", arrive);
arrive();
})();
//]]>)js";

}  // namespace fieldproof::html
