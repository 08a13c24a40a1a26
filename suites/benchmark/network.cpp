// Exchanges with an FEnet server: in process, and over loopback against what the system itself
// takes.
#include <fmt/format.h>
#include <sched.h>
#include <sys/socket.h>

#include <optional>

#include "harness/system/sockets/socket_connect.hpp"
#include "harness/system/sockets/socket_listen.hpp"
#include "suites/benchmark/bare_echo.hpp"
#include "suites/benchmark/benchmarks.hpp"
#include "suites/benchmark/compare.hpp"
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

/// Two ends of one connection over loopback, which block.
struct Connection {
  os::UniqueFd bench, device;

  Connection() {
    const os::UniqueFd listener = value_of(os::listen_socket({"127.0.0.1", 0}, SOCK_STREAM));
    bench = value_of(os::connect_socket(to_string(os::local_address(listener.get())), SOCK_STREAM));
    os::SocketAddress from;
    device = os::accept_socket(listener.get(), from);
    make_blocking(bench.get());
    make_blocking(device.get());
  }
};

/// This thread, and what it starts, runs on this processor alone as long as it lives.
class OnProcessor {
 public:
  explicit OnProcessor(int number) {
    sched_getaffinity(0, sizeof(before_), &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(number, &one);
    sched_setaffinity(0, sizeof(one), &one);
  }
  ~OnProcessor() { sched_setaffinity(0, sizeof(before_), &before_); }

 private:
  cpu_set_t before_;
};

/// Both servers run on the processor `of_servers`, both clients on the first one: where the system
/// chooses, one pair may share a processor while the other wakes one that sleeps, four times as
/// slow.
void fenet_over_loopback_against_bare_ping_pong(benchmark::State& state, const std::string& tool,
                                                int of_servers) {
  const Example example = reads_of_a_word();
  auto servers = std::make_optional<OnProcessor>(of_servers);
  const auto endpoint =
      open(fmt::format("exec:{} emulate 'xbc-h?protocol=xgt-fenet' --tcp {{port}}", tool), fenet());
  exchange::Exchange exchange(*endpoint, fenet(), {});
  const Bytes request = example.prepared.steps[0].frames[0].frame.bytes;
  const std::size_t reply = example.prepared.steps[1].frames[0].frame.bytes.size();
  const Connection connection;
  const BareEcho echo(connection.device.get(), request.size(), reply);
  if (const Status begun = endpoint->begin(nlohmann::json::object()); !begun)
    throw std::runtime_error(begun.error().message);
  servers.reset();
  const OnProcessor clients(0);
  compare(
      state, reads,
      [&] {
        for (int i = 0; i < reads; ++i) bare_round_trip(connection.bench.get(), request, reply);
      },
      [&] { return exchange.run_steps(example.prepared); }, example);
}

}  // namespace

void register_network(const std::string& tool, bool brief) {
  on_each_processor(benchmark::RegisterBenchmark("fenet_in_process", fenet_in_process));
  for (const auto& [where, processor] : {std::pair("on_one_processor", 0), {"on_two", 1}})
    benchmark::RegisterBenchmark(
        fmt::format("fenet_over_loopback_against_bare_ping_pong/{}", where).c_str(),
        [tool, processor = processor](benchmark::State& state) {
          fenet_over_loopback_against_bare_ping_pong(state, tool, processor);
        })
        ->Unit(benchmark::kMillisecond)
        ->Iterations(brief ? 2 : 200);
}

}  // namespace fieldproof::suites
