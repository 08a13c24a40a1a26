// A P2P client with one thing wrong: the good engine and the good driver of a protocol, with a
// fault between them, around them, or in what they are set to.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "src/p2p/network_client.hpp"
#include "src/plc/emulated_device.hpp"
#include "src/udata/config.hpp"

namespace fieldproof::p2p_broken {

/// What a block shows of its services.
struct Outcome {
  bool ndr = false, err = false;
  std::uint16_t status = 0;
  std::uint32_t services = 0, errors = 0;

  bool operator==(const Outcome&) const = default;
};

/// What makes a block fire.
enum class Trigger {
  rising_edge,  // right
  falling_edge,
  both_edges,
  level,         // asks again while the flag is on
  queued_edges,  // what rises while the block is under way is served behind it
  every_second_edge,
  held_flag,        // a flag that is on when the PLC goes to RUN counts as risen
  aborted_by_fall,  // a flag that falls gives up what is under way
};

/// One fault at work. What is empty is done right.
struct Behaviour {
  /// What the engine works with, and what is shown in N.
  std::function<void(p2p::P2pParameters& parameters)> works_with{};
  std::function<void(p2p::P2pParameters& parameters)> shows{};
  std::function<void(p2p::P2pClient::Timing& timing)> timing{};
  Trigger trigger = Trigger::rising_edge;
  /// The request of a block, and the judgement of its reply, in its own way.
  std::function<Result<Bytes>(p2p::P2pDriver& good, const p2p::P2pBlock& block,
                              const plc::PlcMemory& memory)>
      asks{};
  std::function<std::optional<std::uint16_t>(const p2p::P2pDriver& good, const p2p::P2pBlock& block,
                                             Bytes frame, plc::PlcMemory& memory)>
      takes{};
  /// Changes what a block shows when it ends. True: the block is asked once more.
  std::function<bool(const Outcome& before, Outcome& now)> ends{};
  bool clears_results = false;      // when a block is asked, it shows neither NDR nor ERR
  bool keeps_late_replies = false;  // what comes when nothing is under way goes to the next request
  bool all_at_once = false;         // no block waits for another
  std::string deaf_to{};            // an action that changes nothing: "stop", "link off"

  // Of a client on a network.
  std::function<void(p2p::NetworkPartner& partner)> partner{};
  std::function<bool(Burst& burst)> hears_link{};          // false: not heard
  std::function<void(std::vector<Burst>& doings)> does{};  // on its links
  bool hangs_up = false;                                   // after each service
  bool keeps_rests = false;  // of a frame, when its connection is gone
  bool saves_late = false;   // what comes when nothing is under way is taken for the last block

  // Of a port that works with UDATA instructions.
  std::function<void(udata::UdataConfig& config)> works_with_udata{};
  std::function<void(Bytes&bytes)> says{}, hears{};
};

/// The client of a protocol ("xgt-cnet", ...) with a fault; of "udata" the port. `config` is that
/// of the good device, and so are the errors.
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_client(const Behaviour& behaviour,
                                                                std::string_view protocol,
                                                                std::string_view model,
                                                                const nlohmann::json& config);
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_network_client(
    const Behaviour& behaviour, std::string_view protocol, std::string_view model,
    const nlohmann::json& config);
Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_udata_port(const Behaviour& behaviour,
                                                                    std::string_view model,
                                                                    const nlohmann::json& config);

}  // namespace fieldproof::p2p_broken
