#include "src/udata/program.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::udata {

using plc::PlcMemory;

using Operation = UdataInstruction::Operation;

namespace {

constexpr Duration answer_max = 1s;  // status 6

/// F110: an instruction ended with an error. XEC has no such flag for them.
void set_error_flag(const UdataInstruction& instruction, bool error, PlcMemory& memory) {
  if (instruction.iec) return;
  memory.write(plc::parse_address(memory.model(), "%FX0110").address, error ? 1 : 0);
}

}  // namespace

void UdataProgram::scan(PlcMemory& memory, UdataChannel& channel) {
  // Results can raise requests in a circle: a program that keeps itself busy gets so many scans at
  // once.
  for (std::size_t left = instructions_.size() + 1; left > 0; --left) {
    bool executed = false;
    for (std::size_t i = 0; i < instructions_.size(); ++i) {
      if (!rises(i, memory) || states_[i].waits) continue;
      execute(i, memory, channel);
      executed = true;
    }
    if (!executed) return;
  }
}

void UdataProgram::look(const PlcMemory& memory) {
  for (std::size_t i = 0; i < instructions_.size(); ++i) rises(i, memory);
}

bool UdataProgram::rises(std::size_t i, const PlcMemory& memory) {
  const bool requested = memory.read(instructions_[i].request) != 0;
  const bool before = std::exchange(states_[i].requested, requested);
  return requested && !before;
}

void UdataProgram::execute(std::size_t i, PlcMemory& memory, UdataChannel& channel) {
  const UdataInstruction& instruction = instructions_[i];
  set_error_flag(instruction, misses_module(instruction, module_), memory);
  std::uint16_t status = check_udata(instruction, module_, memory);
  // 6.6.2 and 6.6.6 print no time-out: what a module has not handed over is no data.
  if (status == udata_status::done && module_.hangs &&
      instruction.operation != Operation::receive) {
    states_[i].waits = true;
    status = udata_status::before;
  } else if (status == udata_status::done) {
    status = carry_out(instruction, memory, channel);
  }
  put_status(instruction, status, memory);
}

std::uint16_t UdataProgram::carry_out(const UdataInstruction& instruction, PlcMemory& memory,
                                      UdataChannel& channel) {
  switch (instruction.operation) {
    case Operation::send: channel.send(read_data(instruction, memory)); break;
    case Operation::dtr: channel.set_dtr(instruction.value.read(memory) == 1); break;
    case Operation::rts: channel.set_rts(instruction.value.read(memory) == 1); break;
    case Operation::receive: {
      const std::optional<Bytes> data = module_.hangs ? std::nullopt : channel.take_received();
      if (!data) return udata_status::value;
      put_data(instruction, *data, memory);
      break;
    }
  }
  return udata_status::done;
}

std::optional<Time> UdataProgram::wake_at() const {
  std::optional<Time> first;
  for (const State& state : states_)
    if (state.waits) first = std::min(first.value_or(Time::max()), state.give_up.value_or(Time{}));
  return first;
}

bool UdataProgram::advance(Time now, PlcMemory& memory) {
  bool wrote = false;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    State& state = states_[i];
    if (!state.waits) continue;
    if (!state.give_up) state.give_up = now + answer_max;
    if (*state.give_up > now) continue;
    state.waits = false;
    state.give_up.reset();
    put_status(instructions_[i], udata_status::time_out, memory);
    wrote = true;
  }
  return wrote;
}

}  // namespace fieldproof::udata
