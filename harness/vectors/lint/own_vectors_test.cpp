// What the project asks of its own vectors beyond what it takes from others: files of a user may
// have longer titles, and `printed` alone.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/results/whole_file.hpp"

namespace fieldproof::vectors {
namespace {

using nlohmann::json;
using testing::IsEmpty;
namespace fs = std::filesystem;

constexpr std::size_t longest_title = 80;  // characters

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

/// Of one vector, or of what differs in one framing.
std::vector<std::string> faults(const json& one) {
  std::vector<std::string> found;
  const std::string title = one.value("title", "");
  if (characters(title) > longest_title) found.push_back("a long title: " + title);
  if (one.value("basis", "") == "printed")
    found.push_back("printed frame, or printed rule? " + title);
  const json differs = one.value("differs", json::object());
  for (const json& difference : differs)
    std::ranges::move(faults(difference), std::back_inserter(found));
  return found;
}

TEST(OwnVectors, HaveShortTitlesAndSayWhatIsPrinted) {
  std::size_t seen = 0;
  for (const fs::directory_entry& folder :
       fs::directory_iterator(fs::path(FIELDPROOF_SOURCE_DIR) / "vectors")) {
    const std::string name = folder.path().filename();
    if (!folder.is_directory() || name == "statements" || name == "errata" || name == "wires" ||
        name == "citations")
      continue;
    for (const fs::directory_entry& file : fs::directory_iterator(folder))
      for (const json& one : json::parse(*results::read_whole_file(file.path()))) {
        EXPECT_THAT(faults(one), IsEmpty()) << file.path();
        ++seen;
      }
  }
  EXPECT_GT(seen, 1'500u);
}

TEST(OwnVectors, WhatIsAFault) {
  EXPECT_THAT(faults({{"title", std::string(80, 'x')}, {"basis", "printed rule"}}), IsEmpty());
  EXPECT_EQ(faults({{"title", std::string(81, 'x')}, {"basis", "printed frame"}}).size(), 1u);
  EXPECT_EQ(faults({{"title", "a"}, {"basis", "printed"}}).size(), 1u);
  EXPECT_EQ(faults({{"differs", {{"modbus_tcp", {{"basis", "printed"}}}}}}).size(), 1u);
}

}  // namespace
}  // namespace fieldproof::vectors
