#include "harness/explore/server_sequences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace fieldproof::explore {

using results::CaseResult;
using vectors::Case;

namespace {

/// "2" of "name 2" is no part of what differs.
std::string without_number(const std::string& field) {
  return field.substr(0, field.find_last_not_of("0123456789 ") + 1);
}

/// What became of data that should have been others: bytes swapped is another fault than zero.
std::string relation(const results::Difference& one) {
  const std::string &due = one.expected, &came = one.received;
  if (due.size() != came.size()) return due.size() < came.size() ? "longer" : "shorter";
  if (came.find_first_not_of("0 ") == std::string::npos) return "zero";
  std::string of_due = due, of_came = came;
  std::ranges::sort(of_due);
  std::ranges::sort(of_came);
  return of_due == of_came ? "in another order" : "other";
}

std::string differences_in(const CaseResult& result) {
  std::string text;
  std::set<std::string> names;
  for (const results::Difference& one : result.differences) {
    const std::string name = without_number(one.field);
    // What follows from the rest, and where it lies, tells nothing.
    if (one.hint.find("follows") != std::string::npos || name == "BCC" || name == "CRC" ||
        name == "LRC" || name == "SUM")
      continue;
    if (names.insert(name).second) text += fmt::format(", {} {}", name, relation(one));
  }
  return text;
}

/// The request that a server got of a kind that makes it wrong: where.
std::string wrong_in(const Request& request) {
  if (request.kind == "field" || request.kind == "letters")
    return without_number(request.change.substr(0, request.change.find(':')));
  return is_a_right_frame(request) && request.kind != "order" ? request.topic : request.kind;
}

class ServerSequence : public Sequence {
 public:
  ServerSequence(ServerSequences& inventor, std::vector<Request> requests, Memory memory,
                 std::vector<Answer> answers, std::vector<std::string> open)
      : inventor_(inventor),
        requests_(std::move(requests)),
        memory_(std::move(memory)),
        answers_(std::move(answers)),
        open_(std::move(open)) {}

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
    Case one =
        case_of(requests_, answers_, memory_, *server.protocol, server.station, std::move(id));
    one.config = server.config;
    return one;
  }

  /// The request behind which the first step got what it had not to, for a bench goes on behind
  /// that; else the last that was sent, be it in two pieces.
  std::size_t failing_part(const CaseResult& result) const override {
    const Case one = as_case("");
    std::map<std::size_t, Bytes> came;
    std::size_t last = 0;
    for (const results::Event& event : result.exchange) {
      if (event.step < 0 || static_cast<std::size_t>(event.step) >= one.steps.size()) continue;
      const auto step = static_cast<std::size_t>(event.step);
      if (event.kind == results::Event::Kind::sent) last = std::max(last, step);
      if (event.kind != results::Event::Kind::received) continue;
      came[step].insert(came[step].end(), event.bytes.begin(), event.bytes.end());
    }
    std::size_t part = 0;
    for (std::size_t step = 0, sent = 0; step <= std::min(last + 1, one.steps.size() - 1); ++step) {
      const vectors::Step& due = one.steps[step];
      if (due.kind == vectors::Step::Kind::send) part = sent++;
      const bool broken = result.expected.empty() && !came[step].empty() &&
                          due.kind == vectors::Step::Kind::silence;
      const bool other = due.kind == vectors::Step::Kind::expect &&
                         due.frames.front().text == result.expected &&
                         came[step] != result.expected_bytes;
      if (broken || other) break;
    }
    return part;
  }

  /// By what should have come, what came, and where a request was wrong: which service shows it
  /// first is chance, and the finding lists them.
  std::string mark(std::size_t part, const CaseResult& result) const override {
    const std::string due = outcome(part);
    const std::string came = sort_of(result.received_bytes, *inventor_.server().protocol);
    const bool granted = came == "answered";
    if (answers_[part].learnt && due != came) return fmt::format("{} before, then {}", due, came);
    if (due != came)
      return fmt::format("{} due, {}{}", due, came,
                         granted ? ": " + wrong_in(requests_[part]) : std::string());
    const std::string what = differences_in(result);
    return fmt::format("{}{}{}", due, what.empty() ? ": " + result.message.substr(0, 40) : what,
                       what.find(" other") != std::string::npos
                           ? (part == 0 ? " in " : " later in ") + requests_[part].topic
                           : std::string());
  }

