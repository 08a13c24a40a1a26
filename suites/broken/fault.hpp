// The table of faults of a protocol's broken device: what is wrong, and the case that must find it.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <vector>

namespace fieldproof::broken {

/// `neighbours` of a fault whose case runs by itself.
constexpr std::string_view alone = "-";

/// `neighbours` of a fault that is met in process alone (suites/faults), not over a port as well.
constexpr std::string_view in_process = "=";

/// `Make` makes the behaviour of the faulty device.
template <typename Make>
struct FaultOf {
  std::string_view name;
  std::string_view what;
  Make make;
  std::string_view caught_by;  // the case that must turn red
  std::string_view message;    // part of its message, or a field that differs
  std::string_view
      neighbours{};  // filter of what runs with it; empty: the cases of the same vector; or `alone`
  unsigned station = 1;  // the fault shows at this station
};

/// nullptr when unknown.
template <typename Table>
auto find_by_name(const Table& table, std::string_view name) {
  const auto found = std::ranges::find(table, name, [](const auto& one) { return one.name; });
  return found == table.end() ? nullptr : &*found;
}

/// Those that are met over a port.
template <typename Fault>
std::vector<Fault> on_a_port(std::vector<Fault> table) {
  std::erase_if(table, [](const Fault& one) { return one.neighbours == in_process; });
  return table;
}

/// The faults of all parts of a table.
template <typename Fault>
std::vector<Fault> gather(std::initializer_list<std::vector<Fault> (*)()> parts) {
  std::vector<Fault> all;
  for (const auto part : parts) std::ranges::move(part(), std::back_inserter(all));
  return all;
}

}  // namespace fieldproof::broken
