// The built tool against its own emulator: the run that every user starts with, and what steers it.
#include <gmock/gmock.h>
#include <sched.h>

#include <cmath>
#include <memory>
#include <sstream>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;

std::size_t count(const std::string& verdict) {
  const auto counts = default_run().results.counts();
  const auto found = counts.find(verdict);
  return found == counts.end() ? 0 : found->second;
}

TEST(DefaultRuns, is_green) {
  EXPECT_EQ(default_run().finished.code, 0)
      << default_run().finished.out << default_run().finished.err;
  EXPECT_EQ(default_run().finished.err, "");
  EXPECT_GT(default_run().results.cases.size(), 1000u);
  EXPECT_EQ(default_run().results.end.at("exit_code"), default_run().finished.code);
}

TEST(DefaultRuns, judges_each_listed_case_once) {
  const Finished list = run_tool({"list", "--json"});
  ASSERT_EQ(list.code, 0) << list.err;
  std::vector<std::string> listed;
  for (const nlohmann::json& one : nlohmann::json::parse(list.out)) listed.push_back(one.at("id"));
  EXPECT_EQ(default_run().results.ids(), listed);
}

TEST(DefaultRuns, junit_is_valid_and_its_names_are_unique) {
  expect_valid_junit(default_run().out() + "/junit.xml");
  Junit junit;
  read_junit(default_run().out() + "/junit.xml", junit);
  EXPECT_EQ(junit.cases.size(), junit.children);
}

TEST(DefaultRuns, counts_of_junit_are_those_of_the_results) {
  Junit junit;
  read_junit(default_run().out() + "/junit.xml", junit);
  EXPECT_EQ(junit.tests, default_run().results.cases.size());
  EXPECT_EQ(junit.children, default_run().results.cases.size());
  EXPECT_EQ(junit.failures, count("FAIL") + count("XPASS"));
  EXPECT_EQ(junit.failures, junit.with("failure"));
  EXPECT_EQ(junit.errors, count("ERROR"));
  EXPECT_EQ(junit.errors, junit.with("error"));
  EXPECT_EQ(junit.skipped,
            count("SKIP") + count("BLOCKED") + count("INCONCLUSIVE") + count("XFAIL"));
  EXPECT_EQ(junit.skipped, junit.with("skipped"));
}

TEST(DefaultRuns, counts_of_json_and_console_are_those_of_the_results) {
  nlohmann::json counts =
      nlohmann::json::parse(read_text(default_run().out() + "/results.json")).at("counts");
  EXPECT_EQ(counts["total"], default_run().results.cases.size());
  counts.erase("total");
  std::map<std::string, std::size_t> console;
  std::istringstream lines(default_run().finished.out);
  for (std::string line;
       std::getline(lines, line);) {  // "  2199  PASS          as the manual says"
    std::istringstream words(line);
    std::size_t number = 0;
    std::string verdict;
    if (line.starts_with("  ") && words >> number >> verdict) console[verdict] = number;
  }
  EXPECT_EQ(console, default_run().results.counts());
  for (const auto& [verdict, number] : counts.items()) EXPECT_EQ(number, count(verdict)) << verdict;
  EXPECT_THAT(default_run().finished.out,
              HasSubstr("\n" + std::to_string(default_run().results.cases.size()) + " cases in "));
}

/// The first of those that this process may use.
std::string first_processor() {
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT_EQ(::sched_getaffinity(0, sizeof set, &set), 0);
  int first = 0;
  while (first < CPU_SETSIZE - 1 && !CPU_ISSET(first, &set)) ++first;
  return std::to_string(first);
}

/// Its times, counted from its first event on: where that stands depends on the cases before.
void count_from_its_beginning(nlohmann::json& result) {
  if (result["exchange"].empty()) return;
  const double begun = result["exchange"][0]["start_ms"];
  const auto count = [&](nlohmann::json& of, const char* key) {
    if (of.contains(key)) of[key] = std::llround((of[key].get<double>() - begun) * 1e6);
  };
  for (nlohmann::json& event : result["exchange"])
    for (const char* key : {"start_ms", "end_ms"}) count(event, key);
  for (nlohmann::json& step : result["recording"]["steps"]) count(step, "stimulus_ms");
}

