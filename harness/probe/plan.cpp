#include "harness/probe/plan.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>

namespace fieldproof::probe {

namespace {

/// How unlikely something is; the sum over a question's parts orders the questions. Only the order
/// matters.
using Rank = int;

template <typename T>
struct Ranked {
  T value;
  Rank rank;
};

// Factory settings first: LS modules and inverters 9600, Modbus devices 19200; then what
// integrators choose for speed.
constexpr std::array<Ranked<int>, 8> usual_speeds{
    {{9600, 0}, {19200, 2}, {38400, 2}, {115200, 2}, {57600, 4}, {4800, 5}, {2400, 6}, {1200, 7}}};

struct Frame {
  int data_bits;
  char parity;
};
constexpr std::array<Ranked<Frame>, 6> usual_frames{
    {{{8, 'N'}, 0}, {{8, 'E'}, 2}, {{8, 'O'}, 4}, {{7, 'E'}, 5}, {{7, 'O'}, 7}, {{7, 'N'}, 8}}};

constexpr int last_usual_station = 31;

Rank rank_of_speed(int speed) {
  const auto found = std::ranges::find(usual_speeds, speed, &Ranked<int>::value);
  return found == usual_speeds.end() ? 8 : found->rank;
}

Rank rank_of_frame(const line::LineSettings& line) {
  for (const auto& [frame, rank] : usual_frames)
    if (frame.data_bits == line.data_bits && frame.parity == line.parity) return rank;
  return 9;
}

/// 1, 0, 2, 3, then upwards, ever less likely.
Rank rank_of_station(int station) {
  if (station <= 1) return 1 - station;
  return station <= 3 ? station : std::min(5 + station / 4, 20);
}

/// A protocol whose station is a byte, not two digits, needs all eight bits.
bool needs_eight_bits(const harness::Protocol& protocol) {
  return protocol.station_bytes(255) == Bytes{255};
}

Duration wire_time(const Trial& trial) {
  if (!trial.protocol) return {};
  return trial.line.character_time() *
         static_cast<Duration::rep>(trial.protocol->probe(trial.station, {}).size());
}

}  // namespace

bool can_be_searched(const harness::Protocol& protocol) {
  return !protocol.on_network() && !protocol.probe(1, {}).empty();
}

std::string question_of(const Trial& trial) {
  return trial.protocol ? fmt::format("{} station {}", trial.protocol->name(), trial.station)
                        : "listening";
}

std::string to_string(const Trial& trial) {
  return line::to_string(trial.line) + ' ' + question_of(trial);
}

SearchSpace filled(SearchSpace space, const harness::Protocols& known) {
  if (space.speeds.empty())
    for (const auto& one : usual_speeds) space.speeds.push_back(one.value);
  if (space.frames.empty())
    for (const auto& one : usual_frames)
      space.frames.push_back({.data_bits = one.value.data_bits, .parity = one.value.parity});
  if (space.stations.empty())
    for (int station = 0; station <= last_usual_station; ++station)
      space.stations.push_back(station);
  if (space.protocols.empty())
    std::ranges::copy_if(known, std::back_inserter(space.protocols),
                         [](const harness::Protocol* one) { return can_be_searched(*one); });
  if (!space.settable) space.speeds.resize(1), space.frames.resize(1);
  return space;
}

std::vector<Trial> make_plan(const SearchSpace& given, const harness::Protocols& known) {
  const SearchSpace space = filled(given, known);
  std::vector<Ranked<Trial>> ranked;
  for (const int speed : space.speeds) {
    for (line::LineSettings line : space.frames) {
      line.baud = speed;
      for (const int station : space.stations) {
        for (std::size_t i = 0; i < space.protocols.size(); ++i) {
          const harness::Protocol& protocol = *space.protocols[i];
          if (space.settable && line.data_bits == 7 && needs_eight_bits(protocol)) continue;
          const Rank rank = rank_of_speed(speed) + rank_of_frame(line) + rank_of_station(station) +
                            static_cast<Rank>(i);
          ranked.push_back({{line, &protocol, station}, rank});
        }
      }
    }
  }
  // Within a rank the settings stay together: changing them costs time.
  std::ranges::stable_sort(ranked, {}, &Ranked<Trial>::rank);
  std::vector<Trial> plan;
  for (const auto& one : ranked) plan.push_back(one.value);
  return plan;
}

Duration longest_time(const std::vector<Trial>& plan, Duration wait) {
  Duration total{};
  const Trial* before = nullptr;
  for (const Trial& trial : plan) {
    if (!before || before->line != trial.line) total += listening_time(trial.line);
    total += wire_time(trial) + wait;
    before = &trial;
  }
  return total;
}

Duration listening_time(const line::LineSettings& line) {
  return std::max<Duration>(20ms, line.character_time() * 4);
}

}  // namespace fieldproof::probe
