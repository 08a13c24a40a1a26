#include "harness/explore/oracle.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/exchange/exchange.hpp"
#include "harness/explore/sequence.hpp"

namespace fieldproof::explore {

using exchange::PreparedCase;
using harness::Field;
using harness::Protocol;
using notation::Notation;
using vectors::Case;
using vectors::Step;

namespace {

Step send_of(const Request& request) {
  Step step = step_of(Step::Kind::send);
  step.frames.push_back({"", notation::print(request.notation), request.notation, std::nullopt});
  return step;
}

Step expect_of(const Answer& answer, const Protocol& protocol, int station) {
  Step step = step_of(Step::Kind::expect);
  const Notation notation = notation_of(answer.bytes, false, protocol, station);
  step.frames.push_back({"", notation::print(notation), notation, std::nullopt});
  return step;
}

/// One frame, or several without a pause that are no longer than one may be, after the whole
/// request: what a case can wait for in one step.
bool in_one_piece(const exchange::Received& received, Time asked, std::size_t longest_frame) {
  if (received.bytes.size() > longest_frame) return false;
  Time before = asked;
  for (const exchange::Received::Arrival& arrival : received.arrivals) {
    const bool first = &arrival == &received.arrivals.front();
    if (arrival.start < before || (!first && arrival.start - before > 1ms)) return false;
    before = arrival.end;
  }
  return true;
}

/// A request that has gone out.
struct Sending {
  Time end{};          // of its last byte
  bool ended = false;  // by the device: the connection, behind it
};

/// Where a request went.
struct Ask {
  std::size_t step;
  std::string link;
};

/// The requests as steps, each with a silence in which the answer comes.
struct Asked {
  Case one;
  std::vector<Ask> asks;
};

/// Up to the first after which something came that belongs to none; and no further than a minute,
/// since servers end connections that rest.
std::vector<Sending> sendings_in(const exchange::Transcript& transcript,
                                 const std::vector<Ask>& asks) {
  using Kind = results::Event::Kind;
  const auto ask_in = [&](std::size_t step) { return std::ranges::find(asks, step, &Ask::step); };
  std::vector<Sending> sendings;
  for (const results::Event& event : transcript.events) {
    const auto step = static_cast<std::size_t>(event.step);
    if (event.kind == Kind::sent && event.step >= 0) {
      if (event.start - transcript.events.front().start > 60s) break;
      const auto number = static_cast<std::size_t>(ask_in(step) - asks.begin());
      const bool ended = !sendings.empty() && sendings.back().ended;
      if (ended && number < sendings.size()) sendings.pop_back();  // in the middle of it
      if (ended) break;
      sendings.resize(number + 1);
      sendings.back().end = event.end;
    } else if (event.kind == Kind::closed || event.kind == Kind::reset) {
      if (!event.by_device) continue;
      // One that rests, or a client that is one too many.
      if (sendings.empty() || event.link != asks[sendings.size() - 1].link) break;
      sendings.back().ended = true;
    } else if (event.kind == Kind::received && (event.surplus || ask_in(step) != asks.end())) {
      break;
    }
  }
  return sendings;
}

/// Up to the first that no case can tell in order.
std::vector<Answer> answers_in(const exchange::Transcript& transcript, const std::vector<Ask>& asks,
                               std::size_t longest_frame) {
  const exchange::Shares shares = exchange::shares_of(transcript);
  const std::vector<Sending> sendings = sendings_in(transcript, asks);
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < sendings.size() && asks[i].step + 1 < shares.steps.size(); ++i) {
    const exchange::Received& heard = shares.steps[asks[i].step + 1].received;
    if (!in_one_piece(heard, sendings[i].end, longest_frame)) break;
    answers.push_back({heard.bytes, sendings[i].ended});
  }
  return answers;
}

Step power_cycle() {
  Step step = step_of(Step::Kind::act);
  step.action = "power_cycle";
  return step;
}

/// The steps of requests on their connections, each of which is opened before its first one. Where
/// there is one alone, that is the implicit one.
class StepsOnLinks {
 public:
  explicit StepsOnLinks(const std::vector<Request>& requests)
      : several_(std::ranges::any_of(
            requests, [&](const Request& one) { return one.link != requests.front().link; })) {}

