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

/// Not as a bad line makes it, for which no manual prints an answer.
bool is_a_right_frame(const Request& request) {
  return request.kind != "damage" && request.kind != "pause";
}

bool granted(const Answer& answer, const Protocol& protocol) {
  return sort_of(answer, protocol) == "answered";
}

/// One frame, or several without a pause, after the whole request: what a case can wait for in one
/// step.
bool in_one_piece(const exchange::Received& received, Time asked) {
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

/// Up to the first after which something came that belongs to none; and no further than a minute,
/// since servers end connections that rest.
std::vector<Sending> sendings_in(const exchange::Transcript& transcript) {
  using Kind = results::Event::Kind;
  std::vector<Sending> sendings;
  for (const results::Event& event : transcript.events) {
    if (event.kind == Kind::sent && event.step >= 0) {
      if (event.start - transcript.events.front().start > 60s) break;
      const std::size_t number = static_cast<std::size_t>(event.step) / 2;
      const bool ended = !sendings.empty() && sendings.back().ended;
      if (ended && number < sendings.size()) sendings.pop_back();  // in the middle of it
      if (ended) break;
      sendings.resize(number + 1);
      sendings.back().end = event.end;
    } else if (event.kind == Kind::closed || event.kind == Kind::reset) {
      if (event.by_device && sendings.empty()) break;
      if (event.by_device) sendings.back().ended = true;
    } else if (event.kind == Kind::received && (event.surplus || event.step % 2 == 0)) {
      break;
    }
  }
  return sendings;
}

/// Up to the first that no case can tell in order.
std::vector<Answer> answers_in(const exchange::Transcript& transcript) {
  const exchange::Shares shares = exchange::shares_of(transcript);
  const std::vector<Sending> sendings = sendings_in(transcript);
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < sendings.size() && 2 * i + 1 < shares.steps.size(); ++i) {
    const exchange::Received& heard = shares.steps[2 * i + 1].received;
    if (!in_one_piece(heard, sendings[i].end)) break;
    answers.push_back({heard.bytes, sendings[i].ended});
  }
  return answers;
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
  if (answer.bytes.empty()) return answer.ended ? "closed" : "silence";
  for (const Field& field : protocol.explain_as(answer.bytes, false))
    if (field.name == "error code" || field.name == "exception code") return field.text;
  return "answered";
}

Result<Oracle> Oracle::open(const Protocol& protocol, const std::string& model, int station) {
  Oracle oracle(protocol, model, station);
  const endpoints::EndpointName name{
      "emulator",
      model,
      {{"protocol", std::string(protocol.name())}, {"station", std::to_string(station)}}};
  for (auto* one : {&oracle.fresh_, &oracle.used_}) {
    Result<std::unique_ptr<endpoints::Endpoint>> endpoint =
        endpoints::open_endpoint(name, protocol);
    if (!endpoint) return endpoint.error();
    *one = std::move(*endpoint);
  }
  const Status begun = oracle.used_->begin(nlohmann::json{{"station", station}, {"model", model}});
  if (!begun) return begun.error();
  return oracle;
}

Result<std::vector<Answer>> Oracle::ask(const std::vector<Request>& requests, const Memory& memory,
                                        bool fresh) {
  endpoints::Endpoint& device = fresh ? *fresh_ : *used_;
  if (fresh)
    if (const Status begun = device.begin(nlohmann::json{{"station", station_}, {"model", model_}});
        !begun)
      return begun.error();
  for (const auto& [address, hex] : memory)
    if (const Status set = device.set(address, hex); !set) return set.error();
  Case asked;
  asked.protocol = protocol_->name();
  for (const Request& request : requests) {
    asked.steps.push_back(send_of(request));
    asked.steps.push_back(step_of(Step::Kind::silence));
  }
  const Result<PreparedCase> prepared = exchange::prepare(asked, station_, *protocol_);
  if (!prepared) return prepared.error();
  const exchange::Transcript transcript =
      exchange::Exchange(device, *protocol_, {}).run_steps(*prepared);
  if (transcript.trouble) return *transcript.trouble;
  return answers_in(transcript);
}

Case case_of(const std::vector<Request>& requests, const std::vector<Answer>& answers,
             const Memory& memory, const Protocol& protocol, int station, std::string id) {
  Case one = case_of_own_model(protocol);
  one.id = one.vector_id = std::move(id);
  one.memory = memory;
  bool all_granted = true;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Answer& answer = answers[i];
    all_granted &= granted(answer, protocol) && is_a_right_frame(requests[i]);
    one.steps.push_back(send_of(requests[i]));
    if (!answer.bytes.empty()) one.steps.push_back(expect_of(answer, protocol, station));
    if (answer.ended)
      one.steps.push_back(step_of(Step::Kind::expect_close));
    else if (answer.bytes.empty())
      one.steps.push_back(step_of(Step::Kind::silence));
  }
  one.basis = all_granted ? "derived" : "decision";
  if (!all_granted) one.decisions = {{own_model_decision, one.source.quote}};
  const Request& last = requests[answers.size() - 1];
  one.title = answers.size() == 1 ? fmt::format("A request of {} ({})", last.topic, last.kind)
                                  : fmt::format("A request of {} ({}) behind {} others", last.topic,
                                                last.kind, answers.size() - 1);
  one.why = "what fieldproof's own device answers; the last request comes from " + last.vector;
  if (!last.change.empty()) one.why += ": " + last.change;
  return one;
}

}  // namespace fieldproof::explore
