// Our own device, which is asked what a device under test will be: requests one after another, and
// the case that they make with its answers.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "harness/endpoints/endpoint.hpp"
#include "harness/explore/random.hpp"
#include "harness/explore/request.hpp"
#include "harness/vectors/case.hpp"

namespace fieldproof::explore {

/// Address and hex digits, as given.memory has them.
using Memory = std::vector<std::pair<std::string, std::string>>;

/// Memory that these requests name, each word once, filled by chance. What nobody can set through
/// the protocol is left out where `over_the_wire`; `unsettable` then tells that there is such.
Memory memory_of(const std::vector<Request>& requests, const harness::Protocol& protocol,
                 int station, bool over_the_wire, Random& random, bool& unsettable);

/// What came back to one request.
struct Answer {
  Bytes bytes;          // empty: silence
  bool ended = false;   // and then the device closed the connection
  bool learnt = false;  // the device under test has answered so before
};

/// How an answer reads where only its sort counts: "answered", "silence", "0003", "closed".
std::string sort_of(const Answer& answer, const harness::Protocol& protocol);

/// What a device did before a sequence.
enum class Past {
  none,
  this_run,  // all sequences before
  any        // whatever others may have asked it: nobody knows it of a real device
};

/// How far what our own device answers binds another one.
enum class Binding {
  derived,   // it follows from what is printed: it binds any
  decision,  // from what this project decided, and a vector holds
  open       // no vector says anything of it
};
Binding binding_of(const Request& request, const Answer& answer, const harness::Protocol& protocol);

/// Our own device, which answers a sequence on simulated time.
class Oracle {
 public:
  /// `config`: what the device under test declares, keys of given.config. Errors: the model cannot
  /// be made.
  static Result<Oracle> open(const harness::Protocol& protocol, const std::string& model,
                             int station, const nlohmann::json& config = nlohmann::json::object());

  /// One answer a request; fewer where the device ended the connection.
  Result<std::vector<Answer>> ask(const std::vector<Request>& requests, const Memory& memory,
                                  Past past);

 private:
  Oracle(const harness::Protocol& protocol, int station, nlohmann::json config)
      : protocol_(&protocol), station_(station), config_(std::move(config)) {}
  const harness::Protocol* protocol_;
  int station_;
  nlohmann::json config_;
  std::map<Past, std::unique_ptr<endpoints::Endpoint>> devices_;
};

/// The case that expects these answers of a device. It binds as the weakest of them does, where a
/// learnt one does not count; it cites the clause of the last. Requests past the last answer are
/// left out.
vectors::Case case_of(const std::vector<Request>& requests, const std::vector<Answer>& answers,
                      const Memory& memory, const harness::Protocol& protocol, int station,
                      std::string id);

}  // namespace fieldproof::explore
