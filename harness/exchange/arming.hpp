// What makes a real device ask (client role): the program of --stimulus, or P2P blocks that an
// engineer has prepared in the module. An emulator needs neither: its blocks are set up by
// `given.config`.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/exchange/prepared_case.hpp"
#include "harness/exchange/stimulus.hpp"

namespace fieldproof::exchange {

class Arming {
 public:
  struct Ways {
    TellStimulus stimulus;                 // empty: none
    std::vector<nlohmann::json> prepared;  // complete_blocks() of the profile
    bool aux = false;                      // memory can be set and read over a second channel
  };
  /// Refers to `protocol`.
  Arming(const harness::Protocol& protocol, Ways ways)
      : protocol_(protocol), ways_(std::move(ways)) {}

  /// Why the device cannot be made to ask as the case needs it, for the engineer; empty where it
  /// can. `config` is that of the case with "model".
  std::string objection(const vectors::Case& source, const nlohmann::json& config) const;

  /// Starts a case: blocks that run by a clock are asked for at once.
  Status begin(const vectors::Case& source, const nlohmann::json& config);
  /// The case sets memory. The rising edge of a condition flag asks for its block, once.
  Status set(const std::string& address, const std::string& hex);
  /// Ends a case whose blocks run by a clock: true where they stop, since a stimulus was told.
  Result<bool> end();

  /// The flags of the case's blocks that someone sets.
  std::vector<std::string> flags() const;
  bool aux() const { return ways_.aux; }

 private:
  /// What of the device's own memory shows on the line: flags, and what writes send. By address.
  using Image = std::map<std::string, std::string>;

  Status load(const vectors::Case& source, const nlohmann::json& config);
  Result<Image> image() const;
  std::string missing_block() const;
  std::string foreign_clock() const;
  Result<std::string> needs_memory(const vectors::Case& source);
  Status ask_for(const nlohmann::json& block) const;

  const harness::Protocol& protocol_;
  Ways ways_;
  std::string case_;
  std::vector<nlohmann::json> blocks_;
  std::unique_ptr<plc::EmulatedDevice>
      shadow_;  // keeps the memory that the case gives; it never runs
};

}  // namespace fieldproof::exchange