/// Several threads run the cases of the default run: each result is that of one case after another.
TEST(DefaultRuns, each_result_is_that_of_one_processor) {
  const TestFolder folder;
  std::vector<std::string> arguments = tool_arguments(
      {"run", "--filter", "modbus_tcp/*:hs_link/*:xgt_cnet/rss/*", "--out", folder.path()});
  arguments.insert(arguments.begin(), {"taskset", "--cpu-list", first_processor()});
  const Finished finished = run_program(arguments);
  ASSERT_EQ(finished.code, 0) << finished.out << finished.err;
  const Results alone = read_results(folder / "results.ndjson");
  EXPECT_GT(alone.cases.size(), 500u);
  std::map<std::string, const nlohmann::json*> by_id;
  for (const nlohmann::json& one : default_run().results.cases) by_id[one.at("id")] = &one;
  for (nlohmann::json one : alone.cases) {
    nlohmann::json same = *by_id.at(one.at("id"));
    for (nlohmann::json* result : {&one, &same}) {
      result->erase("seconds");
      result->erase("replay");  // has the filter
      count_from_its_beginning(*result);
    }
    ASSERT_EQ(one, same);
  }
}

/// What steers a run does not ask how many cases there are: sixty are quick.
constexpr int some = 60;

std::vector<std::string> order(const std::vector<std::string>& more,
                               const ProcessOptions& options = {}) {
  const TestFolder folder;
  std::vector<std::string> arguments{"run", "--vectors", write_vectors(folder, many_vectors(some)),
                                     "--out", folder / "out"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Finished finished = run_tool(arguments, options);
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  return read_results(folder / "out/results.ndjson").ids();
}

/// Threads have begun cases behind it: nobody is told of them.
TEST(EmulatorRun, fail_fast_ends_with_the_case_that_failed) {
  const TestFolder folder;
  std::vector<nlohmann::ordered_json> vectors = many_vectors(400);
  vectors[300] = small_vector("many/n1300", wrong_word);
  for (const char* repeat : {"1", "3"}) {
    const Finished finished =
        run_tool({"run", "--vectors", write_vectors(folder, vectors), "--fail-fast", "--repeat",
                  repeat, "--out", folder / "out"});
    EXPECT_EQ(finished.code, 1) << finished.out << finished.err;
    const Results results = read_results(folder / "out/results.ndjson");
    ASSERT_EQ(results.cases.size(), 301u);
    EXPECT_EQ(results.cases.back().at("verdict"), "FAIL");
  }
}

TEST(EmulatorRun, repeats_come_round_by_round) {
  const TestFolder folder;
  const Finished finished = run_tool({"run", "--vectors", write_vectors(folder, many_vectors(100)),
                                      "--repeat", "3", "--out", folder / "out"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  const Results results = read_results(folder / "out/results.ndjson");
  ASSERT_EQ(results.cases.size(), 300u);
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_EQ(results.cases[i].at("id"), results.cases[i % 100].at("id"));
    EXPECT_EQ(results.cases[i].value("repeat", 0u), i / 100);
  }
}

TEST(EmulatorRun, seed_settles_the_order) {
  const std::vector<std::string> plain = order({});
  const std::vector<std::string> seven = order({"--seed", "7"});
  EXPECT_EQ(plain.size(), std::size_t(some));
  EXPECT_EQ(seven, order({"--seed", "7"}));
  EXPECT_NE(seven, order({"--seed", "8"}));
  EXPECT_NE(seven, plain);
  EXPECT_THAT(seven, testing::UnorderedElementsAreArray(plain));
}

/// Each PLC has areas and sizes of its own: no case of it asks for others.
TEST(EmulatorRun, each_model_is_green) {
  for (const char* model : {"xbm-s", "xec-h", "inverter", "xd"}) {
    const TestFolder folder;
    const Finished finished =
        run_tool({"run", "--endpoint", std::string("emulator:") + model, "--out", folder.path()});
    EXPECT_EQ(finished.code, 0) << model << finished.out << finished.err;
  }
}

TEST(EmulatorRun, shards_are_a_partition) {
  std::vector<std::string> all;
  for (int shard = 0; shard < 3; ++shard) {
    const std::vector<std::string> part = order(
        {},
        {.environment = {{"GTEST_TOTAL_SHARDS", "3"}, {"GTEST_SHARD_INDEX", std::to_string(shard)}},
         .folder = ""});
    EXPECT_FALSE(part.empty());
    all.insert(all.end(), part.begin(), part.end());
  }
  EXPECT_THAT(all, testing::UnorderedElementsAreArray(order({})));
}

TEST(EmulatorRun, empty_shard_is_green_with_reports) {
  const TestFolder folder;
  const std::string vectors = write_vectors(folder, {small_vector("one/alone")});
  std::size_t sum = 0;
  for (const std::string& shard : {std::string("0"), std::string("1")}) {
    const std::string out = folder / ("out" + shard);
    const Finished finished = run_tool(
        {"run", "--vectors", vectors, "--out", out},
        {.environment = {{"GTEST_TOTAL_SHARDS", "2"}, {"GTEST_SHARD_INDEX", shard}}, .folder = ""});
    EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
    expect_reports(out);
    sum += read_results(out + "/results.ndjson").cases.size();
  }
  EXPECT_EQ(sum, 1u);
}

/// GoogleTest would take its filter from the environment, and a job that runs nothing would be
/// green.
TEST(EmulatorRun, environment_cannot_empty_the_selection) {
  const TestFolder folder;
  const std::string vectors = write_vectors(folder, {small_vector("one/alone")});
  const Finished finished =
      run_tool({"run", "--vectors", vectors, "--out", folder / "out"},
               {.environment = {{"GTEST_FILTER", "no_such_test"}}, .folder = ""});
  const bool executed = read_results(folder / "out/results.ndjson").cases.size() == 1;
  EXPECT_TRUE(executed || finished.code != 0) << "exit 0 with nothing executed\n" << finished.out;
}

TEST(EmulatorRun, repeat_judges_each_case_so_often) {
  const TestFolder folder;
  const std::vector<std::string> once = order({});
  const Finished finished = run_tool({"run", "--vectors", write_vectors(folder, many_vectors(some)),
                                      "--repeat", "3", "--out", folder / "out"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  std::map<std::string, std::set<int>> repeats;
  const Results results = read_results(folder / "out/results.ndjson");
  for (const nlohmann::json& one : results.cases)
    repeats[one.at("id")].insert(one.value("repeat", 0));
  EXPECT_EQ(results.cases.size(), 3 * once.size());
  for (const std::string& id : once) EXPECT_EQ(repeats[id], (std::set<int>{0, 1, 2})) << id;
  expect_reports(folder / "out");
  Junit junit;
  read_junit(folder / "out/junit.xml", junit);
  EXPECT_EQ(junit.cases.size(), results.cases.size()) << "names are not unique";
}

TEST(EmulatorRun, fail_fast_stops_at_the_first_red_case) {
  const TestFolder folder;
  const std::string vectors = write_vectors(
      folder, {small_vector("fast/a"), small_vector("fast/b", wrong_word), small_vector("fast/c")});
  const Finished all = run_tool({"run", "--vectors", vectors, "--out", folder / "all"});
  const Finished fast =
      run_tool({"run", "--vectors", vectors, "--out", folder / "fast", "--fail-fast"});
  EXPECT_EQ(all.code, 1);
  EXPECT_EQ(fast.code, 1);
  EXPECT_THAT(read_results(folder / "all/results.ndjson").ids(), testing::SizeIs(3));
  EXPECT_THAT(read_results(folder / "fast/results.ndjson").ids(),
              testing::ElementsAre("xgt_cnet/fast/a", "xgt_cnet/fast/b"));
  expect_reports(folder / "fast");
}

TEST(EmulatorRun, dry_run_starts_and_writes_nothing) {
  const TestFolder folder;
  const std::string vectors = write_vectors(folder, many_vectors(5));
  const Finished finished =
      run_tool({"run", "--endpoint", "exec:touch " + quoted(folder / "started") + "; cat",
                "--profile", "xbc-h", "--vectors", vectors, "--out", folder / "out", "--dry-run"});
  EXPECT_EQ(finished.code, 0) << finished.err;
  for (int i = 0; i < 5; ++i)
    EXPECT_THAT(finished.out, HasSubstr("xgt_cnet/many/n100" + std::to_string(i)));
  EXPECT_FALSE(std::filesystem::exists(folder / "started"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(EmulatorRun, filter_without_a_match_is_an_error) {
  const TestFolder folder;
  const std::string vectors = write_vectors(folder, {small_vector("rss/one")});
  const auto filtered = [&](const char* filter) {
    return run_tool({"run", "--vectors", vectors, "--filter", filter, "--out", folder / "out"});
  };
  const Finished finished = filtered("xgt_cnet/nonsense*");
  EXPECT_EQ(finished.code, 4);
  EXPECT_THAT(finished.err, HasSubstr("no case matches --filter 'xgt_cnet/nonsense*'"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  for (const char* slip : {"xgt_cnet/rsss/*", "xgt_cnet/rs/*", "xgt-cnet/rss/*"})
    EXPECT_THAT(filtered(slip).err, HasSubstr("did you mean 'xgt_cnet/rss'?")) << slip;
}

TEST(CommandLine, AMistypedWordIsSaid) {
  const auto says = [](std::vector<std::string> arguments, const char* what) {
    const Finished finished = run_tool(std::move(arguments));
    EXPECT_EQ(finished.code, 2);
    EXPECT_THAT(finished.err, testing::StartsWith("fieldproof: "));
    EXPECT_THAT(finished.err, HasSubstr(what));
  };
  says({"run", "--filer", "x"}, "did you mean '--filter'?");
  says({"lint", "--vectrs=x"}, "did you mean '--vectors'?");
  says({"runn"}, "did you mean 'run'?");
  says({"--filer", "x"}, "did you mean '--filter' of fieldproof run?");
  says({"--filter", "x"}, "--filter is an option of fieldproof run, which stands in front of it");
  says({"run", "--seed", "x"}, "--seed");
}

TEST(FrameCommand, SaysThatAFrameIsIncompleteOrFollowed) {
  const Finished cut = run_tool({"frame", "--protocol", "xgt-cnet", "05 30 31 72 53 53"});
  EXPECT_EQ(cut.code, 1);
  EXPECT_THAT(cut.out, HasSubstr("the frame is incomplete"));
  for (const auto& [frame, missing] :
       {std::pair{"05 30 31 72 53 53 30 31 30 36 25 4D 57 31 30 30", "no EOT and no BCC follow"},
        {"05 30 31 72 53 53 30 31 30 36 25 4D 57 31", "cut short: 4 of 6 characters"},
        {"01 03 00", "5 of 8 bytes are missing"},
        {"3A 30 31 30 33", "no CR LF follows"}}) {
    const Finished finished = run_tool({"frame", frame});
    EXPECT_EQ(finished.code, 1) << frame;
    EXPECT_THAT(finished.out,
                testing::AllOf(HasSubstr("the frame is incomplete"), HasSubstr(missing)))
        << frame;
  }
  // A company id tells the protocol, however little follows it.
  const std::string reply =
      "4C 53 49 53 2D 58 47 54 00 00 00 00 A0 33 01 00 0E 00 00 00 54 00 02 00";
  for (const std::size_t size : {24, 20, 12, 8}) {
    const Finished finished = run_tool({"frame", reply.substr(0, 3 * size - 1)});
    EXPECT_EQ(finished.code, 1) << size;
    EXPECT_THAT(finished.out,
                testing::AllOf(HasSubstr("xgt-fenet, "), HasSubstr("the frame is incomplete")))
        << size;
    const std::string hex = reply.substr(0, 3 * size - 1) + '\n';
    EXPECT_EQ(finished.out.find(hex + hex), std::string::npos) << finished.out;
  }
  const Finished more = run_tool(
      {"frame", "--protocol", "xgt-cnet", "05 30 31 52 53 53 30 31 30 36 25 4D 57 31 30 30 04 41"});
  EXPECT_EQ(more.code, 1);
  EXPECT_THAT(more.out, HasSubstr("the frame ends after 17 bytes; 1 more follow it"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
