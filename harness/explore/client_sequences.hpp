// Stimuli of a device that asks: P2P blocks of the vectors side by side in it, fired one after
// another or at once, and answered well or badly by our own device in the partner's chair.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/endpoints/endpoint.hpp"
#include "harness/explore/client_pool.hpp"
#include "harness/explore/sequence.hpp"

namespace fieldproof::explore {

struct Client {
  const harness::Protocol* protocol = nullptr;
  std::string model;
  bool over_the_wire = false;  // what it did before, it remembers; and no mode is changed
};

/// What is done once, and what comes of it.
struct Stimulus {
  std::string action;               // `do`; else the flags of these blocks rise at once:
  std::vector<std::size_t> fired;   // in block order
  std::vector<std::string> faults;  // of the partner, for each; "": it answers well
  std::uint64_t data = 0;           // seed of what is read and written
};

class ClientSequences : public Inventor {
 public:
  /// Errors: our own device cannot be made.
  static Result<std::unique_ptr<ClientSequences>> open(Client client, ClientPool pool,
                                                       std::uint64_t seed);

  bool can_invent() const override { return !pool_.groups.empty(); }
  Sequence::Own invent() override;
  void note(const Topic& topic, std::uint64_t times) override { weights_.note(topic.kind, times); }

  /// As a device has it: configuration and memory.
  struct SetUp {
    nlohmann::json config;
    std::vector<nlohmann::json> blocks;
    std::uint64_t data = 0;  // seed of the memory
  };
  /// Nothing: what our own device does cannot be told in order.
  Sequence::Own played(SetUp set_up, std::vector<Stimulus> stimuli);

  const Client& client() const { return client_; }
  const ClientPool& pool() const { return pool_; }

 private:
  ClientSequences(Client client, ClientPool pool, std::uint64_t seed);
  void try_out(const std::string& fault);
  SetUp invent_set_up();
  Stimulus invent_stimulus(std::size_t blocks, bool well);

  Client client_;
  ClientPool pool_;
  Weights weights_;  // of faults and actions
  Random random_;
  std::unique_ptr<endpoints::Endpoint> model_;
};

}  // namespace fieldproof::explore
