#include "harness/explore/derived.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <functional>
#include <map>
#include <set>

#include "harness/explore/damage.hpp"
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

/// From its first byte to its last one frame: what a bad line leaves of it is ended by the next
/// one.
bool is_one_frame(const Notation& notation) {
  return !notation.empty() && notation.front().kind == Item::Kind::open &&
         notation.back().kind == Item::Kind::close &&
         std::ranges::count(notation, Item::Kind::open, &Item::kind) == 1;
}

bool derives(const Case& one) {
  return one.level == "must" && one.on_model.empty() && !vectors::is_client_case(one) &&
         is_of_any_set_up(one) && !one.fresh && only_request(one) != nullptr &&
         is_one_frame(only_request(one)->frames.front().notation);
}

/// Requests that differ in numbers alone are damaged alike.
std::string shape_of(std::string notation) {
  for (char& c : notation)
    if (std::isdigit(static_cast<unsigned char>(c))) c = '0';
  return notation;
}

/// One thing that a bad line does to a request; it is written down where somebody wants it.
using Damage = std::function<Damaged()>;

/// All of one derivation from these bytes, in their order. `bytes` must outlive them.
std::vector<Damage> damages(const Bytes& bytes, const std::string& derivation, bool text) {
  std::vector<Damage> all;
  const auto add = [&](auto make) { all.emplace_back(make); };
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (unsigned bit = 0; derivation == "flipped" && bit < (text ? 7u : 8u); ++bit)
      add([&bytes, at, bit] { return flipped(bytes, at, bit); });
    if (derivation == "dropped") add([&bytes, at] { return dropped(bytes, at); });
    if (derivation == "doubled") add([&bytes, at] { return doubled(bytes, at); });
    if (at == 0) continue;
    if (derivation == "cut") add([&bytes, at] { return cut(bytes, at); });
    if (derivation == "split") add([&bytes, at] { return paused(bytes, at, {0, false}); });
    // Around 3.5 characters, by which Modbus RTU and the manuals' inter-character time end a frame.
    if (derivation == "paused")
      for (const double characters : {1.0, 3.0, 5.0, 20.0})
        add([&bytes, at, characters] { return paused(bytes, at, {characters, true}); });
  }
  if (derivation == "noise")
    for (const Byte byte : {Byte{0x00}, Byte{0x2A}, Byte{0x7F}}) {
      add([&bytes, byte] { return with_byte_before(bytes, byte); });
      add([&bytes, byte] { return with_byte_behind(bytes, byte); });
    }
  if (derivation == "joined")
    add([&bytes] {
      Bytes twice = bytes;
      twice.insert(twice.end(), bytes.begin(), bytes.end());
      return Damaged{raw_notation(twice), "twice without a pause"};
    });
  return all;
}

template <typename List>
void sample(List& list, std::size_t at_most, std::uint64_t seed) {
  Random random(seed);
  while (at_most > 0 && list.size() > at_most)
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(random.below(list.size())));
}

/// Those that the model answers so that a case can tell it, whatever stands before them.
Result<std::vector<Request>> tellable(std::vector<Request> rest, const Request& right,
                                      const Memory& memory, Oracle& oracle) {
  std::vector<Request> told;
  while (!rest.empty()) {
    std::vector<Request> asked = rest;
    asked.push_back(right);
    const Result<std::vector<Answer>> answers = oracle.ask(asked, memory, true);
    if (!answers) return answers.error();
    const auto end =
        rest.begin() + static_cast<std::ptrdiff_t>(std::min(answers->size(), rest.size()));
    std::move(rest.begin(), end, std::back_inserter(told));
    rest.erase(rest.begin(), end == rest.end() ? end : end + 1);
  }
  return told;
}

/// These and the right request behind them; nothing where the model does not answer all of it.
Result<std::optional<Case>> case_of(const Case& source, std::vector<Request> wrong,
                                    const Request& right, const Protocol& protocol, int station,
                                    Oracle& oracle, std::string id) {
  wrong.push_back(right);
  const Result<std::vector<Answer>> answers = oracle.ask(wrong, source.memory, true);
  if (!answers) return answers.error();
  if (answers->size() < wrong.size()) return std::optional<Case>();
  Case one = explore::case_of(wrong, *answers, source.memory, protocol, station, std::move(id));
  one.title = fmt::format("{} requests are {}: answered as by our own device, then the right one",
                          wrong.size() - 1, wrong.front().kind);
  one.by_rule = true;
  one.models = source.models;
  one.config = source.config;
  one.why = "made by rule from " + source.id;
  return std::optional(std::move(one));
}

Request damaged(const Request& right, const std::string& derivation, const Damage& damage) {
  Damaged made = damage();
  return {right.topic, right.vector,           std::move(made.notation),
          derivation,  std::move(made.change), {}};
}

/// Derives the cases of one request.
struct Deriver {
  const Case& source;
  const Request& right;
  const Protocol& protocol;
  int station;
  Oracle& oracle;
  const std::function<bool(const std::string& id)>& wanted;

  /// A case for so many of them: a server ends a connection that rests for long.
  Status add_cases(const std::string& derivation, const std::vector<Damage>& all,
                   std::vector<Case>& cases) const {
    constexpr std::size_t in_one_case = 48;
    for (std::size_t from = 0; from < all.size(); from += in_one_case) {
      const std::string id =
          fmt::format("{}/derived/{}{}", source.id, derivation,
                      from == 0 ? "" : fmt::format("_{}", from / in_one_case + 1));
      if (!wanted(id)) continue;
      std::vector<Request> wrong;
      for (std::size_t i = from; i < std::min(from + in_one_case, all.size()); ++i)
        wrong.push_back(damaged(right, derivation, all[i]));
      Result<std::vector<Request>> told = tellable(std::move(wrong), right, source.memory, oracle);
      if (!told) return told.error();
      if (told->empty()) continue;
      Result<std::optional<Case>> one =
          case_of(source, std::move(*told), right, protocol, station, oracle, id);
      if (!one) return one.error();
      if (*one) cases.push_back(std::move(**one));
    }
    return ok();
  }
};

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
  std::vector<Damage> all = damages(*bytes, derivation, protocol.is_text());
  sample(all, at_most, seed);
  for (const Damage& one : all) derived.push_back(damaged(request, derivation, one));
  return derived;
}

Result<std::vector<Case>> derived_cases(const std::vector<Case>& cases,
                                        const harness::Protocols& protocols, std::size_t at_most,
                                        std::uint64_t seed,
                                        const std::function<bool(const std::string& id)>& wanted) {
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
    if (!seen.insert(source.protocol + shape_of(notation::print(send.frames.front().notation)))
             .second)
      continue;
    auto oracle = oracles.find(device);
    if (oracle == oracles.end()) {
      Result<Oracle> made = Oracle::open(*protocol, model, station);
      if (!made) return made.error();
      oracle = oracles.emplace(device, std::move(*made)).first;
    }
    const Request right{"", source.id, send.frames.front().notation};
    const Result<Bytes> bytes = safety::bytes_of(right.notation, protocol->fields_at(station));
    if (!bytes) continue;
    const Deriver deriver{source, right, *protocol, station, oracle->second, wanted};
    for (const std::string& derivation : derivations(*protocol)) {
      std::vector<Damage> all = damages(*bytes, derivation, protocol->is_text());
      sample(all, at_most, seed);
      if (const Status added = deriver.add_cases(derivation, all, derived); !added)
        return added.error();
    }
  }
  return derived;
}

}  // namespace fieldproof::explore