  Own without(std::size_t from, std::size_t count) const override {
    return inventor_.answered(left_out(requests_, from, count), &memory_);
  }

  std::size_t settings() const override { return memory_.size(); }
  /// A real device holds something everywhere: there the answers may not depend on what is not
  /// given.
  Own without_settings(std::size_t from, std::size_t count) const override {
    const Memory fewer = left_out(memory_, from, count);
    Own lean = inventor_.answered(requests_, &fewer);
    if (!lean || lean->parts() != parts()) return nullptr;
    if (inventor_.server().over_the_wire && !answers_alike(from, count)) return nullptr;
    return lean;
  }

  const std::vector<Request>& asked() const { return requests_; }
  const std::vector<Answer>& answers() const { return answers_; }
  /// Learnt::key_of each that nobody says the answer to, else empty.
  const std::vector<std::string>& open() const { return open_; }

 private:
  /// With none, and with other values there.
  bool answers_alike(std::size_t from, std::size_t count) const {
    Memory other = memory_, none = memory_;
    for (std::size_t i = from; i < std::min(from + count, memory_.size()); ++i) {
      for (char& digit : other[i].second) digit = digit == '5' ? 'A' : '5';
      none[i].second.assign(none[i].second.size(), '0');
    }
    return std::ranges::all_of(std::array{&other, &none}, [&](const Memory* memory) {
      const Own one = inventor_.answered(requests_, memory);
      return one && std::ranges::equal(static_cast<const ServerSequence&>(*one).answers_, answers_,
                                       {}, &Answer::bytes, &Answer::bytes);
    });
  }

  ServerSequences& inventor_;
  std::vector<Request> requests_;
  Memory memory_;
  std::vector<Answer> answers_;  // one a request
  std::vector<std::string> open_;
};

std::vector<Bytes> bytes_of(const std::vector<Request>& requests, const Server& server) {
  std::vector<Bytes> all;
  for (const Request& one : requests)
    if (Result<Bytes> bytes =
            safety::bytes_of(one.notation, server.protocol->fields_at(server.station)))
      all.push_back(std::move(*bytes));
  return all;
}

/// The device ended the connection in what a step had not to.
bool ended_by_device(const CaseResult& result) {
  return std::ranges::any_of(result.exchange, [](const results::Event& event) {
    return event.by_device && (event.kind == results::Event::Kind::closed ||
                               event.kind == results::Event::Kind::reset);
  });
}

}  // namespace

ServerSequences::ServerSequences(Server server, Oracle oracle, std::vector<Request> requests,
                                 std::uint64_t seed)
    : server_(std::move(server)),
      oracle_(std::move(oracle)),
      requests_(std::move(requests)),
      changes_(*server_.protocol, server_.station, !server_.over_the_wire,
               Counts(*server_.protocol, server_.station, bytes_of(requests_, server_))),
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
  if (server_.over_the_wire) have_any_past();
}

/// What a device keeps beside its memory: registered monitors. Somebody may have registered them
/// all, and no request takes that back.
void ServerSequences::have_any_past() {
  constexpr unsigned numbers = 0x20;
  for (const Request& one : requests_)
    for (unsigned number = 0; number < numbers; ++number) {
      const std::optional<Request> registers = changes_.with_registration(one, number);
      if (!registers) break;
      (void)oracle_.ask({*registers}, {}, Past::any);
    }
}

/// There is some room in each area that it names.
bool ServerSequences::can_be_sent(const Request& request) const {
  return std::ranges::all_of(changes_.named_by(request), [&](const auto& one) {
    return !server_.over_the_wire || !server_.room(one.area).empty();
  });
}

