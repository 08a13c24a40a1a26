// The house as README and CMakeLists.txt draw it: suites -> harness -> reports -> src/base, suites
// and harness -> src; no arrow runs back, and no room stands in a circle. Here the includes are
// read.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace fieldproof::suites {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Include {
  std::string file, header;  // below the project's folder; a system header in its <>
};

/// Rooms whose tests reach up, to what the suites have.
struct Excepted {
  std::string_view room;
  std::string_view reason;
};
constexpr Excepted tests_with_suites[] = {
    {"harness/notation", "real checks"},
    {"harness/vectors/lint", "real checks"},
    {"harness/probe", "finds emulated devices of every protocol"},
    {"harness/safety", "moves frames of real protocols"},
    {"harness/explore", "explores emulated devices, and broken ones"},
};

/// A folder is seen at a glance.
constexpr std::size_t most_files = 48;
constexpr Excepted larger[] = {
    {"suites/tool", "a test file a thing that the tool does, and nothing else"},
};

/// What a state machine on given time has no use for: files, threads, sockets, clocks of its own.
const std::set<std::string> of_the_system{
    "<fstream>",  "<filesystem>", "<thread>",  "<mutex>",     "<condition_variable>",
    "<future>",   "<atomic>",     "<csignal>", "<ctime>",     "<time.h>",
    "<unistd.h>", "<fcntl.h>",    "<poll.h>",  "<termios.h>", "<netdb.h>"};

std::string folder_of(const std::string& file) {
  return fs::path(file).parent_path().generic_string();
}

bool within(const std::string& path, const std::string& folder) {
  return path.starts_with(folder + '/');
}

bool is_test(const std::string& file) {
  const std::string name = fs::path(file).filename().string();
  return name.ends_with("_test.cpp") || name.starts_with("test_");
}

/// Why the house has no such arrow; empty: it has.
std::string against_the_house(const Include& one) {
  const auto from = [&](const char* folder) { return within(one.file, folder); };
  const auto to = [&](const char* folder) { return within(one.header, folder); };
  if (one.header.starts_with('<')) {
    const bool system = of_the_system.contains(one.header) || one.header.starts_with("<sys/") ||
                        one.header.starts_with("<boost/") || one.header.starts_with("<netinet/");
    return from("src") && !is_test(one.file) && system ? "src/ is bytes and time in, and out" : "";
  }
  if (from("src/base") && !to("src/base")) return "src/base includes itself alone";
  if (from("src") && !to("src")) return "src/ includes src/ alone";
  if (from("reports") && !to("reports") && !to("src/base"))
    return "reports/ includes src/base alone";
  if (from("harness") && to("suites")) {
    const auto room = std::ranges::find(tests_with_suites, folder_of(one.file), &Excepted::room);
    if (!is_test(one.file) || room == std::end(tests_with_suites))
      return "harness/ is handed what the suites have";
  }
  return "";
}

std::vector<std::string> problems_of(const std::vector<Include>& includes) {
  std::vector<std::string> problems;
  for (const Include& one : includes)
    if (const std::string why = against_the_house(one); !why.empty())
      problems.push_back(fmt::format("{} includes {}: {}", one.file, one.header, why));
  return problems;
}

using Rooms = std::map<std::string, std::set<std::string>>;

/// Which rooms each room includes; tests aside, which may look at what stands above.
Rooms rooms_of(const std::vector<Include>& includes) {
  Rooms rooms;
  for (const Include& one : includes)
    if (!is_test(one.file) && !one.header.starts_with('<') &&
        folder_of(one.file) != folder_of(one.header))
      rooms[folder_of(one.file)].insert(folder_of(one.header));
  return rooms;
}

/// Rooms that include themselves by way of others: what is left when every room is taken away that
/// includes none of the rest, or that none of the rest includes.
std::vector<std::string> in_circles(Rooms rooms) {
  for (bool less = true; less;) {
    less = std::erase_if(rooms, [&](const auto& room) {
             return std::ranges::none_of(room.second,
                                         [&](const auto& to) { return rooms.contains(to); });
           }) > 0;
    less |= std::erase_if(rooms, [&](const auto& room) {
              return std::ranges::none_of(
                  rooms, [&](const auto& other) { return other.second.contains(room.first); });
            }) > 0;
  }
  std::vector<std::string> left;
  for (const auto& [room, included] : rooms) left.push_back(room);
  return left;
}

