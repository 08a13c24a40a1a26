// Requests to a server: those of the vectors, sent elsewhere, with other data, or with a fault.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/explore/changes.hpp"
#include "harness/explore/learnt.hpp"
#include "harness/explore/limits.hpp"
#include "harness/explore/oracle.hpp"
#include "harness/explore/sequence.hpp"

namespace fieldproof::explore {

struct Server {
  const harness::Protocol* protocol = nullptr;  // that knows where the model has its memory
  int station = 1;
  nlohmann::json config = nlohmann::json::object();  // that it declares: keys of given.config
  bool over_the_wire = false;  // memory is set by requests; what it did before, it remembers
  bool learns = false;         // what nobody says is the device's own reading
  Room room{};                 // where requests may go to; none: to all of the memory
  std::function<bool(ByteView request)> allowed = [](ByteView) { return true; };
};

class ServerSequences : public Inventor {
 public:
  /// Requests that name memory where there is no room are left out.
  ServerSequences(Server server, Oracle oracle, std::vector<Request> requests, std::uint64_t seed);

  bool can_invent() const override { return !requests_.empty(); }
  Sequence::Own invent() override;
  void note(const Topic& topic, std::uint64_t times) override { weights_.note(topic.name, times); }
  void done(const Sequence& sequence) override;
  bool may_learn(const Sequence& sequence, std::size_t part) const override;
  bool learn(const Sequence& sequence, std::size_t part,
             const results::CaseResult& result) override;
  Known known() const override;

  /// Nothing: the model refuses to be asked so, or what it answers depends on what was before,
  /// which nobody knows of a real device. Without `memory` what they name is filled by chance.
  Sequence::Own answered(std::vector<Request> requests, const Memory* memory);
  const Server& server() const { return server_; }

 private:
  void have_any_past();
  bool depends_on_the_past(const std::vector<Request>& requests, const Memory& memory,
                           const std::vector<Answer>& answers);
  void cut_behind_silence(const std::vector<Request>& requests, std::vector<Answer>& answers) const;
  std::vector<std::string> put_learnt(const std::vector<Request>& requests,
                                      std::vector<Answer>& answers) const;
  std::vector<Request> requests_of_one();
  std::optional<Request> look(const std::vector<Request>& requests, HotWords& hot);
  void change(Request& request, HotWords& hot);
  std::optional<Request> invent_one(bool faultless, HotWords& hot);
  void spread(std::vector<Request>& requests);
  bool has_room(const Request& request) const;
  bool can_be_sent(const Request& request) const;

  Server server_;
  Oracle oracle_;
  std::vector<Request> requests_;
  std::map<std::string, std::vector<std::size_t>> by_topic_;
  Weights weights_;
  Changes changes_;
  Learnt learnt_;
  Limits limits_;
  Random random_;
};

}  // namespace fieldproof::explore