/// What did one of them do? Or is something elsewhere?
std::optional<Request> ServerSequences::look(const std::vector<Request>& requests, HotWords& hot) {
  const Request& like = random_.of(requests);
  if (random_.chance(5)) return changes_.look_past(like, random_);
  return random_.chance(80) ? changes_.look_at(like, random_)
                            : changes_.look_anywhere(like, hot, random_);
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
      requests.back().off_before = false;
      continue;
    }
    if (!requests.empty() && random_.chance(30))
      if (std::optional<Request> one = look(requests, hot); one && has_room(*one)) {
        one->off_before = false;
        requests.push_back(std::move(*one));
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
  spread(requests);
  return requests;
}

/// Connections must not be mixed up: what one was asked, or has got half of, is no matter of
/// another.
void ServerSequences::spread(std::vector<Request>& requests) {
  constexpr std::size_t most = 3, fewest = 2;
  const bool line = !server_.protocol->on_network();
  const std::size_t taken = server_.config.value("connections", most);
  if (line || taken < fewest || !random_.chance(30)) return;
  const std::size_t links = std::min(most, taken);
  for (Request& one : requests) one.link = random_.below(links);
}

/// Nothing: it would go where no request may.
std::optional<Request> ServerSequences::invent_one(bool faultless, HotWords& hot) {
  // Is it still read as it was?
  if (!faultless && !learnt_.otherwise().empty() && random_.chance(10)) {
    Request again = random_.of(learnt_.otherwise());
    return has_room(again) ? std::optional(std::move(again)) : std::nullopt;
  }
  Request one = requests_[random_.of(by_topic_[weights_.choose(random_)])];
  if (random_.chance(15)) changes_.make("resized", one, hot, random_);
  if (random_.chance(85) || !has_room(one)) {
    const std::string kind = one.kind;
    changes_.make("elsewhere", one, hot, random_);
    if (kind == "resized") one.kind = kind;
  }
  one.names = changes_.named_by(one);
  if (!faultless && random_.chance(50)) change(one, hot);
  std::ranges::move(changes_.named_by(one), std::back_inserter(one.names));
  // A connection would not outlive it.
  const bool line = !server_.protocol->on_network();
  one.off_before = line && !server_.over_the_wire && random_.chance(2);
  return has_room(one) ? std::optional(std::move(one)) : std::nullopt;
}

/// Where a limit is not known to one, that is asked for.
void ServerSequences::change(Request& request, HotWords& hot) {
  const Result<Bytes> bytes =
      safety::bytes_of(request.notation, server_.protocol->fields_at(server_.station));
  if (const auto wish =
          bytes ? limits_.count_between(changes_.counts().service_of(*bytes)) : std::nullopt)
    if (changes_.resized(request, wish, random_)) {
      request.kind = "resized";
      return;
    }
  // Most of what goes wrong is a field or the line.
  const std::size_t rare = Changes::kinds.size() - 4;
  const std::size_t kind = random_.chance(75) ? 1 + random_.below(3) : 4 + random_.below(rare);
  changes_.make(Changes::kinds[kind], request, hot, random_);
}

/// All that it names lies where requests may go.
bool ServerSequences::has_room(const Request& request) const {
  const Result<Bytes> bytes =
      safety::bytes_of(request.notation, server_.protocol->fields_at(server_.station));
  if (!bytes || !server_.allowed(*bytes)) return false;
  // There is nothing.
  if (request.kind == "past" && server_.protocol->written_by(*bytes).empty()) return true;
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
  Result<std::vector<Answer>> answers = oracle_.ask(requests, memory, Past::none);
  if (!answers || answers->empty()) return nullptr;
  if (server_.over_the_wire && depends_on_the_past(requests, memory, *answers)) return nullptr;
  if (server_.over_the_wire) cut_behind_silence(requests, *answers);
  std::vector<std::string> open = put_learnt(requests, *answers);
  if (answers->empty()) return nullptr;
  requests.resize(answers->size());
  return std::make_unique<ServerSequence>(*this, std::move(requests), std::move(memory),
                                          std::move(*answers), std::move(open));
}

