// Our own device, which is asked what a device under test will be: requests one after another, and
// the case that they make with its answers.
#pragma once

#include <memory>
#include <string>
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
  Bytes bytes;         // empty: silence
  bool ended = false;  // and then the device closed the connection
};

/// How an answer reads where only its sort counts: "answered", "silence", "0003", "closed".
std::string sort_of(const Answer& answer, const harness::Protocol& protocol);

/// Our own device, which answers a sequence on simulated time. Two of them differ in what they did
/// before.
class Oracle {
 public:
  /// Errors: the model cannot be made.
  static Result<Oracle> open(const harness::Protocol& protocol, const std::string& model,
                             int station);

  /// One answer a request; fewer where the device ended the connection. `fresh`: a device that has
  /// done nothing yet, else the one that has answered all sequences before.
  Result<std::vector<Answer>> ask(const std::vector<Request>& requests, const Memory& memory,
                                  bool fresh);

 private:
  Oracle(const harness::Protocol& protocol, std::string model, int station)
      : protocol_(&protocol), model_(std::move(model)), station_(station) {}
  const harness::Protocol* protocol_;
  std::string model_;
  int station_;
  std::unique_ptr<endpoints::Endpoint> fresh_, used_;
};

/// The case that expects these answers of a device: `derived` where each is granted, else
/// `decision`, since no manual prints an answer to most of what is wrong. Requests past the last
/// answer are left out.
vectors::Case case_of(const std::vector<Request>& requests, const std::vector<Answer>& answers,
                      const Memory& memory, const harness::Protocol& protocol, int station,
                      std::string id);

}  // namespace fieldproof::explore
