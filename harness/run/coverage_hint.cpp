#include "harness/run/coverage_hint.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>

#include "reports/text/tally.hpp"

namespace fieldproof::run {

using bench::BenchOptions;
using harness::Protocol;

namespace {

constexpr double nearly_as_many = 0.9;
constexpr double most_of_area =
    0.95;  // the last few words of an area are the vectors about its end

struct Option {
  std::string text;
  BenchOptions with;
};

/// What cases write of an area.
struct Area {
  const Protocol* protocol = nullptr;
  std::vector<std::uint32_t> last_words = {};

  /// "M0-M199": from the beginning as far as most cases reach, to the next hundred.
  std::string range(const std::string& name) {
    std::ranges::sort(last_words);
    const auto at =
        static_cast<std::size_t>(static_cast<double>(last_words.size() - 1) * most_of_area);
    const std::uint32_t last = (last_words[at] / 100 + 1) * 100 - 1;
    return protocol->spell(name, 0) + "-" + protocol->spell(name, last);
  }
};

/// Ranges to allow, those that permit less first.
std::vector<std::string> ranges_for(const bench::Benches& port,
                                    const std::vector<const vectors::Case*>& blocked) {
  std::map<std::string, Area> areas;
  std::set<std::string> outputs;
  for (const vectors::Case* one : blocked) {
    const auto [protocol, written] = port.written_by(*one);
    for (const Protocol::Written& write : written) {
      if (write.unknown()) continue;
      areas[write.area].protocol = protocol;
      areas[write.area].last_words.push_back(write.last_word);
      if (std::ranges::count(protocol->output_areas(), write.area) > 0) outputs.insert(write.area);
    }
  }
  std::vector<std::string> ranges;
  for (auto& [name, area] : areas) ranges.push_back(area.range(name));
  for (const auto& [name, area] : areas) ranges.push_back(name);
  ranges.push_back("all");
  std::string everything = "all";
  for (const std::string& area : outputs) everything += "," + area;
  if (!outputs.empty()) ranges.push_back(everything);
  return ranges;
}

std::vector<Option> options_for(const bench::Benches& port, const BenchOptions& options,
                                const harness::Protocols& known,
                                const std::vector<const vectors::Case*>& blocked) {
  const safety::WordReader words = [&known](std::string_view text) {
    return known.read_word(text);
  };
  std::vector<Option> all;
  for (const std::string& range : ranges_for(port, blocked)) {
    Option one{"--allow-write " + range, options};
    if (one.with.fence.allow(range, words)) all.push_back(std::move(one));
  }
  if (!options.stimulus) {
    all.push_back({"--stimulus COMMAND", options});
    all.back().with.stimulus.tell = [](const std::string&) { return ok(); };
  }
  if (options.power_cycle_command.empty()) {
    all.push_back({"--power-cycle COMMAND", options});
    all.back().with.power_cycle_command = "COMMAND";
  }
  return all;
}

}  // namespace

std::string coverage_hint(const bench::Benches& port, const BenchOptions& options,
                          const harness::Protocols& known,
                          const std::vector<const vectors::Case*>& blocked) {
  const std::size_t now = port.could_run(blocked, options);
  std::vector<std::pair<std::size_t, std::string>> gains;
  for (const Option& one : options_for(port, options, known, blocked))
    gains.emplace_back(std::max(port.could_run(blocked, one.with), now) - now, one.text);
  const auto best = std::ranges::max_element(gains);
  if (best == gains.end() || best->first == 0) return {};
  const auto least = std::ranges::find_if(gains, [&](const auto& gain) {
    return static_cast<double>(gain.first) >= nearly_as_many * static_cast<double>(best->first);
  });
  return fmt::format("with {}: {} more", least->second, text::grouped(least->first));
}

}  // namespace fieldproof::run