/// A server on a connection that says nothing may wait for the rest of a frame, and whatever comes
/// on it then is that: on real time, a wait for each.
void ServerSequences::cut_behind_silence(const std::vector<Request>& requests,
                                         std::vector<Answer>& answers) const {
  if (!server_.protocol->on_network()) return;
  std::set<std::size_t> silent;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (silent.contains(requests[i].link)) return answers.resize(i);
    if (answers[i].bytes.empty()) silent.insert(requests[i].link);
  }
}

bool ServerSequences::depends_on_the_past(const std::vector<Request>& requests,
                                          const Memory& memory,
                                          const std::vector<Answer>& answers) {
  return std::ranges::any_of(std::array{Past::this_run, Past::any}, [&](Past past) {
    const Result<std::vector<Answer>> again = oracle_.ask(requests, memory, past);
    return !again || !std::ranges::equal(*again, answers, {}, &Answer::bytes, &Answer::bytes);
  });
}

/// Where the device reads something otherwise, it is held to that; what it then granted nobody can
/// tell. Which are open.
std::vector<std::string> ServerSequences::put_learnt(const std::vector<Request>& requests,
                                                     std::vector<Answer>& answers) const {
  std::vector<std::string> open(answers.size());
  if (!server_.learns) return open;
  const harness::Protocol& protocol = *server_.protocol;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (binding_of(requests[i], answers[i], protocol) != Binding::open) continue;
    const std::string own = sort_of(answers[i], protocol);
    open[i] = Learnt::key_of(requests[i], own);
    const Reading* reading = learnt_.find(open[i]);
    if (!reading) continue;
    answers[i].learnt = true;
    if (reading->sort == own) continue;
    const bool grants = reading->sort == "answered";
    if (!grants) {
      answers[i] = reading->answer;
      answers[i].learnt = true;
    }
    const bool ends = grants || own == "answered" || reading->answer.ended;
    if (ends) answers.resize(grants ? i : i + 1);
  }
  open.resize(answers.size());
  return open;
}

void ServerSequences::done(const Sequence& sequence) {
  const auto& one = static_cast<const ServerSequence&>(sequence);
  const harness::Protocol& protocol = *server_.protocol;
  for (std::size_t i = 0; i < one.parts(); ++i) {
    const Request& request = one.asked()[i];
    const std::string sort = one.outcome(i);
    if (!one.open().at(i).empty() && !one.answers()[i].learnt)
      learnt_.learn(one.open()[i], request, {one.answers()[i], sort, sort, {}});
    const Result<Bytes> bytes =
        safety::bytes_of(request.notation, protocol.fields_at(server_.station));
    if (!bytes || !is_a_right_frame(request)) continue;
    const std::string service = changes_.counts().service_of(*bytes);
    if (service.empty() || request.kind == "order" || request.kind == "letters") continue;
    if (request.kind == "field" || request.kind == "station") continue;
    // What else is refused may be so for another reason than its size.
    const bool granted = sort == "answered";
    const bool sized =
        granted || (request.kind == "resized" && request.clause.answer == "answered");
    const std::vector<harness::Protocol::Written> none;
    limits_.note(service, sized ? changes_.counts().count_in(*bytes) : std::nullopt,
                 granted || request.kind == "past" ? request.names : none, sort);
  }
}

bool ServerSequences::may_learn(const Sequence& sequence, std::size_t part) const {
  const auto& one = static_cast<const ServerSequence&>(sequence);
  return !one.open().at(part).empty() && !one.answers()[part].learnt;
}

bool ServerSequences::learn(const Sequence& sequence, std::size_t part, const CaseResult& result) {
  const auto& one = static_cast<const ServerSequence&>(sequence);
  const Request& request = one.asked()[part];
  const harness::Protocol& protocol = *server_.protocol;
  Answer answer{result.received_bytes, result.received_bytes.empty() && ended_by_device(result)};
  const std::string sort = sort_of(answer, protocol);
  learnt_.learn(one.open()[part], request,
                {std::move(answer), sort, one.outcome(part), request.topic + "/" + request.kind});
  return true;
}

Inventor::Known ServerSequences::known() const {
  return {limits_.services(), limits_.limits(*server_.protocol), learnt_.lines()};
}

}  // namespace fieldproof::explore
