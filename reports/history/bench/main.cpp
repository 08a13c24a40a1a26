// fieldproof_history_bench FILE [RUNS [CASES [DEVICES]]]: makes a history of runs on real time, no
// two of which are alike, and says how long each question to it takes, from opening the file on.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <stdexcept>

#include "reports/history/matrix_html.hpp"
#include "reports/history/matrix_text.hpp"
#include "reports/history/run_list.hpp"
#include "reports/history/trend_html.hpp"
#include "reports/history/trend_text.hpp"

namespace fieldproof::history {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int versions = 8, topics = 100;

template <typename T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

class Generator {
 public:
  Generator(int runs, int cases, int devices) : runs_(runs), devices_(devices) {
    for (int i = 0; i < cases; ++i) {
      compare::CaseSummary& one =
          run_.cases[fmt::format("protocol/topic_{:02}/case_{:05}", i % topics, i)];
      one.title = fmt::format("Case {}", i);
      one.manual = "manual";
      one.section = fmt::format("7.{}.{}", i % topics / 10 + 1, i % 10 + 1);
      one.rev = one.repetitions = one.with_verdict = 1;
    }
    run_.run.tool_version = "0.1.0";
    run_.run.vectors_hash = "a9139e5e0165ddf7";
    run_.run.profile = "profile";
    run_.run.properties = {{"gate", "default"}, {"protocol", "protocol"}, {"station", "1"}};
  }

  /// Times that scatter, some cases skipped, a few that fail now and then with a time in the text.
  const compare::RunSummary& next() {
    const int device = count_ % devices_, version = count_ * versions / runs_;
    run_.run.identity = {fmt::format("plc{}", device),
                         "LS ELECTRIC",
                         "C41A",
                         fmt::format("2219-{:05}", device),
                         fmt::format("V1.{}", version),
                         "",
                         "",
                         {},
                         {}};
    run_.run.endpoint = fmt::format("serial:/dev/ttyUSB{}", device);
    const std::time_t now = 1'700'000'000 + std::time_t{count_} * 3600;
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S+00:00", std::gmtime(&now));
    run_.run.started = text;
    run_.tally = {};
    const double speed = version < versions / 2 ? 4 : 6;
    std::size_t index = 0;
    for (auto& [name, one] : run_.cases) {
      const std::uint32_t chance = random_();
      one.verdict = index++ % 7 == 0     ? results::Verdict::skip
                    : chance % 1000 == 0 ? results::Verdict::fail
                                         : results::Verdict::pass;
      one.message = one.verdict == results::Verdict::skip ? "outside the profile of the device"
                    : one.verdict == results::Verdict::fail
                        ? fmt::format("no reply within {} ms", chance % 977)
                        : "";
      one.response_ms.clear();
      if (one.verdict == results::Verdict::pass)
        one.response_ms.push_back(speed + static_cast<double>(random_() % 1'000'000) / 1e6);
      run_.tally.add(one.verdict);
    }
    run_.end = results::RunEnd{};
    run_.end->seconds = 120;
    ++count_;
    return run_;
  }

 private:
  int runs_, devices_, count_ = 0;
  std::mt19937 random_{7};
  compare::RunSummary run_;
};

void measure(const char* what, const auto& work) {
  const auto started = Clock::now();
  const std::size_t size = work();
  fmt::print("{:<34} {:>8.0f} ms {:>12} bytes\n", what,
             std::chrono::duration<double, std::milli>(Clock::now() - started).count(), size);
}

History open_file(const std::string& path, Use use = Use::read) {
  return must(History::open(path, use));
}

int run_bench(const std::string& path, int runs, int cases, int devices) {
  Generator generator(runs + 1, cases, devices);
  measure("make it", [&] {
    History history = open_file(path, Use::write);
    for (int i = 0; i < runs; ++i) must(history.add(generator.next()));
    return std::filesystem::file_size(path);
  });
  const compare::RunSummary& last = generator.next();
  measure("last run of a device (--baseline)",
          [&] { return must(open_file(path).last_before(last))->cases.size(); });
  measure("add", [&] {
    must(open_file(path, Use::write).add(last));
    return std::filesystem::file_size(path);
  });
  measure("list", [&] { return list_text(must(open_file(path).runs()), 20).size(); });
  measure("list --json", [&] { return list_json(must(open_file(path).runs())).size(); });
  measure("show", [&] {
    History history = open_file(path);
    const RunEntry entry = must(history.runs()).back();
    return show_text(entry, must(history.summary(entry.number))).size();
  });
  for (const Columns by : {Columns::device, Columns::firmware}) {
    MatrixOptions options;
    options.by = by;
    measure(by == Columns::device ? "matrix" : "matrix --by firmware", [&] {
      History history = open_file(path);
      return matrix_text(must(matrix_of(history, options))).size();
    });
  }
  measure("matrix --html", [&] {
    History history = open_file(path);
    return matrix_html(must(matrix_of(history, {}))).size();
  });
  measure("trend", [&] {
    History history = open_file(path);
    return trend_text(must(trend_of(history, "", 0))).size();
  });
  measure("trend --html", [&] {
    History history = open_file(path);
    return trend_html(must(trend_of(history, "", 0))).size();
  });
  return 0;
}

}  // namespace

}  // namespace fieldproof::history

int main(int argc, char** argv) {
  if (argc < 2 || std::filesystem::exists(argv[1])) {
    fmt::print(stderr, "usage: fieldproof_history_bench NEW_FILE [RUNS [CASES [DEVICES]]]\n");
    return 2;
  }
  const auto number = [&](int at, int usual) { return argc > at ? std::atoi(argv[at]) : usual; };
  return fieldproof::history::run_bench(argv[1], number(2, 10'000), number(3, 10'000),
                                        number(4, 5));
}
