#include "harness/explore/server_sequences.hpp"

#include <algorithm>

namespace fieldproof::explore {

using results::CaseResult;
using vectors::Case;

namespace {

class ServerSequence : public Sequence {
 public:
  ServerSequence(ServerSequences& inventor, std::vector<Request> requests, Memory memory,
                 std::vector<Answer> answers)
      : inventor_(inventor),
        requests_(std::move(requests)),
        memory_(std::move(memory)),
        answers_(std::move(answers)) {}

  std::size_t parts() const override { return requests_.size(); }
  std::uint64_t requests() const override { return requests_.size(); }
  Topic topic(std::size_t part) const override {
    return {requests_[part].topic, requests_[part].kind};
  }
  std::string outcome(std::size_t part) const override {
    return sort_of(answers_[part], *inventor_.server().protocol);
  }
  Case as_case(std::string id) const override {
    const Server& server = inventor_.server();
    return case_of(requests_, answers_, memory_, *server.protocol, server.station, std::move(id));
  }

  /// The request that the failing step answers.
  std::size_t failing_part(const CaseResult& result) const override {
    std::size_t sent = 0;
    for (const results::Event& event : result.exchange)
      if (event.kind == results::Event::Kind::sent && event.step >= 0) ++sent;
    return std::min(sent == 0 ? 0 : sent - 1, requests_.size() - 1);
  }

  Own without(std::size_t from, std::size_t count) const override {
    return inventor_.answered(left_out(requests_, from, count), &memory_);
  }

  /// A real device holds something everywhere: there all that is named is given.
  std::size_t settings() const override {
    return inventor_.server().over_the_wire ? 0 : memory_.size();
  }
  Own without_setting(std::size_t at) const override {
    const Memory fewer = left_out(memory_, at, 1);
    Own lean = inventor_.answered(requests_, &fewer);
    return lean && lean->parts() == parts() ? std::move(lean) : nullptr;
  }

 private:
  ServerSequences& inventor_;
  std::vector<Request> requests_;
  Memory memory_;
  std::vector<Answer> answers_;  // one a request
};

}  // namespace

ServerSequences::ServerSequences(Server server, Oracle oracle, std::vector<Request> requests,
                                 std::uint64_t seed)
    : server_(std::move(server)),
      oracle_(std::move(oracle)),
      requests_(std::move(requests)),
      changes_(*server_.protocol, server_.station, !server_.over_the_wire),
      random_(seed) {
  if (!server_.room)
    server_.room = [own = server_.protocol](const std::string& area) {
      const std::uint32_t words = own->words_of(area);
      return words == 0 ? std::vector<safety::WriteFence::Words>()
                        : std::vector<safety::WriteFence::Words>{{0, words - 1}};
    };
  std::erase_if(requests_, [&](const Request& one) { return !can_be_sent(one); });
  for (std::size_t i = 0; i < requests_.size(); ++i) {
    by_topic_[requests_[i].topic].push_back(i);
    weights_.add(requests_[i].topic);
  }
}

/// There is some room in each area that it names.
bool ServerSequences::can_be_sent(const Request& request) const {
  return std::ranges::all_of(changes_.named_by(request), [&](const auto& one) {
    return !server_.over_the_wire || !server_.room(one.area).empty();
  });
}

/// Mostly short, sometimes long; many have nothing wrong in them.
std::vector<Request> ServerSequences::requests_of_one() {
  const std::size_t sort = random_.below(100);
  const std::size_t length = sort < 50   ? 1 + random_.below(4)
                             : sort < 90 ? 4 + random_.below(12)
                             : sort < 99 ? 16 + random_.below(45)
                                         : 60 + random_.below(200);
  const bool faultless = random_.chance(40);
  HotWords hot(server_.room);
  std::vector<Request> requests;
  // Where there is little room, most requests have none.
  for (std::size_t trial = 0; requests.size() < length && trial < 50 * length; ++trial) {
    if (!requests.empty() && random_.chance(20)) {  // what works once may not work often
      requests.push_back(Request(random_.of(requests)));
      continue;
    }
    if (!requests.empty() && random_.chance(30))  // what did it do?
      if (std::optional<Request> look =
              random_.chance(80) ? changes_.look_at(random_.of(requests), random_)
                                 : changes_.look_anywhere(random_.of(requests), hot, random_);
          look && has_room(*look)) {
        requests.push_back(std::move(*look));
        continue;
      }
    std::optional<Request> one = invent_one(faultless, hot);
    if (!one) continue;
    const bool pieces = one->kind == "damage" || one->kind == "pause";
    requests.push_back(std::move(*one));
    // What is left of a frame waits for more as long as its protocol says, a bench no longer than
    // it must: on real time nothing of the same sequence comes behind it.
    if (pieces && server_.over_the_wire) break;
  }
  return requests;
}

/// Nothing: it would go where no request may.
std::optional<Request> ServerSequences::invent_one(bool faultless, HotWords& hot) {
  Request one = requests_[random_.of(by_topic_[weights_.choose(random_)])];
  if (random_.chance(85) || !has_room(one)) changes_.make("elsewhere", one, hot, random_);
  one.names = changes_.named_by(one);
  if (!faultless && random_.chance(50))
    changes_.make(Changes::kinds[1 + random_.below(Changes::kinds.size() - 1)], one, hot, random_);
  std::ranges::move(changes_.named_by(one), std::back_inserter(one.names));
  return has_room(one) ? std::optional(std::move(one)) : std::nullopt;
}

/// All that it names lies where requests may go.
bool ServerSequences::has_room(const Request& request) const {
  const Result<Bytes> bytes =
      safety::bytes_of(request.notation, server_.protocol->fields_at(server_.station));
  if (!bytes || !server_.allowed(*bytes)) return false;
  std::vector<harness::Protocol::Written> names = request.names;
  if (names.empty()) names = changes_.named_by(request);
  return std::ranges::all_of(names, [&](const harness::Protocol::Written& one) {
    return !server_.over_the_wire ||
           std::ranges::any_of(server_.room(one.area), [&](const auto& words) {
             return words.first <= one.first_word && one.last_word <= words.last;
           });
  });
}

Sequence::Own ServerSequences::invent() { return answered(requests_of_one(), nullptr); }

Sequence::Own ServerSequences::answered(std::vector<Request> requests, const Memory* given) {
  bool unsettable = false;
  Memory memory = given ? *given
                        : memory_of(requests, *server_.protocol, server_.station,
                                    server_.over_the_wire, random_, unsettable);
  if (requests.empty() || unsettable) return nullptr;
  Result<std::vector<Answer>> answers = oracle_.ask(requests, memory, true);
  if (!answers || answers->empty()) return nullptr;
  if (server_.over_the_wire) {
    const Result<std::vector<Answer>> again = oracle_.ask(requests, memory, false);
    if (!again || again->size() != answers->size()) return nullptr;
    for (std::size_t i = 0; i < answers->size(); ++i)
      if ((*again)[i].bytes != (*answers)[i].bytes) return nullptr;
  }
  requests.resize(answers->size());
  return std::make_unique<ServerSequence>(*this, std::move(requests), std::move(memory),
                                          std::move(*answers));
}

}  // namespace fieldproof::explore
