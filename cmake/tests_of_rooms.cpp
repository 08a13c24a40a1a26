// Runs the tests of one room of a wing (rooms.cmake): --room=src/plc, with --gtest_filter=-X those
// but X; without it, all.
#include <gmock/gmock.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>

namespace {

/// As a filter of GoogleTest: the tests whose files lie in the folder.
std::string tests_in(std::string_view room) {
  std::string filter;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int k = 0; k < suite.total_test_count(); ++k) {
      const testing::TestInfo& test = *suite.GetTestInfo(k);
      const std::string folder = std::filesystem::path(test.file()).parent_path().generic_string();
      if (folder.ends_with("/" + std::string(room)))
        filter += (filter.empty() ? "" : ":") + std::string(suite.name()) + "." + test.name();
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  constexpr std::string_view option = "--room=";
  if (argc > 1 && std::string_view(argv[1]).starts_with(option)) {
    std::string filter = tests_in(std::string_view(argv[1]).substr(option.size()));
    if (filter.empty()) {
      std::cerr << "no test lies in " << argv[1] << "\n";
      return 2;
    }
    const std::string but = testing::GTEST_FLAG(filter);
    if (but.starts_with('-')) filter += but;
    testing::GTEST_FLAG(filter) = filter;
  }
  return RUN_ALL_TESTS();
}
