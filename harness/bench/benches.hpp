// One bench a protocol. A real endpoint speaks one; emulators become whatever protocol a case is of.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/bench/bench.hpp"

namespace fieldproof {

class Benches {
 public:
  /// Opens one endpoint for each of `protocols` (at least one). Errors are those of `open_endpoint`.
  static Result<Benches> open(const EndpointName& name, const std::vector<const Protocol*>& protocols, const BenchOptions& options);

  /// The sanity exchange of each; of those that have not stopped.
  Status start();

  /// On the bench of the case's protocol; a case of another protocol is SKIP.
  CaseResult run(const Case& source);

  /// `Bench::put_back` of all.
  std::string put_back();

  bool interrupted() const;
  /// "emulator xbc-h".
  std::string describe() const { return members_.front().endpoint->describe(); }
  /// "xgt-cnet, modbus-rtu".
  std::string protocol_names() const;

 private:
  struct Member {
    const Protocol* protocol;
    std::unique_ptr<Endpoint> endpoint;
    std::unique_ptr<Protocol> configured;  // of a real device: as it declares itself
    std::unique_ptr<Bench> bench;
  };
  std::vector<Member> members_;
};

}  // namespace fieldproof
