// One station of the high-speed link, as a model: blocks travel as values, since no manual prints
// their frame (DECISIONS.md hslink/no-frames). What its flags say: FEnet EN 8.3.2, Appendix A.4.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "src/hs_link/flags.hpp"
#include "src/hs_link/parameter.hpp"
#include "src/plc/memory.hpp"

namespace fieldproof::hs_link {

/// One block on its way to all stations of the subnet (8.1.1).
struct Broadcast {
  unsigned station = 0, block = 0;
  bool run = true, error = false;  // of the station that sends
  bool communicates = false;       // all blocks of its own parameter go and come
  std::vector<std::uint16_t> words;
};

class Station {
 public:
  Station(const plc::PlcModel& model, Parameter parameter, bool run);

  const Parameter& parameter() const { return parameter_; }
  plc::PlcMemory& memory() { return memory_; }
  const plc::PlcMemory& memory() const { return memory_; }

  /// It goes on exchanging in STOP, and in error (DECISIONS.md hslink/in-stop).
  void set_run(bool run) { run_ = run; }
  void set_error(bool error) { error_ = error; }
  /// RLINK is off from then on until every block is well again.
  void enable(bool enabled);
  void power(bool on);

  /// Of sending, or of a block that has not come.
  std::optional<Time> wake_at() const;
  /// What it sends at `now`.
  std::vector<Broadcast> advance(Time now);
  void hear(const Broadcast& block, Time now);
  /// What it hears may be told again; it is counted once.
  void count(const Broadcast& block);
  /// "@sent", "@received": packets since power-on (table 2-8), each a block. Other names of memory.
  Result<std::string> get(std::string_view name, std::size_t digits) const;
  /// Every registered block goes or comes as it should.
  bool communicates() const;
  /// After all that happens at `now`.
  void show_flags();

 private:
  struct Heard {
    std::optional<Time> at{};
    bool run = false, error = false, communicates = false;
  };
  bool works() const { return powered_ && parameter_.enabled; }
  /// How long after a block its TRX stays on (DECISIONS.md hslink/trx-off).
  Duration patience() const;
  bool is_heard(const Heard& heard, Time now) const;
  bool takes(const Block& block, const Broadcast& sent) const {
    return !block.sends && block.station == sent.station && block.number == sent.block;
  }
  void begin(Time now);
  void forget();
  Broadcast broadcast_of(const Block& block) const;
  void save(const Block& block, const std::vector<std::uint16_t>& words);
  void show(Flag flag, bool on, unsigned block = 0);

  plc::PlcMemory memory_;
  Parameter parameter_;
  bool run_, error_ = false, powered_ = true;
  bool begun_ = false;        // it is told the time by the first advance
  std::vector<Heard> heard_;  // of each block
  std::uint32_t sent_ = 0, received_ = 0;
  std::optional<Time> next_sending_;
  bool was_well_ = false;  // RLINK, which stays on
};

}  // namespace fieldproof::hs_link
