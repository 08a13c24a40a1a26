// Faults that each protocol of a client can have by itself: time-outs that are a little off, values
// that are taken once and never again, and runs that are cut just at their limit.
#include <fmt/format.h>

#include <deque>
#include <map>
#include <memory>

#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

namespace {

using p2p::P2pBlock;
using Timing = p2p::P2pClient::Timing;

std::string_view text(std::string one) {
  static std::deque<std::string> texts;
  return texts.emplace_back(std::move(one));
}

/// A block saves again and again what it saved first.
Behaviour saves_first_value() {
  using Values = std::map<unsigned, std::vector<std::uint64_t>>;
  const auto first = std::make_shared<Values>();
  return after_saving([first](const P2pBlock& block, plc::PlcMemory& memory) {
    std::vector<std::uint64_t> now;
    for (const p2p::P2pVariable& variable : block.variables)
      for (unsigned i = 0; i < block.elements(); ++i) now.push_back(memory.read(variable.own + i));
    const std::vector<std::uint64_t>& kept = first->try_emplace(block.number, now).first->second;
    std::size_t at = 0;
    for (const p2p::P2pVariable& variable : block.variables)
      for (unsigned i = 0; i < block.elements() && at < kept.size(); ++i)
        memory.write(variable.own + i, kept[at++]);
  })();
}

/// Writes what memory held at the first request.
Behaviour writes_first_value() {
  const auto first = std::make_shared<std::map<unsigned, Bytes>>();
  return {.asks = [first](p2p::P2pDriver& good, const P2pBlock& block,
                          const plc::PlcMemory& memory) -> Result<Bytes> {
    const Result<Bytes> request = good.request(block, memory);
    return request ? Result<Bytes>(first->try_emplace(block.number, *request).first->second)
                   : request;
  }};
}

/// A run of so many elements, or more, is asked one shorter.
MakeBehaviour one_less_from(unsigned limit) {
  return asks_for([limit](P2pBlock& block) {
    if (block.continuous && block.size >= limit) --block.size;
  });
}

struct Limit {
  const char *what, *caught_by;
  unsigned size;
};
constexpr Limit limits[] = {
    {"xgt_read_run", "xgt_cnet/client/run/read_120_bytes/word", 60},
    {"rtu_coils", "modbus_rtu/client/limits/read_bits_01_2000", 2000},
    {"rtu_inputs", "modbus_rtu/client/limits/read_bits_02_2000", 2000},
    {"rtu_holding_registers", "modbus_rtu/client/limits/read_words_03_120", 120},
    {"rtu_input_registers", "modbus_rtu/client/limits/read_words_04_120", 120},
    {"rtu_written_coils", "modbus_rtu/client/limits/write_bits_1968", 1968},
    {"rtu_written_registers", "modbus_rtu/client/limits/write_words_120", 120},
    {"ascii_coils", "modbus_ascii/client/limits/read_bits_01_976", 976},
    {"ascii_inputs", "modbus_ascii/client/limits/read_bits_02_976", 976},
    {"ascii_holding_registers", "modbus_ascii/client/limits/read_words_03_61", 61},
    {"ascii_input_registers", "modbus_ascii/client/limits/read_words_04_61", 61},
    {"ascii_written_coils", "modbus_ascii/client/limits/write_bits_944", 944},
    {"ascii_written_registers", "modbus_ascii/client/limits/write_words_59", 59}};

void add_time_outs(const std::string& folder, std::vector<Fault>& result) {
  const std::string_view exact = text(folder + "/client/time_out/exact/n1");
  result.push_back({text(folder + "_time_out_100_ms_short"), "the time-out is 100 ms too short",
                    timing([](Timing& timing) { timing.time_out -= 100ms; }), exact,
                    "%LW512 holds 0002"});
  result.push_back({text(folder + "_time_out_100_ms_long"), "the time-out is 100 ms too long",
                    timing([](Timing& timing) { timing.time_out += 100ms; }), exact,
                    "%LW512 holds 0000"});
}

}  // namespace

std::vector<Fault> narrow_faults() {
  std::vector<Fault> result;
  for (const std::string folder : {"modbus_rtu", "modbus_ascii", "ls_bus"})
    add_time_outs(folder, result);
  for (const std::string folder : {"xgt_cnet", "modbus_rtu", "modbus_ascii", "ls_bus"})
    result.push_back({text(folder + "_saves_first_value"), "a read saves what it saved first",
                      saves_first_value, text(folder + "/client/read_again"),
                      "%MW119 holds 13575ABC9BDF86427531FDB9"});
  for (const std::string mode : {"modbus_rtu", "modbus_ascii"})
    result.push_back({text(mode + "_writes_first_value"), "a write sends what memory held first",
                      writes_first_value, text(mode + "/client/data/value_of_the_moment"),
                      "expected"});
  result.push_back({"ls_bus_writes_first_value", "a write sends what memory held first",
                    writes_first_value, "ls_bus/client/write_again", "expected"});
  for (const Limit& one : limits)
    result.push_back({text(fmt::format("{}_one_less_at_the_limit", one.what)),
                      text(fmt::format("a run of {} is asked one shorter", one.size)),
                      one_less_from(one.size), one.caught_by, "expected"});
  return result;
}

}  // namespace fieldproof::p2p_broken
