// What makes a real device ask (client role): the program of --stimulus, or P2P blocks that an
// engineer has prepared in the module. An emulator needs neither: its blocks are set up by
// `given.config`.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/exchange/client_program.hpp"
#include "harness/exchange/prepared_case.hpp"

namespace fieldproof::exchange {

class Arming {
 public:
  struct Ways {
    ClientProgram stimulus;                // empty: none
    std::vector<nlohmann::json> prepared;  // complete_blocks() of the profile
    bool aux = false;                      // memory can be set and read over a second channel
  };
  /// Refers to `protocol`.
  Arming(const harness::Protocol& protocol, Ways ways)
      : protocol_(protocol), ways_(std::move(ways)) {}

  /// Tells the program of --stimulus its first line, once, and reads what it declares.
  void greet();
  /// What the case needs of that program that it does not declare to follow; empty: nothing.
  /// `declared`: the configuration that the profile declares.
  std::string undeclared(const vectors::Case& source, const nlohmann::json& declared) const;
  /// Why the device cannot be made to ask as the case needs it, for the engineer; empty where it
  /// can. `config` is that of the case with "model".
  std::string objection(const vectors::Case& source, const nlohmann::json& config) const;
  /// Is this key of given.config told to the program, which follows it?
  bool tells(std::string_view config_key) const;
  /// The end of a sentence that says why not; empty where it could not be told.
  std::string not_told(std::string_view config_key) const;
  /// Has the program said what it follows?
  bool declares() const { return declared_.answered; }
  /// How long the program waits for an answer, where it says so.
  Duration time_out() const { return declared_.time_out; }

  /// What begins next is the opening probe: it shows whether the device asks at all.
  void next_is_probe() { probe_ = true; }
  /// Starts a case: blocks that run by a clock are asked for at once.
  Status begin(const vectors::Case& source, const nlohmann::json& config);
  /// The case sets memory. The rising edge of a condition flag asks for its blocks, once.
  Status set(const std::string& address, const std::string& hex);
  /// Does the program follow `do ACTION`? Then it is told.
  bool follows(std::string_view action) const;
  Status act(const std::string& action);
  /// The device has done it: a program that was started anew by it is told of the case again.
  Status done(std::string_view action);
  /// The program runs anew, before a case: it is greeted again. Always true.
  bool started_anew();
  /// Ends a case: true where the program asks no more, since it was told.
  Result<bool> end();

  /// The program of --stimulus took no more lines.
  bool gave_up() const { return gave_up_; }
  /// Starts the program anew. False: it cannot be, or has been too often.
  bool revive();

  /// The flags of the case's blocks that someone sets.
  std::vector<std::string> flags() const;
  bool aux() const { return ways_.aux; }

 private:
  /// What of the device's own memory shows on the line: flags, and what writes send. By address.
  using Image = std::map<std::string, std::string>;

  Status load(const vectors::Case& source, const nlohmann::json& config);
  Result<Image> image() const;
  Result<std::string> needs_memory(const vectors::Case& source);
  Status tell(nlohmann::json line);
  Status tell_of_case();
  Status ask_for(std::vector<nlohmann::json> blocks);
  bool share_memory(const std::string& a, const std::string& b) const;

  const harness::Protocol& protocol_;
  Ways ways_;
  bool greeted_ = false, gave_up_ = false, probe_ = false, probing_ = false;
  Declared declared_;
  std::string bad_answer_;  // what is wrong with the declaration
  int restarts_ = 0, number_ = 0;
  const vectors::Case* case_ = nullptr;
  std::vector<nlohmann::json> blocks_;
  std::unique_ptr<plc::EmulatedDevice>
      shadow_;  // keeps the memory that the case gives; it never runs
};

}  // namespace fieldproof::exchange
