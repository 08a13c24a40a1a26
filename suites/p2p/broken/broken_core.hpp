// What a broken P2P client is, whatever carries its frames: memory, blocks with their flags and
// results, and engines with a fault between them, around them, or in what they are set to.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "src/p2p/registers.hpp"
#include "suites/p2p/broken/broken_driver.hpp"

namespace fieldproof::p2p_broken {

class BrokenCore {
 public:
  using MakeDriver =
      std::function<std::unique_ptr<p2p::P2pDriver>(BrokenDriver::Asked asked, unsigned channel)>;
  /// Puts an engine where its frames come and go, and says how its power is cycled.
  using Place = std::function<std::function<void()>(std::unique_ptr<p2p::P2pClient> engine,
                                                    unsigned channel)>;

  BrokenCore(const plc::PlcModel& model, const p2p::P2pParameters& parameters, bool run,
             const Behaviour& behaviour);
  /// `timing` is that of the good client.
  void make_engines(p2p::P2pClient::Timing timing, const MakeDriver& driver, const Place& place);

  /// Before anything comes or time moves.
  void remember();
  /// Is any block waiting for its reply?
  bool is_busy() const;
  plc::PlcMemory& memory() { return memory_; }
  const Behaviour& behaviour() const { return behaviour_; }
  /// With which it works.
  const p2p::P2pParameters& parameters() const { return parameters_; }

  Status set(std::string_view address, std::string_view hex);
  Result<std::string> get(std::string_view address, std::size_t digits) const;
  Status act(std::string_view action);

 private:
  struct Block {
    unsigned number = 0;
    p2p::P2pResultFlags flags{};
    Outcome outcome{};
    std::optional<plc::DeviceAddress> condition{};
    bool on = false, under_way = false, again = false;
    unsigned edges = 0;
  };

  void asked(const p2p::P2pBlock& of);
  void give_up();
  void update_mode();
  void look_at_flags();
  bool fires(Block& block, bool on);
  void fire(const Block& block);
  Outcome outcome(const Block& block) const;
  void show(const Block& block, const Outcome& outcome);
  void saved();

  plc::PlcMemory memory_;
  Behaviour behaviour_;
  p2p::P2pParameters parameters_;  // that it works with
  bool run_, link_;
  std::vector<Block> blocks_;
  std::vector<p2p::P2pClient*> engines_;  // one a channel, unless all blocks are asked at once
  std::vector<std::function<void()>> power_cycles_;
};

}  // namespace fieldproof::p2p_broken
