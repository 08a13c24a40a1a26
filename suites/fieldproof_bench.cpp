// fieldproof_bench: the figures of the README. Times are measured here and never asserted in a
// test. Besides the options of Google Benchmark it takes
//   --against TOOL   another build of the tool, measured in turn with this one ("before")
//   --brief          runs through all of it with hardly a repetition, to see that it can
// The tool is FIELDPROOF_EXECUTABLE, else `fieldproof` beside this program.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "harness/bench/bench.hpp"
#include "harness/paths.hpp"
#include "harness/system/pty_pair.hpp"
#include "harness/vectors/loader.hpp"
#include "src/line/line.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/xgt_cnet/p2p_driver.hpp"
#include "src/xgt_cnet/plc.hpp"
#include "src/xnet_network/network.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::suites {

using endpoints::Endpoint;

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

const harness::Protocol& xgt() { return *protocols().find("xgt-cnet"); }

std::unique_ptr<Endpoint> open(const std::string& text) {
  Result<std::unique_ptr<Endpoint>> endpoint =
      endpoints::open_endpoint(*endpoints::parse_endpoint(text), xgt());
  if (!endpoint) throw std::runtime_error(endpoint.error().message);
  return std::move(*endpoint);
}

/// A one-word RSS and its ACK.
const char* one_word =
    R"j([{"id": "xgt_cnet/bench/one_word", "rev": 1, "title": "read one word", "level": "must", "basis": "printed rule",
  "statement": "m/1", "source": {"manual": "m", "section": "1", "quote": "as printed"},
  "steps": [{"send": "[ENQ st 'rSS' '01' name(%MW100) EOT BCC]"}, {"expect": "[ACK st 'rSS' '01' '02' '0000' ETX BCC]"}]}])j";

struct OneWord {
  vectors::VectorSet set;
  exchange::PreparedCase prepared;
  OneWord() {
    vectors::load_vector_text(one_word, "bench", set);
    prepared = *exchange::prepare(set.cases.at(0), 1, xgt());
  }
};

double median(std::vector<double>& samples) {
  std::ranges::nth_element(samples,
                           samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2));
  return samples[samples.size() / 2];
}

void judge_or_throw(const exchange::PreparedCase& prepared,
                    const exchange::Transcript& transcript) {
  const judging::Judgement judgement = judging::judge(prepared, transcript, {}, xgt());
  if (judgement.verdict != results::Verdict::pass) throw std::runtime_error(judgement.message);
}

void in_process_exchange(benchmark::State& state) {
  const OneWord one;
  const std::unique_ptr<Endpoint> endpoint = open("emulator:xbc-h");
  exchange::Exchange exchange(*endpoint, xgt(), {});
  for (auto _ : state) {
    (void)_;
    judge_or_throw(one.prepared, exchange.run_steps(one.prepared));
  }
  state.SetItemsProcessed(state.iterations());
}

void whole_suite(benchmark::State& state) {
  const harness::DataPaths data = harness::find_data();
  const vectors::VectorSet set = vectors::load_vectors(data.vectors, {protocols()});
  const std::unique_ptr<Endpoint> endpoint = open("emulator:");
  bench::BenchOptions options;
  options.profile = *bench::load_profile("emulator", data.profiles);
  for (auto _ : state) {
    (void)_;
    bench::Bench bench(*endpoint, xgt(), options);
    for (const vectors::Case& source : set.cases) benchmark::DoNotOptimize(bench.run(source));
  }
  state.counters["cases"] = static_cast<double>(set.cases.size());
}

void load_all_vectors(benchmark::State& state) {
  for (auto _ : state) {
    (void)_;
    benchmark::DoNotOptimize(vectors::load_vectors(harness::find_data().vectors, {protocols()}));
  }
}