  std::string name_of(const Request& request) const {
    return several_ ? fmt::format("c{}", request.link + 1) : std::string();
  }

  /// What comes before the request is sent.
  void begin(const Request& request, std::vector<Step>& steps) {
    if (request.off_before) steps.push_back(power_cycle());
    if (several_ && open_.insert(request.link).second)
      add(request, step_of(Step::Kind::open), steps);
  }
  void add(const Request& request, Step step, std::vector<Step>& steps) const {
    step.on = name_of(request);
    steps.push_back(std::move(step));
  }
  std::size_t open() const { return open_.size(); }

 private:
  bool several_;
  std::set<std::size_t> open_;
};

Asked asked_of(const std::vector<Request>& requests, const Protocol& protocol) {
  Asked asked;
  asked.one.protocol = protocol.name();
  StepsOnLinks links(requests);
  for (const Request& request : requests) {
    std::vector<Step>& steps = asked.one.steps;
    links.begin(request, steps);
    asked.asks.push_back({steps.size(), links.name_of(request)});
    links.add(request, send_of(request), steps);
    links.add(request, step_of(Step::Kind::silence), steps);
  }
  return asked;
}

}  // namespace

Memory memory_of(const std::vector<Request>& requests, const Protocol& protocol, int station,
                 bool over_the_wire, Random& random, bool& unsettable) {
  std::map<std::pair<std::string, bool>, std::set<std::uint32_t>> words;
  for (const Request& request : requests)
    for (const Protocol::Written& names : request.names) {
      if (names.last_word - names.first_word > 2048) continue;
      for (std::uint32_t word = names.first_word; word <= names.last_word; ++word)
        words[{names.area, names.contacts}].insert(word);
    }
  Memory memory;
  for (const auto& [area, all] : words)
    for (const std::uint32_t word : all) {
      const auto place = place_of({area.first, word, word, "", area.second}, protocol);
      if (!place || !place->declared) continue;
      const std::string hex = random.hex(place->digits);
      if (over_the_wire && !protocol.write_requests(station, place->address, hex))
        unsettable = true;
      else
        memory.emplace_back(place->address, hex);
    }
  return memory;
}

std::string sort_of(const Answer& answer, const Protocol& protocol) {
  return answer.bytes.empty() && answer.ended ? "closed" : sort_of(answer.bytes, protocol);
}

/// A refusal that a vector has binds as that does, elsewhere too; of one that none has nobody says
/// anything.
Binding binding_of(const Request& request, const Answer& answer, const Protocol& protocol) {
  // Which letters a device takes, and which it answers in, vectors ask where that is not open.
  if (request.kind == "letters") return Binding::open;
  const std::string sort = sort_of(answer, protocol);
  // Fields in another order may make another request, or none.
  if (is_a_right_frame(request) && request.kind != "order" && sort == "answered") {
    const bool decided = std::ranges::any_of(request.names, [&](const Protocol::Written& one) {
      return protocol.is_spelt_by_decision(one.address);
    });
    // Where `run` would not fail a device for it, this must not.
    return decided || request.clause.of_decisions ? Binding::decision : Binding::derived;
  }
  const bool of_its_vector = request.kind == "printed" || request.kind == "elsewhere";
  if (!of_its_vector || request.clause.answer != sort) return Binding::open;
  return request.clause.of_decisions ? Binding::decision : Binding::derived;
}

Result<Oracle> Oracle::open(const Protocol& protocol, const std::string& model, int station,
                            const nlohmann::json& config) {
  nlohmann::json whole = config;
  whole["station"] = station;
  whole["model"] = model;
  Oracle oracle(protocol, station, std::move(whole));
  const endpoints::EndpointName name{
      "emulator",
      model,
      {{"protocol", std::string(protocol.name())}, {"station", std::to_string(station)}}};
  for (const Past past : {Past::none, Past::this_run, Past::any}) {
    Result<std::unique_ptr<endpoints::Endpoint>> endpoint =
        endpoints::open_endpoint(name, protocol);
    if (!endpoint) return endpoint.error();
    const Status begun = (*endpoint)->begin(oracle.config_);
    if (!begun) return begun.error();
    oracle.devices_[past] = std::move(*endpoint);
  }
  return oracle;
}

