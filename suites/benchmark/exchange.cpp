// Exchanges on serial lines: in process, and over a pty against what the system itself takes.
#include "harness/bench/bench.hpp"
#include "harness/paths.hpp"
#include "harness/system/pty_pair.hpp"
#include "suites/benchmark/bare_echo.hpp"
#include "suites/benchmark/benchmarks.hpp"
#include "suites/benchmark/compare.hpp"
#include "suites/benchmark/example.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::suites {
namespace {

using endpoints::Endpoint;

const harness::Protocol& xgt() { return *protocols().find("xgt-cnet"); }

/// A one-word RSS and its ACK.
const std::string read_one_word =
    R"j({"send": "[ENQ st 'rSS' '01' name(%MW100) EOT BCC]"}, {"expect": "[ACK st 'rSS' '01' '02' '0000' ETX BCC]"})j";

void in_process_exchange(benchmark::State& state) {
  const Example one(read_one_word, xgt());
  const std::unique_ptr<Endpoint> endpoint = open("emulator:xbc-h", xgt());
  exchange::Exchange exchange(*endpoint, xgt(), {});
  for (auto _ : state) {
    (void)_;
    one.judge(exchange.run_steps(one.prepared));
  }
  state.SetItemsProcessed(state.iterations());
}

void whole_suite(benchmark::State& state) {
  const harness::DataPaths data = harness::find_data();
  const vectors::VectorSet set = vectors::load_vectors(data.vectors, {protocols()});
  const std::unique_ptr<Endpoint> endpoint = open("emulator:", xgt());
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

void pty_exchange_against_bare_ping_pong(benchmark::State& state) {
  const Example one(read_one_word, xgt());
  const std::unique_ptr<Endpoint> endpoint = open("pty:xbc-h", xgt());
  exchange::Exchange exchange(*endpoint, xgt(), {});
  const Bytes request = one.prepared.steps[0].frames[0].frame.bytes;
  const std::size_t reply = one.prepared.steps[1].frames[0].frame.bytes.size();
  const os::PtyPair pair = value_of(os::open_pty_pair());
  const BareEcho echo(pair.slave.get(), request.size(), reply);
  make_blocking(pair.master.get());
  compare(
      state, 1, [&] { bare_round_trip(pair.master.get(), request, reply); },
      [&] { return exchange.run_steps(one.prepared); }, one);
}

}  // namespace

void register_exchanges(bool brief) {
  using benchmark::RegisterBenchmark;
  on_each_processor(RegisterBenchmark("in_process_exchange", in_process_exchange));
  RegisterBenchmark("whole_suite", whole_suite)->Unit(benchmark::kMillisecond);
  RegisterBenchmark("load_all_vectors", load_all_vectors)->Unit(benchmark::kMillisecond);
  RegisterBenchmark("pty_exchange_against_bare_ping_pong", pty_exchange_against_bare_ping_pong)
      ->Unit(benchmark::kMicrosecond)
      ->Iterations(brief ? 20 : 20'000);
}

}  // namespace fieldproof::suites
