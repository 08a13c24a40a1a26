#include "reports/html/html_wire.hpp"

#include <gmock/gmock.h>

#include "reports/testdata/parsed_html.hpp"
#include "reports/testdata/samples.hpp"

namespace fieldproof::html {
namespace {

using results::CaseResult;
using results::Event;
using samples::ParsedHtml;
using testing::Each;
using testing::ElementsAre;
using testing::Gt;

ParsedHtml drawn(const CaseResult& result, WireOn on = WireOn::window) {
  HtmlWriter out;
  out.element("div", {}, [&] { write_wire(out, result, on); });
  return ParsedHtml(out.str());
}

/// The start of a shape.
double x_of(const ParsedHtml& page, const std::string& path) {
  const std::vector<double> all = page.numbers(path, "x");
  return all.empty() ? -1 : all.front();
}

TEST(Wire, BothDirectionsStandOnOneAxis) {
  const ParsedHtml page = drawn(samples::failure());
  EXPECT_EQ(1u, page.count("//rect[@class='bar sent']"));
  EXPECT_EQ("19 bytes, 0.000 to 19.792 ms", page.text("//rect[@class='bar sent']/title"));
  EXPECT_EQ("17 bytes, 24.000 to 41.708 ms", page.text("//rect[@class='bar judged']/title"));
  EXPECT_LT(x_of(page, "//rect[@class='bar sent']"), x_of(page, "//rect[@class='bar judged']"));
  EXPECT_THAT(page.texts("//text[@class='silence']"), ElementsAre("4.208"));
  EXPECT_THAT(page.texts("//text[starts-with(@class, 'tick')]"), ElementsAre("0.000", "24.000"));
}

TEST(Wire, MarksWhenTheAnswerWasDue) {
  CaseResult late = samples::failure();
  EXPECT_EQ(0u, drawn(late).count("//path[@class='limit']"));
  late.due = {late.exchange[0].end, late.exchange[0].end + 2ms};
  const ParsedHtml page = drawn(late);
  EXPECT_EQ("answer due within 2 ms", page.text("//text[@class='limit-text']"));
  const double due = x_of(page, "//rect[@class='due']");
  EXPECT_GT(due, x_of(page, "//rect[@class='bar sent']"));
  EXPECT_GT(x_of(page, "//rect[@class='bar judged']"),
            due + page.numbers("//rect[@class='due']", "width").front())
      << "it came too late";
}

TEST(Wire, OnATelephoneAllOfItLiesWithinThePicture) {
  CaseResult silent = samples::failure();
  silent.exchange.resize(1);
  silent.received_bytes = {};
  silent.due = {silent.exchange[0].end, silent.exchange[0].end + 60s};
  const ParsedHtml page = drawn(silent, WireOn::telephone);
  EXPECT_EQ(1u, page.count("//svg[@viewBox='0 0 350 124']"));
  EXPECT_EQ("answer due within 60000 ms", page.text("//text[@class='limit-text']"));
  for (const char* path : {"//rect", "//text"})
    EXPECT_THAT(page.numbers(path, "x"), Each(testing::Le(350)));
}

TEST(Wire, ALongSilenceIsCut) {
  CaseResult silent = samples::failure();
  silent.exchange.resize(1);
  silent.received_bytes = {};
  silent.due = {silent.exchange[0].end, silent.exchange[0].end + 60s};
  const ParsedHtml page = drawn(silent);
  EXPECT_EQ(1u, page.count("//text[@class='cut']"));
  EXPECT_GT(page.numbers("//rect[@class='bar sent']", "width").front(), 100)
      << "its frame can still be seen";
  EXPECT_EQ(0u, drawn(samples::failure()).count("//text[@class='cut']"));
}

TEST(Wire, ASilenceInsideAnAnswerIsMarked) {
  CaseResult split = samples::failure();
  split.recording.max_gap = 4ms;
  split.exchange[1].step = 1;
  Event rest = split.exchange[1];
  rest.start = split.exchange[1].end + 5ms;
  rest.end = rest.start + 1ms;
  split.exchange.insert(split.exchange.begin() + 2, rest);
  EXPECT_THAT(drawn(split).texts("//text[@class='silence over']"), ElementsAre("5.000"));
  split.recording.max_gap = 6ms;
  EXPECT_EQ(0u, drawn(split).count("//text[@class='silence over']"));
}

TEST(Wire, WhatBecameOfAConnectionIsMarked) {
  CaseResult network = samples::failure();
  const Time start = network.exchange[0].start, end = network.exchange[1].end + 1ms;
  network.exchange.insert(network.exchange.begin(), {Event::Kind::opened, start, start, {}, ""});
  network.exchange.push_back({Event::Kind::reset, end, end, {}, ""});
  network.exchange.front().link = network.exchange.back().link = "a";
  network.exchange.back().by_device = true;
  const ParsedHtml page = drawn(network);
  EXPECT_EQ("a opened by the bench, 0.000 ms", page.text("//circle[@class='link opened']/title"));
  EXPECT_EQ("a reset by the device, 42.708 ms", page.text("//circle[@class='link ended']/title"));
  EXPECT_GT(page.numbers("//circle[@class='link ended']", "cy").front(),
            page.numbers("//circle[@class='link opened']", "cy").front());
}

TEST(Wire, OfManyFramesThoseAboutTheJudgedOneAreShown) {
  CaseResult many = samples::failure();
  const Event sent = many.exchange[0], judged = many.exchange[1];
  many.exchange.clear();
  for (int i = 0; i < 300; ++i) {
    Event one = sent;
    one.start += i * 50ms;
    one.end += i * 50ms;
    many.exchange.push_back(one);
  }
  Event last = judged;
  last.start += 299 * 50ms;
  last.end += 299 * 50ms;
  many.exchange.push_back(last);
  const ParsedHtml page = drawn(many);
  EXPECT_EQ(24u, page.count("//rect[starts-with(@class, 'bar')]"));
  EXPECT_EQ(1u, page.count("//rect[@class='bar judged']"));
  EXPECT_THAT(page.numbers("//rect[starts-with(@class, 'bar')]", "width"), Each(Gt(0)));
}

TEST(Wire, WhereNothingWentOverTheLineNothingIsDrawn) {
  CaseResult none = samples::failure();
  none.exchange.clear();
  EXPECT_EQ(0u, drawn(none).count("//figure"));
}

}  // namespace
}  // namespace fieldproof::html