/// Another process on the slave that answers `request` bytes with `reply` bytes: what no harness
/// could beat.
class BareEcho {
 public:
  BareEcho(int slave, std::size_t request, std::size_t reply) : child_(fork()) {
    if (child_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // and no descriptor of the bench is kept from closing
    close_range(3, static_cast<unsigned>(slave) - 1, 0);
    close_range(static_cast<unsigned>(slave) + 1, ~0U, 0);
    Bytes buffer(256);
    const Bytes answer(reply, 'x');
    for (std::size_t have = 0;;) {
      const ssize_t got = read(slave, buffer.data(), buffer.size());
      if (got <= 0) _exit(0);
      have += static_cast<std::size_t>(got);
      if (have < request) continue;
      have = 0;
      if (write(slave, answer.data(), answer.size()) < 0) _exit(1);
    }
  }
  ~BareEcho() {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }

 private:
  pid_t child_;
};

double bare_round_trip_us(int master, const Bytes& request, std::size_t reply) {
  Bytes buffer(256);
  const auto started = Clock::now();
  if (write(master, request.data(), request.size()) < 0)
    throw std::runtime_error("bare write failed");
  for (std::size_t have = 0; have < reply;)
    have +=
        static_cast<std::size_t>(std::max<ssize_t>(0, read(master, buffer.data(), buffer.size())));
  return std::chrono::duration<double, std::micro>(Clock::now() - started).count();
}

/// Both kinds in turn, so that they see the same machine.
void pty_exchange_against_bare_ping_pong(benchmark::State& state) {
  const OneWord one;
  const std::unique_ptr<Endpoint> endpoint = open("pty:xbc-h");
  if (!endpoint->begin(nlohmann::json::object())) throw std::runtime_error("cannot begin");
  exchange::Exchange exchange(*endpoint, xgt(), {});
  const Bytes request = one.prepared.steps[0].frames[0].frame.bytes;
  const std::size_t reply = one.prepared.steps[1].frames[0].frame.bytes.size();
  Result<os::PtyPair> pair = os::open_pty_pair();
  if (!pair) throw std::runtime_error(pair.error().message);
  const BareEcho echo(pair->slave.get(), request.size(), reply);
  fcntl(pair->master.get(), F_SETFL, fcntl(pair->master.get(), F_GETFL) & ~O_NONBLOCK);
  std::vector<double> ours, bare;
  for (auto _ : state) {
    (void)_;
    bare.push_back(bare_round_trip_us(pair->master.get(), request, reply));
    const auto started = Clock::now();
    const exchange::Transcript transcript = exchange.run_steps(one.prepared);
    ours.push_back(std::chrono::duration<double, std::micro>(Clock::now() - started).count());
    judge_or_throw(one.prepared, transcript);
  }
  state.counters["bare_median_us"] = median(bare);
  state.counters["exchange_median_us"] = median(ours);
  state.counters["ratio"] = median(ours) / median(bare);
}

/// 16 blocks on each of two channels, all on the 20 ms clock: more than a line carries, so that
/// both are always busy.
nlohmann::json saturating_p2p() {
  nlohmann::json blocks = nlohmann::json::array();
  for (unsigned channel : {1u, 2u})
    for (unsigned i = 0; i < p2p::p2p_blocks / 2; ++i) {
      const std::string here = "%MW" + std::to_string(100 * channel + 4 * i),
                        there = "%DW" + std::to_string(4 * i);
      const bool run = i % 4 >= 2, write = i % 2 == 1;
      blocks.push_back({{"channel", channel},
                        {"flag", "F90"},
                        {"station", 2},
                        {"function", write ? "write" : "read"},
                        {"command", run ? "continuous" : "single"},
                        {"read", write ? here : there},
                        {"save", write ? there : here}});
      if (run) blocks.back()["size"] = 4;
    }
  return {{"line", "115200-8N1"}, {"p2p", {{"blocks", blocks}}}};
}

/// P2P traffic until `end`: two channels of a PLC, each on a line of its own with an XGT server.
void p2p_on_two_channels(benchmark::State& state, Time end) {
  constexpr Time slice = 1s;
  const line::LineSettings settings{.baud = 115200};
  const plc::PortConfig partner{.station = 2, .line = settings};
  std::uint64_t services = 0, errors = 0;
  for (auto _ : state) {
    (void)_;
    const auto client =
        p2p::make_p2p_plc("xbc-h", saturating_p2p(), [](const plc::PortConfig& port) {
          return std::make_unique<xgt_cnet::XgtP2pDriver>(port.gap());
        });
    if (!client) throw std::runtime_error(client.error().message);
    const auto first = xgt_cnet::make_plc(partner), second = xgt_cnet::make_plc(partner);
    line::SimulatedLine lines[] = {line::SimulatedLine(settings), line::SimulatedLine(settings)};
    lines[0].attach(*(*client)->line(1), settings);
    lines[0].attach(*(*first)->line(), settings);
    lines[1].attach(*(*client)->line(2), settings);
    lines[1].attach(*(*second)->line(), settings);
    for (Time until = slice; until <= end; until += slice)
      for (line::SimulatedLine& line : lines)
        while (line.now() < until) line.receive(until);
    for (unsigned channel : {1u, 2u}) {
      const auto& counters = dynamic_cast<p2p::P2pClient&>(*(*client)->line(channel)).counters();
      services += counters.services;
      errors += counters.errors;
    }
  }
  if (errors > 0) throw std::runtime_error("a P2P service failed");
  state.counters["services"] =
      static_cast<double>(services) / static_cast<double>(state.iterations());
}

/// The whole tool, from its start to its exit, reports included.
class Tool {
 public:
  explicit Tool(std::string path) : path_(std::move(path)) {}

