// Shards of a run, merged by the built tool.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr int shard_count = 3;

class MergeCommand : public testing::Test {
 protected:
  std::string shard(int index, const std::string& name, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run", "--endpoint", "emulator:xbm-s", "--out",
                                       folder_ / name};
    if (more.empty())
      arguments.insert(arguments.end(), {"--vectors", write_vectors(folder_, many_vectors(9))});
    arguments.insert(arguments.end(), more.begin(), more.end());
    ProcessOptions options;
    if (index >= 0)
      options.environment = {{"GTEST_TOTAL_SHARDS", std::to_string(shard_count)},
                             {"GTEST_SHARD_INDEX", std::to_string(index)}};
    const Finished finished = run_tool(arguments, options);
    EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
    return folder_ / name + "/results.json";
  }

  Finished merge(std::vector<std::string> files) {
    files.insert(files.begin(), "merge");
    files.insert(files.end(), {"--out", folder_ / "merged"});
    return run_tool(files);
  }

  /// What stands in each report of a folder.
  void expect_alike(const std::string& one, const std::string& other) {
    const auto counts_of = [&](const std::string& out) {
      return nlohmann::json::parse(read_text(out + "/results.json"));
    };
    EXPECT_EQ(counts_of(one)["counts"], counts_of(other)["counts"]);
    Junit a, b;
    read_junit(one + "/junit.xml", a);
    read_junit(other + "/junit.xml", b);
    EXPECT_EQ(std::tie(a.tests, a.failures, a.errors, a.skipped, a.children),
              std::tie(b.tests, b.failures, b.errors, b.skipped, b.children));
    const auto tiles = [](const std::string& out) {
      const std::string html = read_text(out + "/report.html");
      const std::size_t start = html.find("<ul class=\"tiles\">");
      return html.substr(start, html.find("</ul>", start) - start);
    };
    EXPECT_THAT(tiles(one), HasSubstr("data-count=\"PASS\""));
    EXPECT_EQ(tiles(one), tiles(other));
  }

  TestFolder folder_;
};

TEST_F(MergeCommand, ShardsAddUpToTheWholeRun) {
  const std::vector<std::string> real{"--filter", "xgt_cnet/rss/*"};
  shard(-1, "whole", real);
  for (int index = 0; index < shard_count; ++index) shard(index, std::to_string(index), real);
  const Finished merged =
      merge({folder_ / "2/results.json", folder_ / "0/results.json", folder_ / "1/results.ndjson"});
  EXPECT_EQ(merged.code, 0) << merged.out << merged.err;
  expect_reports(folder_ / "merged");
  expect_alike(folder_ / "whole", folder_ / "merged");
}

TEST_F(MergeCommand, AMissingShardIsNamedAndRed) {
  const Finished finished = merge({shard(0, "a"), shard(2, "c")});
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, HasSubstr("shard 2/3 is missing"));
  expect_reports(folder_ / "merged");
}

TEST_F(MergeCommand, AKilledShardIsNamedAndRed) {
  shard(0, "a");
  shard(1, "b");
  shard(2, "c");
  const std::string ndjson = read_text(folder_ / "b/results.ndjson");
  const std::string killed = folder_.write("killed.ndjson", ndjson.substr(0, ndjson.size() / 2));
  const Finished finished = merge({folder_ / "a/results.json", killed, folder_ / "c/results.json"});
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, HasSubstr("killed.ndjson: the run was killed after"));
}

TEST_F(MergeCommand, OtherSelectionsAndTheSameShardTwiceAreRefused) {
  const std::string a = shard(0, "a");
  const Finished twice = merge({a, shard(0, "again")});
  EXPECT_EQ(twice.code, 2);
  EXPECT_THAT(twice.err, HasSubstr("both are shard 1/3"));
  const Finished other =
      merge({a, shard(1, "b", {"--vectors", folder_ / "vectors", "--filter", "*/n1000:*/n1001"})});
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err,
              AllOf(HasSubstr("the selection differs"), HasSubstr("b/results.json with")));
}

TEST_F(MergeCommand, OtherVectorsAreRefused) {
  const std::string a = shard(0, "a");
  const std::string b = shard(1, "b", {"--vectors", write_vectors(folder_, many_vectors(8))});
  const Finished finished = merge({a, b});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, HasSubstr("the vectors differ: "));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "merged")) << "nothing is written";
}

TEST_F(MergeCommand, NothingIsOverwritten) {
  const std::string a = shard(0, "a");
  const Finished finished =
      run_tool({"merge", folder_ / "a/results.ndjson", "--out", folder_ / "a"});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err, HasSubstr("would overwrite"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