Result<std::vector<Answer>> Oracle::ask(const std::vector<Request>& requests, const Memory& memory,
                                        Past past) {
  endpoints::Endpoint& device = *devices_[past];
  if (past == Past::none)
    if (const Status begun = device.begin(config_); !begun) return begun.error();
  for (const auto& [address, hex] : memory)
    if (const Status set = device.set(address, hex); !set) return set.error();
  const Asked asked = asked_of(requests, *protocol_);
  const Result<PreparedCase> prepared = exchange::prepare(asked.one, station_, *protocol_);
  if (!prepared) return prepared.error();
  const exchange::Transcript transcript =
      exchange::Exchange(device, *protocol_, {}).run_steps(*prepared);
  if (transcript.trouble) return *transcript.trouble;
  return answers_in(transcript, asked.asks, protocol_->longest_frame());
}

namespace {

/// What the answers to these rest on, and the sentence that says so.
void found(Case& one, const std::vector<Request>& requests, const std::vector<Answer>& answers,
           const Protocol& protocol) {
  Binding weakest = Binding::derived;
  for (std::size_t i = 0; i < answers.size(); ++i)
    if (!answers[i].learnt)
      weakest = std::max(weakest, binding_of(requests[i], answers[i], protocol));
  one.basis = weakest == Binding::derived ? "derived" : "decision";
  const Request& last = requests[answers.size() - 1];
  const bool of_its_vector = !answers.back().learnt && last.kind != "look" &&
                             binding_of(last, answers.back(), protocol) != Binding::open &&
                             last.clause.answer == sort_of(answers.back(), protocol);
  if (answers.back().learnt) one.source.section = as_before_decision;
  if (answers.back().learnt) one.source.quote = as_before_sentence;
  if (of_its_vector) one.source = last.clause.source;
  if (of_its_vector && weakest != Binding::derived) one.decisions = last.clause.decisions;
  if (weakest != Binding::derived && one.decisions.empty())
    one.decisions = {{own_model_decision, own_model_sentence}};
}

std::string title_of(const Request& last, std::size_t others, std::size_t links) {
  std::string title = fmt::format("A request of {} ({})", last.topic, last.kind);
  if (others > 0) title += fmt::format(" behind {} others", others);
  return links < 2 ? title : fmt::format("{} on {} connections", title, links);
}

}  // namespace

Case case_of(const std::vector<Request>& requests, const std::vector<Answer>& answers,
             const Memory& memory, const Protocol& protocol, int station, std::string id) {
  Case one = case_of_own_model(protocol);
  one.id = one.vector_id = std::move(id);
  one.memory = memory;
  StepsOnLinks links(
      {requests.begin(), requests.begin() + static_cast<std::ptrdiff_t>(answers.size())});
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const auto add = [&](Step step) { links.add(requests[i], std::move(step), one.steps); };
    links.begin(requests[i], one.steps);
    add(send_of(requests[i]));
    if (!answers[i].bytes.empty()) add(expect_of(answers[i], protocol, station));
    if (answers[i].ended)
      add(step_of(Step::Kind::expect_close));
    else if (answers[i].bytes.empty())
      add(step_of(Step::Kind::silence));
  }
  found(one, requests, answers, protocol);
  const Request& last = requests[answers.size() - 1];
  one.title = title_of(last, answers.size() - 1, links.open());
  one.why = answers.back().learnt ? "what the device answered to this before"
                                  : "what fieldproof's own device answers";
  one.why += "; the last request comes from " + last.vector;
  if (!last.change.empty()) one.why += ": " + last.change;
  return one;
}

}  // namespace fieldproof::explore
