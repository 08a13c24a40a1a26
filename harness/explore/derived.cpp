#include "harness/explore/derived.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <set>

#include "harness/safety/brackets.hpp"

namespace fieldproof::explore {

using harness::Protocol;
using notation::Item;
using notation::Notation;
using vectors::Case;
using vectors::Step;

namespace {

/// Set-up, one request, its answer, a look at memory: then the same request can be sent again.
const Step* only_request(const Case& one) {
  const Step* request = nullptr;
  bool answered = false;
  for (const Step& step : one.steps) {
    if (step.kind == Step::Kind::check || (step.kind == Step::Kind::set && !request)) continue;
    if (step.kind == Step::Kind::send && !request)
      request = &step;
    else if (step.kind == Step::Kind::expect && request && !answered && step.frames.size() == 1)
      answered = true;
    else
      return nullptr;
  }
  return answered && request->times == 1 && request->on.empty() ? request : nullptr;
}

bool derives(const Case& one) {
  return one.level == "must" && one.on_model.empty() && !vectors::is_client_case(one) &&
         std::ranges::all_of(one.config.items(),
                             [](const auto& item) { return item.key() == "station"; }) &&
         !one.fresh && only_request(one) != nullptr;
}

/// Requests that differ in numbers alone are damaged alike.
std::string shape_of(std::string notation) {
  for (char& c : notation)
    if (std::isdigit(static_cast<unsigned char>(c))) c = '0';
  return notation;
}

Item pause(double amount, bool characters) {
  Item item;
  item.kind = Item::Kind::pause;
  item.pause = {amount, characters};
  item.text = fmt::format("~{:g}{}", amount, characters ? "c" : "ms");
  return item;
}

Notation in_two(ByteView bytes, std::size_t at, Item between) {
  Notation notation = raw_notation(bytes.first(at));
  notation.push_back(std::move(between));
  std::ranges::move(raw_notation(bytes.subspan(at)), std::back_inserter(notation));
  return notation;
}

/// Notations of a derivation, and what was done in words.
class Derivation {
 public:
  Derivation(const Bytes& bytes, bool text) : bytes_(bytes), text_(text) {}

  using Made = std::vector<std::pair<Notation, std::string>>;
  Made make(const std::string& derivation) {
    for (std::size_t at = 0; at < bytes_.size(); ++at) {
      if (derivation == "flipped") flip(at);
      if (derivation == "dropped") drop(at);
      if (derivation == "doubled") repeat(at);
      if (derivation == "cut" && at > 0) cut(at);
      if (derivation == "paused" && at > 0) rest(at);
      if (derivation == "split" && at > 0)
        made_.emplace_back(in_two(bytes_, at, pause(0, false)),
                           fmt::format("a segment ends before byte {}", at));
    }
    if (derivation == "noise") noise();
    if (derivation == "joined") join();
    return std::move(made_);
  }

 private:
  Bytes::iterator place(Bytes& bytes, std::size_t at) const {
    return bytes.begin() + static_cast<std::ptrdiff_t>(at);
  }
  void add(const Bytes& bytes, std::string change) {
    made_.emplace_back(raw_notation(bytes), std::move(change));
  }
  void flip(std::size_t at) {
    for (unsigned bit = 0; bit < (text_ ? 7u : 8u); ++bit) {
      Bytes bytes = bytes_;
      bytes[at] = static_cast<Byte>(bytes[at] ^ (1u << bit));
      add(bytes, fmt::format("bit {} of byte {} flipped", bit, at));
    }
  }
  void drop(std::size_t at) {
    Bytes bytes = bytes_;
    bytes.erase(place(bytes, at));
    if (!bytes.empty()) add(bytes, fmt::format("byte {} dropped", at));
  }
  void repeat(std::size_t at) {
    Bytes bytes = bytes_;
    bytes.insert(place(bytes, at), bytes_[at]);
    add(bytes, fmt::format("byte {} doubled", at));
  }
  void cut(std::size_t at) {
    add(Bytes(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at)),
        fmt::format("cut after {} bytes", at));
  }
  /// Around 3.5 characters, by which Modbus RTU and the manuals' inter-character time end a frame.
  void rest(std::size_t at) {
    for (const double characters : {1.0, 3.0, 5.0, 20.0})
      made_.emplace_back(in_two(bytes_, at, pause(characters, true)),
                         fmt::format("{:g} characters of silence before byte {}", characters, at));
  }
  void noise() {
    for (const Byte byte : {Byte{0x00}, Byte{0x2A}, Byte{0x7F}}) {
      Bytes before = bytes_, behind = bytes_;
      before.insert(before.begin(), byte);
      behind.push_back(byte);
      add(before, fmt::format("{:02X} before it", byte));
      add(behind, fmt::format("{:02X} behind it", byte));
    }
  }
  void join() {
    Bytes bytes = bytes_;
    bytes.insert(bytes.end(), bytes_.begin(), bytes_.end());
    add(bytes, "twice without a pause");
  }

