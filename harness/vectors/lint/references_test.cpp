// What the project's own files refer to is there for a reader: manuals by name ("Cnet EN 7.1.3"),
// decisions by an id of vectors/DECISIONS.md.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "harness/vectors/decisions.hpp"
#include "reports/results/whole_file.hpp"

namespace fieldproof::vectors {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) {
  return is_digit(c) || c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_id(char c) { return is_digit(c) || c == '-' || c == '_' || (c >= 'a' && c <= 'z'); }

/// A manual by the number of its file in somebody's folder: three digits up to 004 and a section.
bool numbers_a_manual(std::string_view line) {
  for (std::size_t i = 0; i + 5 <= line.size(); ++i) {
    if (line.substr(i, 2) != "00" || line[i + 2] < '0' || line[i + 2] > '4' || line[i + 3] != ' ')
      continue;
    const char before = i == 0 ? ' ' : line[i - 1];
    if (is_word(before) || std::string_view(".,'%").find(before) != std::string_view::npos)
      continue;  // the end of a longer number
    if (is_digit(line[i + 4]) || line[i + 4] == 'A') return true;
  }
  return false;
}

/// The ids behind "DECISIONS.md ", joined by ", ".
std::vector<std::string> cited(std::string_view line) {
  constexpr std::string_view file = "DECISIONS.md ";
  std::vector<std::string> ids;
  for (std::size_t at = 0; (at = line.find(file, at)) != std::string_view::npos;) {
    at += file.size();
    for (bool more = true; more;) {
      std::size_t end = at;
      while (end < line.size() && (is_id(line[end]) || line[end] == '/')) ++end;
      const std::string id(line.substr(at, end - at));
      if (id.find('/') == std::string::npos) break;
      ids.push_back(id);
      more = line.substr(end, 2) == ", ";
      at = end + (more ? 2 : 0);
    }
  }
  return ids;
}

std::vector<std::string> faults(std::string_view text, const std::string& file,
                                const std::set<std::string>& known) {
  std::vector<std::string> found;
  int number = 0;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    ++number;
    const auto fault = [&](const std::string& what) {
      found.push_back(fmt::format("{}:{}: {}: {}", file, number, what, line));
    };
    if (line.find("\"quote\"") != std::string_view::npos) continue;  // the manual's own words
    if (line.find("PROTOCOLS"
                  ".md") != std::string_view::npos)
      fault("cites a file that is not here");
    if (numbers_a_manual(line)) fault("cites a manual by a number");
    for (const std::string& id : cited(line))
      if (!known.contains(id)) fault("cites a decision that is not there");
  }
  return found;
}

std::string read(const fs::path& path) { return *results::read_whole_file(path); }

bool is_text(const fs::path& path) {
  constexpr std::array<std::string_view, 7> endings{".cpp", ".hpp", ".md", ".json",
                                                    ".txt", ".sh",  ".py"};
  return std::ranges::find(endings, path.extension().string()) != endings.end();
}

/// The project's texts but for vectors/wires, which is bytes.
std::vector<fs::path> texts(const fs::path& root) {
  std::vector<fs::path> files;
  for (const char* room : {"src", "harness", "reports", "suites", "vectors"})
    for (auto at = fs::recursive_directory_iterator(root / room); at != fs::end(at); ++at) {
      if (at->path() == root / "vectors/wires") at.disable_recursion_pending();
      if (at->is_regular_file() && is_text(at->path())) files.push_back(at->path());
    }
  for (const fs::directory_entry& entry : fs::directory_iterator(root))
    if (entry.is_regular_file() && is_text(entry.path())) files.push_back(entry.path());
  return files;
}

TEST(References, EveryFileOfTheProjectCitesWhatAReaderFinds) {
  const fs::path root = FIELDPROOF_SOURCE_DIR;
  std::set<std::string> known;
  for (const Decision& decision : read_decisions(read(root / "vectors/DECISIONS.md")))
    known.insert(decision.id);
  const std::vector<fs::path> files = texts(root);
  EXPECT_GT(files.size(), 500u);
  for (const fs::path& path : files)
    EXPECT_THAT(faults(read(path), fs::relative(path, root).string(), known), IsEmpty());
}

TEST(References, WhatIsAFault) {
  const auto of = [](std::string_view line) { return faults(line, "f", {"cnet/bcc"}); };
  EXPECT_THAT(of("a\n// see PROTOCOLS"
                 ".md"),
              ElementsAre(HasSubstr("f:2: cites a file")));
  EXPECT_THAT(of("(00"
                 "0 11.2.5)"),
              ElementsAre(HasSubstr("a manual by a number")));
  EXPECT_THAT(of("00"
                 "3 Appendix 3.1"),
              ElementsAre(HasSubstr("a manual by a number")));
  EXPECT_THAT(of("DECISIONS.md cnet/bcc, cnet"
                 "/bbc"),
              ElementsAre(HasSubstr("a decision that")));
  EXPECT_THAT(of("Cnet EN 11.2.5; DECISIONS.md cnet/bcc; 1.000 2.000; 100'000 9; 0x000 1"),
              IsEmpty());
  EXPECT_THAT(of("\"quote\": \"D R S , 00"
                 "1 6\""),
              IsEmpty());
}

}  // namespace
}  // namespace fieldproof::vectors