const fs::path project = FIELDPROOF_SOURCE_DIR;

std::vector<std::string> files() {
  std::vector<std::string> all;
  for (const char* top : {"src", "reports", "harness", "suites"})
    for (const auto& entry : fs::recursive_directory_iterator(project / top))
      if (const fs::path& path = entry.path();
          path.extension() == ".cpp" || path.extension() == ".hpp")
        all.push_back(path.lexically_relative(project).generic_string());
  std::ranges::sort(all);
  return all;
}

std::vector<Include> includes() {
  static const std::regex line(R"re(#\s*include\s+(?:"([^"]+)"|(<[^>]+>)).*)re");
  std::vector<Include> all;
  for (const std::string& file : files()) {
    std::ifstream in(project / file);
    for (std::string text; std::getline(in, text);)
      if (std::smatch match; std::regex_match(text, match, line))
        all.push_back({file, match[1].matched ? match[1].str() : match[2].str()});
  }
  return all;
}

TEST(House, NoArrowRunsBack) {
  const std::vector<Include> all = includes();
  EXPECT_GT(all.size(), 3000u);
  EXPECT_THAT(problems_of(all), IsEmpty());
  for (const auto& [room, reason] : tests_with_suites)
    EXPECT_TRUE(std::ranges::any_of(all,
                                    [&, name = std::string(room)](const Include& one) {
                                      return folder_of(one.file) == name &&
                                             within(one.header, "suites");
                                    }))
        << room << " needs no exception any more: " << reason;
}

TEST(House, NoRoomStandsInACircle) { EXPECT_THAT(in_circles(rooms_of(includes())), IsEmpty()); }

TEST(House, IncludesAreWrittenFromTheProjectsFolder) {
  std::vector<std::string> problems;
  for (const Include& one : includes())
    if (!one.header.starts_with('<') && !fs::exists(project / one.header))
      problems.push_back(one.file + ": " + one.header);
  EXPECT_THAT(problems, IsEmpty());
}

TEST(House, FoldersAreSeenAtAGlance) {
  std::map<std::string, std::size_t> counts;
  for (const std::string& file : files()) ++counts[folder_of(file)];
  std::vector<std::string> large, listed;
  for (const auto& [folder, count] : counts)
    if (count > most_files) large.push_back(folder);
  for (const Excepted& one : larger) listed.emplace_back(one.room);
  EXPECT_EQ(large, listed) << "more than " << most_files << " files: give it sub-rooms";
}

TEST(House, WhatItForbidsIsFound) {
  EXPECT_THAT(problems_of({{"reports/a.cpp", "src/plc/b.hpp"},
                           {"reports/a.cpp", "src/base/b.hpp"},
                           {"reports/a_test.cpp", "harness/b.hpp"},
                           {"harness/run/a.cpp", "suites/b.hpp"},
                           {"harness/probe/a.cpp", "suites/b.hpp"},
                           {"harness/probe/a_test.cpp", "suites/b.hpp"},
                           {"src/base/a.hpp", "src/line/b.hpp"},
                           {"src/plc/a.hpp", "reports/b.hpp"},
                           {"src/plc/a.hpp", "<sys/socket.h>"},
                           {"harness/a.hpp", "<sys/socket.h>"}}),
              ElementsAre(HasSubstr("reports/a.cpp includes src/plc/b.hpp"),
                          HasSubstr("reports/a_test.cpp includes harness/b.hpp"),
                          HasSubstr("harness/run/a.cpp includes suites/b.hpp"),
                          HasSubstr("harness/probe/a.cpp includes suites/b.hpp"),
                          HasSubstr("src/base/a.hpp includes src/line/b.hpp"),
                          HasSubstr("src/plc/a.hpp includes reports/b.hpp"),
                          HasSubstr("src/plc/a.hpp includes <sys/socket.h>")));
  EXPECT_THAT(in_circles(rooms_of({{"a/x.cpp", "b/x.hpp"},
                                   {"b/x.cpp", "c/x.hpp"},
                                   {"c/x.hpp", "b/y.hpp"},
                                   {"c/x.hpp", "d/x.hpp"},
                                   {"d/x_test.cpp", "a/x.hpp"}})),
              ElementsAre("b", "c"));
}

}  // namespace
}  // namespace fieldproof::suites
