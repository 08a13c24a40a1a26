#include "harness/explore/derived.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
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

/// All of one derivation from these bytes, in their order.
std::vector<Damaged> made_of(const Bytes& bytes, const std::string& derivation, bool text) {
  std::vector<Damaged> made;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (unsigned bit = 0; derivation == "flipped" && bit < (text ? 7u : 8u); ++bit)
      made.push_back(flipped(bytes, at, bit));
    if (derivation == "dropped") made.push_back(dropped(bytes, at));
    if (derivation == "doubled") made.push_back(doubled(bytes, at));
    if (at == 0) continue;
    if (derivation == "cut") made.push_back(cut(bytes, at));
    if (derivation == "split") made.push_back(paused(bytes, at, {0, false}));
    // Around 3.5 characters, by which Modbus RTU and the manuals' inter-character time end a frame.
    if (derivation == "paused")
      for (const double characters : {1.0, 3.0, 5.0, 20.0})
        made.push_back(paused(bytes, at, {characters, true}));
  }
  if (derivation == "noise")
    for (const Byte byte : {Byte{0x00}, Byte{0x2A}, Byte{0x7F}}) {
      made.push_back(with_byte_before(bytes, byte));
      made.push_back(with_byte_behind(bytes, byte));
    }
  if (derivation == "joined") {
    Bytes twice = bytes;
    twice.insert(twice.end(), bytes.begin(), bytes.end());
    made.push_back({raw_notation(twice), "twice without a pause"});
  }
  return made;
}

void sample(std::vector<Request>& list, std::size_t at_most, std::uint64_t seed) {
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
    const Result<std::vector<Answer>> answers = oracle.ask(asked, memory, Past::none);
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
  const Result<std::vector<Answer>> answers = oracle.ask(wrong, source.memory, Past::none);
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

/// So many of them make a case: a server ends a connection that rests for long.
constexpr std::size_t in_one_case = 48;

using Wanted = std::function<bool(const std::string& id)>;

/// Of the `index`-th case of one derivation.
std::string case_id(const Case& source, const std::string& derivation, std::size_t index) {
  return fmt::format("{}/derived/{}{}", source.id, derivation,
                     index == 0 ? "" : fmt::format("_{}", index + 1));
}

/// Most requests are not worth their derivations, for nobody wants one. No derivation makes more of
/// a byte than it has bits.
bool is_any_wanted(const Case& source, const std::string& derivation, std::size_t bytes,
                   const Wanted& wanted) {
  for (std::size_t index = 0; index <= 8 * bytes / in_one_case; ++index)
    if (wanted(case_id(source, derivation, index))) return true;
  return false;
}

Status add_cases(const Case& source, const Request& right, const std::vector<Request>& wrong,
                 const Protocol& protocol, int station, Oracle& oracle, const Wanted& wanted,
                 std::vector<Case>& cases) {
  for (std::size_t from = 0; from < wrong.size(); from += in_one_case) {
    const std::string id = case_id(source, wrong.front().kind, from / in_one_case);
    if (!wanted(id)) continue;
    const auto begin = wrong.begin() + static_cast<std::ptrdiff_t>(from);
    const auto end =
        wrong.begin() + static_cast<std::ptrdiff_t>(std::min(from + in_one_case, wrong.size()));
    Result<std::vector<Request>> told = tellable({begin, end}, right, source.memory, oracle);
    if (!told) return told.error();
    if (told->empty()) continue;
    Result<std::optional<Case>> one =
        case_of(source, std::move(*told), right, protocol, station, oracle, id);
    if (!one) return one.error();
    if (*one) cases.push_back(std::move(**one));
  }
  return ok();
}

}  // namespace

std::vector<std::string> derivations(const Protocol& protocol) {
  if (protocol.on_network()) return {"split", "joined"};
  return {"flipped", "dropped", "doubled", "cut", "paused", "noise", "joined"};
}

std::vector<Request> derived_from(const Request& request, const std::string& derivation,
                                  const Protocol& protocol, int station, std::size_t at_most,
                                  std::uint64_t seed) {
  const Result<Bytes> bytes = safety::bytes_of(request.notation, protocol.fields_at(station));
  std::vector<Request> derived;
  if (!bytes) return derived;
  for (Damaged& one : made_of(*bytes, derivation, protocol.is_text()))
    derived.push_back({request.topic,
                       request.vector,
                       std::move(one.notation),
                       derivation,
                       std::move(one.change),
                       {}});
  sample(derived, at_most, seed);
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
    for (const std::string& derivation : derivations(*protocol)) {
      if (!is_any_wanted(source, derivation, bytes->size(), wanted)) continue;
      if (const Status added = add_cases(
              source, right, derived_from(right, derivation, *protocol, station, at_most, seed),
              *protocol, station, oracle->second, wanted, derived);
          !added)
        return added.error();
    }
  }
  return derived;
}

}  // namespace fieldproof::explore
