#include "src/plc/model.hpp"

#include <gtest/gtest.h>

#include <map>
#include <utility>

namespace fieldproof::plc {
namespace {

struct Row {
  std::uint32_t last_word;
  bool write;
};

std::map<char, Row> rows_of(std::string_view model) {
  std::map<char, Row> rows;
  for (const DeviceArea& area : find_plc_model(model)->areas)
    rows[area.letter] = {area.last_word(), area.write};
  return rows;
}

void expect_rows(std::string_view model, const std::map<char, Row>& expected) {
  const auto rows = rows_of(model);
  EXPECT_EQ(rows.size(), expected.size());
  for (const auto& [letter, row] : expected) {
    ASSERT_TRUE(rows.contains(letter)) << letter;
    EXPECT_EQ(rows.at(letter).last_word, row.last_word) << letter;
    EXPECT_EQ(rows.at(letter).write, row.write) << letter;
  }
}

// Typed from Cnet EN 7.1.4 '"S" type range'; U07.31 as Cnet KO counts it.
TEST(PlcModel, RangesOfTypeS) {
  expect_rows("xbm-s", {{'P', {127, true}},
                        {'M', {255, true}},
                        {'K', {2559, true}},
                        {'F', {255, false}},
                        {'T', {255, true}},
                        {'C', {255, true}},
                        {'L', {1279, true}},
                        {'N', {3935, false}},
                        {'D', {5119, true}},
                        {'U', {255, true}}});
}

TEST(PlcModel, RangesOfTypeH) {
  expect_rows("xbc-h", {{'P', {1023, true}},
                        {'M', {1023, true}},
                        {'K', {4095, true}},
                        {'F', {1023, false}},
                        {'T', {1023, true}},
                        {'C', {1023, true}},
                        {'L', {2047, true}},
                        {'N', {5119, false}},
                        {'D', {10239, true}},
                        {'U', {351, true}},
                        {'R', {10239, true}}});
}

TEST(PlcModel, RangesOfXec) {
  expect_rows("xec-h", {{'I', {1023, true}},
                        {'Q', {1023, true}},
                        {'M', {8191, true}},
                        {'W', {10239, true}},
                        {'R', {10239, true}},
                        {'F', {1023, false}},
                        {'K', {4095, true}},
                        {'L', {2047, true}},
                        {'N', {5119, false}},
                        {'U', {511, true}}});
}

TEST(PlcModel, OnlyTimersAndCountersHaveContacts) {
  for (const PlcModel& model : plc_models()) {
    for (const DeviceArea& area : model.areas) {
      const bool timer_or_counter = area.letter == 'T' || area.letter == 'C';
      EXPECT_EQ(area.contacts, timer_or_counter ? area.words : 0)
          << model.name << ' ' << area.letter;
    }
  }
}

TEST(PlcModel, DottedAreasAreAsLargeAsTheirSlots) {
  for (const DeviceArea& area : find_plc_model("xec-h")->areas) {
    const std::uint32_t words = area.dotted.bases * area.dotted.slots * area.dotted.slot_words;
    EXPECT_EQ(words, area.dotted ? area.words : 0) << area.letter;
  }
}

TEST(PlcModel, UnknownNames) {
  EXPECT_EQ(find_plc_model("xbc"), nullptr);
  EXPECT_EQ(find_plc_model("XBC-H"), nullptr);
  EXPECT_EQ(find_plc_model("xbc-h")->area('I'), nullptr);
  EXPECT_EQ(plc_model_names(), "xbc-h, xbm-s, xec-h");
}

}  // namespace
}  // namespace fieldproof::plc