  const Bytes& bytes_;
  bool text_;
  Made made_;
};

template <typename List>
void sample(List& list, std::size_t at_most, std::uint64_t seed) {
  Random random(seed);
  while (at_most > 0 && list.size() > at_most)
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(random.below(list.size())));
}

/// Those that the model answers in an order that a case can tell; the last one is the right request.
Result<std::vector<Case>> cases_of(const Case& source, const std::string& derivation,
                                   const Request& right, std::vector<Request> wrong,
                                   const Protocol& protocol, int station, Oracle& oracle) {
  std::vector<Case> cases;
  while (!wrong.empty()) {
    std::vector<Request> asked = wrong;
    asked.push_back(right);
    Result<std::vector<Answer>> answers = oracle.ask(asked, source.memory, true);
    if (!answers) return answers.error();
    const std::size_t told = std::min(answers->size(), wrong.size());
    if (told == wrong.size() && answers->size() <= told) break;  // not even the right one
    if (told > 0) {
      if (told < wrong.size()) {  // a case of its own, which ends with the right request
        asked.assign(wrong.begin(), wrong.begin() + static_cast<std::ptrdiff_t>(told));
        asked.push_back(right);
        answers = oracle.ask(asked, source.memory, true);
        if (!answers) return answers.error();
      }
      Case one = case_of(asked, *answers, source.memory, protocol, station,
                         fmt::format("{}/derived/{}{}", source.id, derivation,
                                     cases.empty() ? "" : fmt::format("_{}", cases.size() + 1)));
      one.title = fmt::format("{} requests {}, answered as our own device does, then the right one",
                              answers->size() - 1, derivation);
      one.by_rule = true;
      one.models = source.models;
      one.config = source.config;
      one.why = "made by rule from " + source.id;
      cases.push_back(std::move(one));
    }
    // The next one after what was told cannot be told.
    wrong.erase(wrong.begin(),
                wrong.begin() + static_cast<std::ptrdiff_t>(std::min(wrong.size(), told + 1)));
  }
  return cases;
}

}  // namespace

std::vector<std::string> derivations(const Protocol& protocol) {
  if (protocol.default_port() != 0) return {"split", "joined"};
  return {"flipped", "dropped", "doubled", "cut", "paused", "noise", "joined"};
}

std::vector<Request> derived_from(const Request& request, const std::string& derivation,
                                  const Protocol& protocol, int station, std::size_t at_most,
                                  std::uint64_t seed) {
  const Result<Bytes> bytes = safety::bytes_of(request.notation, protocol.fields_at(station));
  std::vector<Request> derived;
  if (!bytes) return derived;
  for (auto& [notation, change] : Derivation(*bytes, protocol.is_text()).make(derivation))
    derived.push_back({request.topic, request.source, std::move(notation), derivation, change, {}});
  sample(derived, at_most, seed);
  return derived;
}

Result<std::vector<Case>> derived_cases(const std::vector<Case>& cases,
                                        const harness::Protocols& protocols, std::size_t at_most,
                                        std::uint64_t seed) {
  std::vector<Case> derived;
  std::map<std::string, Oracle> oracles;  // by protocol and model
  std::set<std::string> seen;
  for (const Case& source : cases) {
    const Protocol* protocol = protocols.find(source.protocol);
    if (!protocol || !protocol->memory() || !derives(source)) continue;
    const Step& send = *only_request(source);
    const std::string model =
        source.models.empty() ? protocol->models().front() : source.models.front();
    const int station = vectors::config_station(source.config, 1).value_or(1);
    const std::string device = fmt::format("{} {} {}", source.protocol, model, station);
    if (!seen.insert(source.protocol + shape_of(notation::print(send.frames.front().notation))).second)
      continue;
    auto oracle = oracles.find(device);
    if (oracle == oracles.end()) {
      Result<Oracle> made = Oracle::open(*protocol, model, station);
      if (!made) return made.error();
      oracle = oracles.emplace(device, std::move(*made)).first;
    }
    const Request right{"", source.source, send.frames.front().notation};
    for (const std::string& derivation : derivations(*protocol)) {
      Result<std::vector<Case>> made =
          cases_of(source, derivation, right,
                   derived_from(right, derivation, *protocol, station, at_most, seed), *protocol,
                   station, oracle->second);
      if (!made) return made.error();
      std::ranges::move(*made, std::back_inserter(derived));
    }
  }
  return derived;
}

}  // namespace fieldproof::explore
