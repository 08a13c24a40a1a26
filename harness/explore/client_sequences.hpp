// Stimuli of a device that asks: P2P blocks of the vectors side by side in it, fired one after
// another or at once, and answered well or badly by our own device in the partner's chair.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/endpoints/endpoint.hpp"
#include "harness/explore/client_pool.hpp"
#include "harness/explore/client_script.hpp"
#include "harness/explore/sequence.hpp"

namespace fieldproof::explore {

struct Client {
  const harness::Protocol* protocol = nullptr;
  std::string model;
  bool over_the_wire = false;  // what it did before, it remembers; and no mode is changed
};

class ClientSequences : public Inventor {
 public:
  /// Errors: our own device cannot be made.
  static Result<std::unique_ptr<ClientSequences>> open(Client client, ClientPool pool,
                                                       std::uint64_t seed);

  bool can_invent() const override { return !pool_.groups.empty(); }
  Sequence::Own invent() override;
  void note(const Topic& topic, std::uint64_t times) override { weights_.note(topic.kind, times); }
  void done(const Sequence& sequence) override;
  bool give_up(const Sequence& sequence) override;

  /// Nothing: what our own device does cannot be told in order.
  Sequence::Own played(ClientSetUp set_up, std::vector<Stimulus> stimuli);

 private:
  ClientSequences(Client client, ClientPool pool, std::uint64_t seed);
  static const std::string& config_of(const Sequence& sequence);
  void try_out(const std::string& fault);
  ClientSetUp invent_set_up();
  Stimulus invent_stimulus(std::size_t blocks, bool well);

  Client client_;
  ClientPool pool_;
  Weights weights_;  // of faults and actions
  Random random_;
  std::set<std::string> followed_;      // configurations that the device could have
  std::map<std::string, int> refused_;  // and how often others were refused
  std::unique_ptr<endpoints::Endpoint> model_;
};

}  // namespace fieldproof::explore
