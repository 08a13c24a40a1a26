// fieldproof_bench: the figures of the README. Times are measured here and never asserted in a
// test.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "harness/bench/bench.hpp"
#include "harness/paths.hpp"
#include "harness/system/pty_pair.hpp"
#include "harness/vectors/loader.hpp"
#include "src/line/line.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/xgt_cnet/p2p_driver.hpp"
#include "src/xgt_cnet/plc.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::suites {

using endpoints::Endpoint;

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
    R"j([{"id": "xgt_cnet/bench/one_word", "rev": 1, "title": "read one word", "level": "must", "basis": "printed",
  "source": {"manual": "m", "section": "1", "statement": "m/1", "quote": "as printed"},
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
BENCHMARK(in_process_exchange);

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
BENCHMARK(whole_suite)->Unit(benchmark::kMillisecond);

void load_all_vectors(benchmark::State& state) {
  for (auto _ : state) {
    (void)_;
    benchmark::DoNotOptimize(vectors::load_vectors(harness::find_data().vectors, {protocols()}));
  }
}
BENCHMARK(load_all_vectors)->Unit(benchmark::kMillisecond);

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
BENCHMARK(pty_exchange_against_bare_ping_pong)->Unit(benchmark::kMicrosecond)->Iterations(20'000);

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

/// One hour of P2P traffic: two channels of a PLC, each on a line of its own with an XGT server.
void p2p_hour_on_two_channels(benchmark::State& state) {
  constexpr Time hour = 3600s, slice = 1s;
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
    for (Time until = slice; until <= hour; until += slice)
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
BENCHMARK(p2p_hour_on_two_channels)->Unit(benchmark::kSecond)->Iterations(1);

/// The whole tool for one case: start, load, one exchange, reports. `repeat` shows what does not
/// grow with the run.
void tool_run(benchmark::State& state) {
  const std::filesystem::path out = std::filesystem::temp_directory_path() / "fieldproof_bench";
  const std::string command = (harness::own_executable().parent_path() / "fieldproof").string() +
                              " run --filter 'xgt_cnet/rss/two_words/*' --repeat " +
                              std::to_string(state.range(0)) + " --out " + out.string() +
                              " >/dev/null";
  for (auto _ : state) {
    (void)_;
    if (std::system(command.c_str()) != 0) throw std::runtime_error("the tool failed: " + command);
  }
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  state.counters["peak_MiB"] = static_cast<double>(usage.ru_maxrss) / 1024;
  std::filesystem::remove_all(out);
}
BENCHMARK(tool_run)->Arg(1)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fieldproof::suites

BENCHMARK_MAIN();
