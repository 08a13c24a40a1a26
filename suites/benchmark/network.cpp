// Exchanges with an FEnet server: in process, and over loopback against what the system itself
// takes.
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "harness/system/unique_fd.hpp"
#include "suites/benchmark/bare_echo.hpp"
#include "suites/benchmark/benchmarks.hpp"
#include "suites/benchmark/example.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::suites {
namespace {

const harness::Protocol& fenet() { return *protocols().find("xgt-fenet"); }

constexpr int reads = 1000;

/// %MW100 is read so many times over one connection, whose beginning and end are hardly felt.
Example reads_of_a_word() {
  std::string steps;
  for (int i = 0; i < reads; ++i)
    steps +=
        std::string(i > 0 ? "," : "") + R"j({"send": "pdu(54 00 02 00 00 00 01 00 name(%MW100))"},
                {"expect": "pdu(55 00 02 00 00 00 00 00 01 00 02 00 00 00)"})j";
  return Example(steps + R"j(, {"close": "fin"}, {"expect_close": "any", "within": "1s"})j",
                 fenet());
}

void fenet_in_process(benchmark::State& state) {
  const Example example = reads_of_a_word();
  const auto endpoint = open("emulator:xbc-h?protocol=xgt-fenet", fenet());
  exchange::Exchange exchange(*endpoint, fenet(), {});
  for (auto _ : state) {
    (void)_;
    example.judge(exchange.run_steps(example.prepared));
  }
  state.SetItemsProcessed(state.iterations() * reads);
}

/// Two ends of one connection over loopback.
struct Connection {
  os::UniqueFd bench, device;

  Connection() {
    const os::UniqueFd listener(socket(AF_INET, SOCK_STREAM, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    bench = os::UniqueFd(socket(AF_INET, SOCK_STREAM, 0));
    if (bind(listener.get(), generic, size) < 0 || listen(listener.get(), 1) < 0 ||
        getsockname(listener.get(), generic, &size) < 0 || connect(bench.get(), generic, size) < 0)
      throw std::runtime_error("no connection over loopback");
    device = os::UniqueFd(accept(listener.get(), nullptr, nullptr));
    const int on = 1;
    for (const os::UniqueFd* end : {&bench, &device})
      setsockopt(end->get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
};

/// Both kinds in turn, so that they see the same machine.
void fenet_over_loopback_against_bare_ping_pong(benchmark::State& state, const std::string& tool) {
  const Example example = reads_of_a_word();
  const auto endpoint =
      open(fmt::format("exec:{} emulate 'xbc-h?protocol=xgt-fenet' --tcp {{port}}", tool), fenet());
  exchange::Exchange exchange(*endpoint, fenet(), {});
  const Bytes request = example.prepared.steps[0].frames[0].frame.bytes;
  const std::size_t reply = example.prepared.steps[1].frames[0].frame.bytes.size();
  const Connection connection;
  const BareEcho echo(connection.device.get(), request.size(), reply);
  std::vector<double> ours, bare;
  for (auto _ : state) {
    (void)_;
    bare.push_back(microseconds([&] {
      for (int i = 0; i < reads; ++i) bare_round_trip_us(connection.bench.get(), request, reply);
    }));
    exchange::Transcript transcript;
    ours.push_back(microseconds([&] { transcript = exchange.run_steps(example.prepared); }));
    example.judge(transcript);
  }
  state.counters["bare_median_us"] = median(bare) / reads;
  state.counters["exchange_median_us"] = median(ours) / reads;
  state.counters["ratio"] = median(ours) / median(bare);
}

}  // namespace

void register_network(const std::string& tool, bool brief) {
  benchmark::RegisterBenchmark("fenet_in_process", fenet_in_process);
  benchmark::RegisterBenchmark(
      "fenet_over_loopback_against_bare_ping_pong",
      [tool](benchmark::State& state) { fenet_over_loopback_against_bare_ping_pong(state, tool); })
      ->Unit(benchmark::kMillisecond)
      ->Iterations(brief ? 2 : 200);
}

}  // namespace fieldproof::suites