  /// The most memory that it held at once, in MiB.
  double run(const std::vector<std::string>& arguments) const {
    const fs::path out = fs::temp_directory_path() / fmt::format("fieldproof_bench_{}", getpid());
    std::vector<std::string> words{path_, "run", "--out", out.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const pid_t child = fork();
    if (child == 0) become(words);
    int status = 0;
    rusage usage{};
    if (child < 0 || wait4(child, &status, 0, &usage) < 0)
      throw std::runtime_error("cannot start " + path_);
    fs::remove_all(out);
    if (status != 0)
      throw std::runtime_error(fmt::format("{} failed: {}", path_, fmt::join(words, " ")));
    return static_cast<double>(usage.ru_maxrss) / 1024;
  }

 private:
  [[noreturn]] static void become(std::vector<std::string>& words) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const int nothing = ::open("/dev/null", O_WRONLY);
    dup2(nothing, STDOUT_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }

  std::string path_;
};

void tool_run(benchmark::State& state, const Tool& tool,
              const std::vector<std::string>& arguments) {
  double peak = 0;
  for (auto _ : state) {
    (void)_;
    peak = std::max(peak, tool.run(arguments));
  }
  state.counters["peak_MiB"] = peak;
}

constexpr const char* repeated = "xgt_cnet/rss/two_words/lower";

/// Each kind of run by each tool in turn, so that they see the same machine.
void register_tool_runs(const std::vector<std::pair<std::string, Tool>>& tools, bool brief) {
  const std::string many = brief ? "100" : "100000";
  const std::pair<std::string, std::vector<std::string>> runs[] = {
      {"one_case", {"--filter", repeated}},
      {"default", {}},
      {"default_three_times", {"--repeat", "3"}},
      {"one_case_" + many + "_times", {"--filter", repeated, "--repeat", many}}};
  for (const auto& [name, arguments] : runs)
    for (const auto& [whose, tool] : tools)
      benchmark::RegisterBenchmark(("tool/" + name + whose).c_str(),
                                   [tool = tool, arguments = arguments](benchmark::State& state) {
                                     tool_run(state, tool, arguments);
                                   })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime()
          ->Iterations(brief                ? 1
                       : name == "one_case" ? 20
                                            : 5);
}

/// X-NET on simulated time, until `end`: what is done to it every 12 s keeps it busy.
void xnet_until(benchmark::State& state, Time end, const std::string& model,
                const nlohmann::json& config, const std::vector<std::string>& actions) {
  for (auto _ : state) {
    (void)_;
    Result<std::unique_ptr<plc::EmulatedDevice>> made = xnet::make_xnet(model, config);
    if (!made) throw std::runtime_error(made.error().message);
    line::Device& line = *(*made)->line();
    Time again{};
    line.advance(Time{});
    for (unsigned axis = 0; axis < 20; ++axis)
      (void)(*made)->set(fmt::format("SM{}", 2010 + 20 * axis), "01");
    while (line.wake_at() && *line.wake_at() <= end) {
      const Time now = *line.wake_at();
      line.advance(now);
      if (now < again) continue;
      again = now + 12s;
      for (const std::string& action : actions) (void)(*made)->act(action);
    }
  }
}

/// An hour of 20 axes that move most of the time; an hour of 32 stations with traffic.
void register_xnet(bool brief) {
  const Time end = brief ? 10s : 3600s;
  std::vector<std::string> moves, reads;
  for (unsigned axis = 1; axis <= 20; ++axis)
    moves.push_back(fmt::format("MOTO {} 5000 50 axis {}", axis % 2 == 0 ? 50000 : -50000, axis));
  nlohmann::json net{{"ports", {{{"station", 1}, {"cycle_ms", 32}}}}};
  for (unsigned station = 2; station <= 32; ++station) {
    net["stations"].push_back({{"ports", {{{"station", station}, {"cycle_ms", 32}}}}});
    reads.push_back(fmt::format("REG_READ net 1 station {} D0 count 125 to D0", station));
  }
  benchmark::RegisterBenchmark("xnet/hour_of_20_axes", [=](benchmark::State& state) {
    xnet_until(state, end, "xdc", {{"servos", 20}}, moves);
  })->Unit(benchmark::kSecond);
  benchmark::RegisterBenchmark("xnet/hour_of_32_stations", [=](benchmark::State& state) {
    xnet_until(state, end, "xd3", net, reads);
  })->Unit(benchmark::kSecond);
}

void register_all(const std::vector<std::pair<std::string, Tool>>& tools, bool brief) {
  using benchmark::RegisterBenchmark;
  // First: the peak of a child is never below what this process held when it made it.
  register_tool_runs(tools, brief);
  RegisterBenchmark("in_process_exchange", in_process_exchange);
  RegisterBenchmark("whole_suite", whole_suite)->Unit(benchmark::kMillisecond);
  register_xnet(brief);
  RegisterBenchmark("load_all_vectors", load_all_vectors)->Unit(benchmark::kMillisecond);
  RegisterBenchmark("pty_exchange_against_bare_ping_pong", pty_exchange_against_bare_ping_pong)
      ->Unit(benchmark::kMicrosecond)
      ->Iterations(brief ? 20 : 20'000);
  RegisterBenchmark(
      "p2p_on_two_channels",
      [brief](benchmark::State& state) { p2p_on_two_channels(state, brief ? 10s : 3600s); })
      ->Unit(benchmark::kSecond)
      ->Iterations(1);
}

/// Takes an option of ours out of the arguments.
bool take(std::vector<char*>& arguments, std::string_view name) {
  return std::erase_if(arguments, [&](const char* one) { return one == name; }) > 0;
}

std::string take_value(std::vector<char*>& arguments, std::string_view name) {
  const auto found = std::ranges::find(arguments, name, [](char* one) { return one; });
  if (found == arguments.end()) return "";
  const auto value = found + 1;
  if (value == arguments.end()) throw std::runtime_error(fmt::format("{} wants a value", name));
  std::string text = *value;
  arguments.erase(found, value + 1);
  return text;
}

/// Also what the pty endpoint of this very process starts.
std::string find_tool() {
  const char* named = std::getenv("FIELDPROOF_EXECUTABLE");
  const std::string path =
      named && *named ? named : (harness::own_executable().parent_path() / "fieldproof").string();
  if (!fs::exists(path))
    throw std::runtime_error("cannot find the tool at " + path +
                             "; build it, or name it by FIELDPROOF_EXECUTABLE");
  setenv("FIELDPROOF_EXECUTABLE", path.c_str(), 1);
  return path;
}

int run_benchmarks(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  const bool brief = take(arguments, "--brief");
  const std::string against = take_value(arguments, "--against");
  std::vector<std::pair<std::string, Tool>> tools;
  if (!against.empty()) tools.emplace_back("/before", Tool(against));
  tools.emplace_back(against.empty() ? "" : "/after", Tool(find_tool()));
  std::string shortest = "--benchmark_min_time=0.001";
  if (brief) arguments.push_back(shortest.data());
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  register_all(tools, brief);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace fieldproof::suites

int main(int argc, char** argv) {
  try {
    return fieldproof::suites::run_benchmarks(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "fieldproof_bench: {}\n", error.what());
    return 1;
  }
}
