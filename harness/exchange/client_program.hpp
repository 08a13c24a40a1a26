// The program that makes a device under test ask: what it is told, and what it says that it can
// follow. The lines are a contract: vectors/stimulus.schema.json and the README, "The module as
// client".
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "harness/endpoints/endpoint.hpp"
#include "harness/system/line_program.hpp"
#include "harness/vectors/case.hpp"
#include "src/base/time.hpp"

namespace fieldproof::exchange {

/// Takes one line, without its newline.
using TellStimulus = std::function<Status(const std::string& line)>;

/// How the bench reaches it.
struct ClientProgram {
  TellStimulus tell;                              // empty: there is none
  std::function<std::string(Duration)> answer{};  // its first answer; empty: none within that time
  std::function<Status()> restart{};              // starts it anew where it has ended

  explicit operator bool() const { return static_cast<bool>(tell); }
};

/// `stimulus` must outlive it.
ClientProgram program_of(os::LineProgram& stimulus);
/// The program of `exec:` itself (--stimulus -), which must outlive it.
ClientProgram program_of(endpoints::Endpoint& endpoint);

/// What a program declares in its answer to the first line, or is taken to follow without one.
struct Declared {
  bool answered = false;  // it knows more lines than those that ask for a request
  std::set<std::string> follows{"clock"};
  Duration time_out{};  // how long it waits for an answer, where it says so
};

/// Reads `{"follows": ["clock", "memory"], "time_out_ms": 200}`; empty: no answer came. Errors say
/// what is wrong with it, and what is known.
Result<Declared> read_declaration(const std::string& answer);

/// Does a P2P parameter mail?
bool has_mail(const nlohmann::json& p2p);
/// What a case needs of the program beyond "ask this once", as it stands in "follows".
/// `same_memory`: do two addresses of the device's own memory share a bit?
using SameMemory = std::function<bool(const std::string&, const std::string&)>;
std::set<std::string> needs_of(const vectors::Case& source, bool on_a_line,
                               const SameMemory& same_memory);

/// The name in "follows" under which a key of given.config is told; empty: it is not told.
std::string_view told_as(std::string_view config_key);

/// What a client waits for an answer: (time_out + 1) x 100 ms (Cnet EN and KO 4.3.1), on a network
/// 5 s (DECISIONS.md fenet/p2p-time-out).
Duration client_time_out(const nlohmann::json& config, bool on_a_line);

/// What the case sets up in the device, with every default written out: the value of "begin".
nlohmann::json set_up_of(const vectors::Case& source, bool on_a_line);

}  // namespace fieldproof::exchange
