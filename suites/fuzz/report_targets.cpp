#include "suites/fuzz/report_targets.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "harness/paths.hpp"
#include "harness/run/run_report.hpp"
#include "reports/capture.hpp"
#include "reports/compare/result_file.hpp"
#include "reports/results/ndjson.hpp"
#include "reports/results/whole_file.hpp"
#include "suites/fuzz/rule.hpp"
#include "suites/fuzz/unnamed.hpp"

namespace fieldproof::fuzz {

namespace {

namespace fs = std::filesystem;

/// A folder for reports that goes with this process.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "fieldproof_fuzz_XXXXXX").string();
    rule(::mkdtemp(name.data()) != nullptr, "there is a folder for temporary files");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  std::string operator/(const char* name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

const Folder& folder() {
  static const Folder one;
  return one;
}

std::string read(const std::string& path) {
  const Result<std::string> text = results::read_whole_file(path);
  rule(bool(text), "a report is there");
  return *text;
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= static_cast<std::uint32_t>(static_cast<Byte>(bytes[at + i])) << (8 * i);
  return value;
}

void must_be_blocks(const std::string& capture) {
  for (std::size_t at = 0; at < capture.size();) {
    rule(capture.size() - at >= 12, "a block has a head and an end");
    const std::size_t length = number_at(capture, at + 4);
    rule(length % 4 == 0 && length >= 12 && length <= capture.size() - at, "a block is whole");
    rule(number_at(capture, at + length - 4) == length, "a block says its length twice");
    at += length;
  }
}

void replay(ByteView input, results::Sink& sink, const std::function<void()>& look) {
  if (const auto log = results::replay(Unnamed(input).path(), sink)) look();
}

std::string testdata(const char* name) {
  const auto file = harness::find_data().vectors.parent_path() / "reports/testdata" / name;
  const Result<std::string> text = results::read_whole_file(file);
  return text ? *text : "";
}

}  // namespace

void feed_reports(ByteView input) {
  results::Sinks sinks = run::sinks_for({{"json", folder() / "r.json"},
                                         {"junit", folder() / "r.xml"},
                                         {"html", folder() / "r.html"},
                                         {"csv", folder() / "csv"}});
  replay(input, sinks, [&] {
    rule(sinks.troubles().empty(), "what can be read can be reported");
    rule(bool(compare::read_result_file(folder() / "r.json")), "our JSON can be read again");
    rule(bool(compare::read_result_file(folder() / "r.xml")), "our JUnit can be read again");
  });
}

void feed_pcapng(ByteView input) {
  const std::string path = folder() / "r.pcapng";
  const std::unique_ptr<results::Sink> capture = reports::capture_report(path);
  replay(input, *capture, [&] { must_be_blocks(read(path)); });
}

std::vector<Bytes> good_reports() {
  const std::string all = testdata("results-1.ndjson");
  std::vector<Bytes> seeds{to_bytes(all)};
  std::istringstream lines(all);
  std::string head, line;
  std::getline(lines, head);
  while (std::getline(lines, line)) seeds.push_back(to_bytes(head + '\n' + line + '\n'));
  return seeds;
}

void feed_others(ByteView input) {
  const auto file = compare::read_result_file(Unnamed(input).path());
  rule(file || !file.error().message.empty(), "an error says what is wrong");
}

std::vector<Bytes> good_others() {
  return {to_bytes(testdata("results-1.json")), to_bytes(testdata("results-1.xml")),
          to_bytes("<testsuites><testsuite name='a'><testcase name='b' time='1'><failure "
                   "message='c'>d</failure></testcase><testcase name='e'><skipped/></testcase>"
                   "</testsuite></testsuites>")};
}

}  // namespace fieldproof::fuzz
