// PLCs on X-NET, in one device: the first is the one that a case is about. They exchange objects as
// values; no manual prints a frame, so nothing of it is on a wire.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/plc/emulated_device.hpp"
#include "src/xnet/memory.hpp"
#include "src/xnet_motion/motion_bus.hpp"
#include "src/xnet_network/configuration.hpp"
#include "src/xnet_network/instruction.hpp"
#include "src/xnet_network/token_bus.hpp"

namespace fieldproof::xnet {

/// Result of an X-NET instruction, SD141 + 10 x port (1-5-1).
enum class Outcome : std::uint16_t { done = 0, overtime = 1, memory = 2, crc = 3 };

class XnetNetwork : public plc::SerialDevice, public plc::BusEnd {
 public:
  /// At least one; check_nets() holds.
  explicit XnetNetwork(std::vector<StationConfig> stations);

  /// No byte means anything to it.
  void receive(const Burst&) override {}
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  /// "D0" is of the first PLC, "B:D0" of the one called B. Errors name the address.
  Status set(std::string_view address, std::string_view hex) override;
  /// Also "@turns": stations that had the token, the last 16 turns, two digits each; "@U0-62 of
  /// servo 1" (2-6-2).
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  /// Instructions (instruction.hpp), at a rising edge; "hold INSTRUCTION", whose condition stays
  /// on, and "release"; "run", "stop", "power_cycle", "on", "off", "noise on", "noise off", "slow
  /// 20ms" (DECISIONS.md xnet/slow-station); results of other communication (port_results.hpp). "B:
  /// off" is done to B.
  Status act(std::string_view action) override;
  Trace trace() const override;

  /// Of the first PLC: what a server of it reads and writes. Who writes calls `touch` of it.
  Memory& memory() { return plcs_.front()->memory; }

  /// A PLC in another process takes part as one more, named behind those that are here. What it is
  /// asked for goes over the bus end, in the time that the nets of this process take; it is no
  /// gateway. DECISIONS.md xnet/partner
  plc::BusEnd* bus_end() override { return this; }
  std::string hello() const override;
  Status hear(std::string_view line) override;
  void part() override;
  std::vector<std::string> take_lines() override { return std::exchange(to_partner_, {}); }

 private:
  struct Plc {
    StationConfig config;
    Memory memory;
    bool run = true, powered = true, noisy = false, in_first_scan = false;
    Duration late{};  // of what it carries and answers on a token bus
    Time ethernet_free{};
    unsigned under_way = 0;           // instructions
    unsigned lives = 0;               // how often it has lost power
    std::vector<Instruction> held{};  // conditions that stay on
    std::unique_ptr<MotionBus> motion{};
    std::vector<bool> relays_on{};  // of the program, when it was looked at
    std::uint64_t looked = 0;       // Memory::touched then
  };
  struct Job {
    Plc* from = nullptr;
    Instruction instruction;
    unsigned port = 0;  // of `from`: where its result goes
    unsigned hops = 0;
    bool held = false;
    unsigned life = 0;  // of `from`: a loss of power ends what was asked in the one before
    bool is_lost() const { return life != from->lives; }
  };

  Plc* named(std::string_view name) const;
  Plc* addressed(std::string_view& text) const;
  Plc* station_on(std::uint16_t net, std::uint32_t station) const;
  TokenBus& bus(const Port& port);
  Status execute(Plc& plc, std::string_view text, bool held);
  void start(Plc& plc, const Instruction& instruction, bool held);
  void forward(Plc& via, Job job, Time now);
  void carry(Plc& via, const Route& route, const Port& port, Job job, Time now);
  void finish(const Job& job, Outcome outcome, Time now);
  void fail_later(const Job& job, Time now);
  Outcome move(Plc& target, const Job& job);
  void run_program(Plc& plc);
  static bool has_to_look(const Plc& plc);
  void power(Plc& plc, bool on);
  static void switch_to(Plc& plc, bool run);
  static void begin_scans(Plc& plc);
  static void end_first_scan(Plc& plc);
  static Status slow_down(Plc& plc, std::string_view by);
  Status join(const nlohmann::json& hello);
  void ask_partner(const Job& job, Time now);
  void answer_partner(const nlohmann::json& asked);
  void take_answer(const nlohmann::json& answer);
  void show_presence();
  void later(Time at, std::function<void(Time)> what);

  std::vector<std::unique_ptr<Plc>> plcs_;
  std::map<std::uint16_t, TokenBus> buses_;  // by net
  std::multimap<Time, std::function<void(Time)>> events_;
  Plc* partner_ = nullptr;  // whose memory is in another process
  std::map<std::uint64_t, Job> asked_;
  std::uint64_t asked_so_far_ = 0;
  std::vector<std::string> to_partner_;
  Time now_{};
};

/// Of given.config (vectors/README.md): that of the first PLC, and `stations`, the others, called
/// B, C, ... Errors name the key.
Result<std::unique_ptr<XnetNetwork>> make_network(std::string_view model,
                                                  const nlohmann::json& config);
Result<std::unique_ptr<plc::EmulatedDevice>> make_xnet(std::string_view model,
                                                       const nlohmann::json& config);

}  // namespace fieldproof::xnet
