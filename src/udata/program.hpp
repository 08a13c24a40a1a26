// A program of UDATA instructions: a pure state machine that is scanned whenever memory has
// changed.
#pragma once

#include <optional>
#include <vector>

#include "src/base/time.hpp"
#include "src/udata/instruction.hpp"

namespace fieldproof::udata {

/// The channel of the module, as the instructions use it.
class UdataChannel {
 public:
  virtual void send(Bytes data) = 0;
  /// The oldest datum received and not yet taken.
  virtual std::optional<Bytes> take_received() = 0;
  virtual void set_dtr(bool on) = 0;
  virtual void set_rts(bool on) = 0;

 protected:
  ~UdataChannel() = default;
};

class UdataProgram {
 public:
  UdataProgram(std::vector<UdataInstruction> instructions, const UdataModule& module)
      : module_(module), instructions_(std::move(instructions)), states_(instructions_.size()) {}

  /// Executes each instruction whose request has risen since the last scan, in program order, until
  /// no result raises another one. A request that rises while its instruction waits for the module
  /// is lost.
  void scan(plc::PlcMemory& memory, UdataChannel& channel);

  /// Takes the requests as they are, without executing anything: STOP.
  void look(const plc::PlcMemory& memory);

  /// Forgets edges and what waits: power-on.
  void reset() { states_.assign(instructions_.size(), {}); }

  /// Time-outs. `wake_at` lies in the past until `advance` has told an instruction when its second
  /// begins.
  std::optional<Time> wake_at() const;
  /// Returns whether a result was written: then there is something to scan.
  bool advance(Time now, plc::PlcMemory& memory);

 private:
  struct State {
    bool requested = false;
    bool waits = false;  // for a module that hangs
    std::optional<Time> give_up{};
  };
  bool rises(std::size_t i, const plc::PlcMemory& memory);
  void execute(std::size_t i, plc::PlcMemory& memory, UdataChannel& channel);
  std::uint16_t carry_out(const UdataInstruction& instruction, plc::PlcMemory& memory,
                          UdataChannel& channel);

  UdataModule module_;
  std::vector<UdataInstruction> instructions_;
  std::vector<State> states_;
};

}  // namespace fieldproof::udata
