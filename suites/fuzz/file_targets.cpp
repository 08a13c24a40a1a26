#include "suites/fuzz/file_targets.hpp"

#include <filesystem>
#include <string>

#include "harness/bench/files/bench_file.hpp"
#include "harness/bench/files/profile.hpp"
#include "harness/bench/files/waivers.hpp"
#include "harness/notation/notation.hpp"
#include "harness/paths.hpp"
#include "harness/safety/journal.hpp"
#include "harness/vectors/loader.hpp"
#include "reports/results/ndjson.hpp"
#include "reports/results/whole_file.hpp"
#include "src/user_frames/definition.hpp"
#include "suites/fuzz/chosen.hpp"
#include "suites/fuzz/rule.hpp"
#include "suites/fuzz/unnamed.hpp"

namespace fieldproof::fuzz {

namespace {

namespace fs = std::filesystem;

Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

/// The files of a folder of the project that are small enough to be changed.
std::vector<Bytes> files_of(const fs::path& folder, std::size_t most = 20'000) {
  std::vector<Bytes> all;
  std::error_code ignored;
  for (const fs::directory_entry& one : fs::recursive_directory_iterator(folder, ignored))
    if (one.path().extension() == ".json" && one.file_size() < most)
      if (const Result<std::string> text = results::read_whole_file(one.path()))
        all.push_back(bytes_of(*text));
  return all;
}

std::optional<harness::Protocol::WordName> any_word(std::string_view text) {
  return suites::protocols().read_word(text);
}

}  // namespace

void feed_notation(ByteView input) {
  const Result<notation::Notation> read = notation::parse_notation(to_text(input));
  if (!read) return;
  const std::string printed = notation::print(*read);
  const Result<notation::Notation> again = notation::parse_notation(printed);
  const bool same = again && notation::print(*again) == printed;
  if (!same)
    std::fprintf(stderr, "'%s' is printed as '%s'\n", to_text(input).c_str(), printed.c_str());
  rule(same, "printed notation reads the same again");
}

void feed_vectors(ByteView input) {
  vectors::VectorSet set;
  try {
    vectors::load_vector_text(to_text(input), "input.json", set,
                              {.protocols = suites::protocols()});
  } catch (const std::exception&) {
    // It is no JSON, or no list: who reads files says so.
  }
}

void feed_profile(ByteView input) {
  [[maybe_unused]] const auto read = bench::parse_profile(to_text(input), "input.json", {});
}

void feed_bench(ByteView input) {
  [[maybe_unused]] const auto read =
      bench::parse_bench_file(to_text(input), "input.json", any_word);
}

void feed_waivers(ByteView input) {
  [[maybe_unused]] const auto read = bench::parse_waivers(to_text(input), "input.json");
}

void feed_definition(ByteView input) {
  [[maybe_unused]] const auto read =
      user_frames::parse_frame_definition(to_text(input), "input.json");
}

void feed_journal(ByteView input) {
  [[maybe_unused]] const auto read = safety::read_journal(Unnamed(input).path());
}

void feed_results(ByteView input) {
  [[maybe_unused]] const auto read =
      results::read_ndjson(Unnamed(input).path(), [](const results::CaseResult&) {});
}

std::vector<Bytes> good_notation() {
  std::vector<Bytes> all;
  for (const vectors::Case& one : cases_of_vectors())
    for (const vectors::Step& step : one.steps)
      for (const vectors::Frame& frame : step.frames) all.push_back(bytes_of(frame.text));
  return all;
}

std::vector<Bytes> good_vectors() { return files_of(harness::find_data().vectors); }
std::vector<Bytes> good_profiles() { return files_of(harness::find_data().profiles); }
std::vector<Bytes> good_definitions() { return files_of(harness::find_data().definitions); }

std::vector<Bytes> good_benches() {
  return {bytes_of(
      R"({"devices": {"c41a": {"endpoint": "serial:/dev/ttyUSB0", "profile": "xbl-c41a", "station": 3, "line": {"baud": 38400, "frame": "8N1"},
 "identity": {"serial": "1", "firmware": "1.2"}, "fingerprint": {"areas": "PMLK"}, "allow_write": ["M100-M199", "D0"], "operator": "J. Kim", "notes": "port 2"}}})")};
}

std::vector<Bytes> good_waivers() {
  return {bytes_of(
      R"([{"id": "xgt_cnet/rss/*", "reason": "firmware", "owner": "J. Kim", "text": "known", "expires": "2027-01-01", "firmware": {"from": "1.0", "to": "1.2"}}])")};
}

std::vector<Bytes> good_journals() {
  return {bytes_of(
      R"({"save": {"number": 1, "device": {"endpoint": "serial:/dev/ttyUSB0", "station": 1, "protocol": "xgt-cnet", "model": "xbc-h", "config": {}}, "address": "%MW100", "value": "00E2"}}
{"restored": 1}
)")};
}

std::vector<Bytes> good_results() {
  return {bytes_of(
      R"({"run":{"endpoint":"emulator:","profile":"emulator","started":"2026-01-01T00:00:00+00:00","version":"0.1.0"}}
{"case":{"basis":"printed rule","id":"xgt_cnet/rss/one","level":"must","protocol":"xgt-cnet","title":"t","verdict":"PASS","exchange":[{"kind":"sent","hex":"05 30","start_ms":0,"end_ms":1}]}}
{"end":{"cases":1,"complete":true}}
)")};
}

}  // namespace fieldproof::fuzz
