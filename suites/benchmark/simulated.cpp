// Hours of simulated time: P2P on saturated channels, axes that move, stations that pass a token.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <stdexcept>

#include "src/line/line.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/xgt_cnet/p2p_driver.hpp"
#include "src/xgt_cnet/plc.hpp"
#include "src/xnet_network/network.hpp"
#include "suites/benchmark/benchmarks.hpp"

namespace fieldproof::suites {
namespace {

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

}  // namespace

/// An hour of 20 axes that move most of the time; an hour of 32 stations with traffic.
void register_simulated(bool brief) {
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
    xnet_until(state, end, "xdc", {{"servos", 20u}}, moves);
  })->Unit(benchmark::kSecond);
  benchmark::RegisterBenchmark("xnet/hour_of_32_stations", [=](benchmark::State& state) {
    xnet_until(state, end, "xd3", net, reads);
  })->Unit(benchmark::kSecond);
  benchmark::RegisterBenchmark(
      "p2p_on_two_channels",
      [brief](benchmark::State& state) { p2p_on_two_channels(state, brief ? 10s : 3600s); })
      ->Unit(benchmark::kSecond)
      ->Iterations(1);
}

}  // namespace fieldproof::suites
