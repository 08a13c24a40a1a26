#include "harness/explore/client_sequences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <set>

#include "harness/exchange/exchange.hpp"

namespace fieldproof::explore {

using nlohmann::json;
using results::CaseResult;
using vectors::Case;
using vectors::Step;

namespace {

constexpr std::size_t most_blocks = 4;
const std::vector<std::string> actions{"power_cycle", "stop", "run", "link off", "link on"};

std::string kind_of(const Stimulus& stimulus) {
  if (!stimulus.action.empty()) return stimulus.action;
  if (stimulus.fired.size() > 1) return "at once";
  return stimulus.faults.front().empty() ? "well" : stimulus.faults.front();
}

std::string name_of(const json& block) {
  return block.value("function", "read") + ' ' + block.value("command", "single");
}

class ClientSequence : public Sequence {
 public:
  ClientSequence(ClientSequences& inventor, ClientSetUp set_up, std::vector<Stimulus> stimuli,
                 Case one, std::vector<std::size_t> ends)
      : inventor_(inventor),
        set_up_(std::move(set_up)),
        stimuli_(std::move(stimuli)),
        case_(std::move(one)),
        ends_(std::move(ends)),
        config_(set_up_.config.dump()) {}

  std::size_t parts() const override { return stimuli_.size(); }
  std::uint64_t requests() const override {
    return static_cast<std::uint64_t>(
        std::ranges::count(case_.steps, Step::Kind::expect, &Step::kind));
  }
  Topic topic(std::size_t part) const override {
    const Stimulus& stimulus = stimuli_[part];
    if (!stimulus.action.empty()) return {"action", stimulus.action};
    return {name_of(set_up_.blocks[stimulus.fired.front()]), kind_of(stimulus)};
  }
  std::string outcome(std::size_t part) const override {
    if (!stimuli_[part].action.empty()) return "done";
    const auto first =
        case_.steps.begin() + static_cast<std::ptrdiff_t>(part == 0 ? 0 : ends_[part - 1]);
    const auto end = case_.steps.begin() + static_cast<std::ptrdiff_t>(ends_[part]);
    const auto asked =
        std::count_if(first, end, [](const Step& step) { return step.kind == Step::Kind::expect; });
    return fmt::format("{} of {} asked", asked, stimuli_[part].fired.size());
  }

  Case as_case(std::string id) const override {
    Case one = case_;
    one.id = one.vector_id = std::move(id);
    const bool well = requests() == parts() && std::ranges::all_of(stimuli_, [](const auto& each) {
                        return kind_of(each) == "well";
                      });
    one.basis = well ? "derived" : "decision";
    if (!well) one.decisions = {{own_model_decision, own_model_sentence}};
    const Topic last = topic(parts() - 1);
    one.title = fmt::format("Client: {} ({}){}", last.name, last.kind,
                            parts() == 1 ? "" : fmt::format(" behind {} others", parts() - 1));
    one.why = fmt::format(
        "what fieldproof's own device asks and keeps, with {} of the vectors' "
        "blocks side by side",
        set_up_.blocks.size());
    return one;
  }

  /// The one with the frame that did not come; else the last.
  std::size_t failing_part(const CaseResult& result) const override {
    for (std::size_t part = 0, at = 0; part < parts(); ++part)
      for (; at < ends_[part]; ++at)
        if (!result.expected.empty() && case_.steps[at].kind == Step::Kind::expect &&
            case_.steps[at].frames.front().text == result.expected)
          return part;
    return parts() - 1;
  }

  /// By what was asked, and what was wrong, without numbers and addresses.
  std::string mark(std::size_t part, const CaseResult& result) const override {
    std::string words;
    for (const char c : result.message)
      if (!std::isdigit(static_cast<unsigned char>(c)) &&
          !std::isupper(static_cast<unsigned char>(c)))
        words += c;
    return fmt::format("{}/{}: {}", topic(part).name, topic(part).kind, words);
  }

  const std::string& config() const { return config_; }

  Own without(std::size_t from, std::size_t count) const override {
    return inventor_.played(set_up_, left_out(stimuli_, from, count));
  }

  /// Blocks.
  std::size_t settings() const override { return set_up_.blocks.size(); }
  Own without_settings(std::size_t from, std::size_t count) const override {
    ClientSetUp fewer = set_up_;
    fewer.blocks = left_out(std::move(fewer.blocks), from, count);
    std::vector<Stimulus> stimuli = stimuli_;
    for (Stimulus& stimulus : stimuli)
      for (std::size_t& fired : stimulus.fired) {
        if (fired >= from && fired - from < count) return nullptr;
        fired -= fired > from ? count : 0;
      }
    return inventor_.played(std::move(fewer), std::move(stimuli));
  }

 private:
  ClientSequences& inventor_;
  ClientSetUp set_up_;
  std::vector<Stimulus> stimuli_;
  Case case_;
  std::vector<std::size_t> ends_;
  std::string config_;
};

}  // namespace

ClientSequences::ClientSequences(Client client, ClientPool pool, std::uint64_t seed)
    : client_(std::move(client)), pool_(std::move(pool)), random_(seed) {
  weights_.add("well");
}

Result<std::unique_ptr<ClientSequences>> ClientSequences::open(Client client, ClientPool pool,
                                                               std::uint64_t seed) {
  const harness::Protocol& protocol = *client.protocol;
  const endpoints::EndpointName name{
      "emulator", protocol.models().front(), {{"protocol", std::string(protocol.name())}}};
  Result<std::unique_ptr<endpoints::Endpoint>> model = endpoints::open_endpoint(name, protocol);
  if (!model) return model.error();
  std::unique_ptr<ClientSequences> made(
      new ClientSequences(std::move(client), std::move(pool), seed));
  made->model_ = std::move(*model);
  for (const std::string_view fault : vectors::partner_faults) made->try_out(std::string(fault));
  return made;
}

/// Answers of this protocol may have nothing that could be so wrong.
void ClientSequences::try_out(const std::string& fault) {
  constexpr int trials = 20;
  for (int i = 0; i < trials; ++i) {
    ClientSetUp set_up = invent_set_up();
    if (set_up.blocks.empty()) continue;
    const std::size_t last = set_up.blocks.size() - 1;
    if (!played(std::move(set_up), {{"", {0}, {""}, 1}, {"", {last}, {fault}, 2}})) continue;
    weights_.add(fault);
    return;
  }
}

/// Numbers and flags that are their own.
ClientSetUp ClientSequences::invent_set_up() {
  if (pool_.groups.empty() || pool_.results.empty()) return {};
  const ClientPool::Group& group = random_.of(pool_.groups);
  ClientSetUp set_up{group.config, {}, random_.below(SIZE_MAX)};
  std::set<BlockNumber> numbers;
  std::set<std::string> flags;
  const std::size_t count = 1 + random_.below(most_blocks);
  for (std::size_t trial = 0; set_up.blocks.size() < count && trial < 4 * count; ++trial) {
    json block = random_.of(group.blocks);
    auto number = pool_.results.begin();
    std::advance(number, static_cast<std::ptrdiff_t>(random_.below(pool_.results.size())));
    const std::string& flag = random_.of(pool_.flags);
    if (numbers.contains(number->first) || flags.contains(flag)) continue;
    if (number->first.first != block.value("parameter", 1)) continue;  // of another channel
    numbers.insert(number->first);
    flags.insert(flag);
    block["block"] = number->first.second;
    block["flag"] = flag;
    set_up.blocks.push_back(std::move(block));
  }
  std::ranges::sort(set_up.blocks, {}, [](const json& block) { return block["block"].get<int>(); });
  return set_up;
}

Stimulus ClientSequences::invent_stimulus(std::size_t blocks, bool well) {
  Stimulus stimulus;
  if (!well && !client_.over_the_wire && random_.chance(8)) {
    stimulus.action = random_.of(actions);
    return stimulus;
  }
  const std::size_t first = random_.below(blocks);
  // A program that is told of one flag after another asks in that order.
  const bool at_once = !well && !client_.over_the_wire;
  for (std::size_t i = 0; i < blocks; ++i)
    if (i == first || (at_once && random_.chance(15))) stimulus.fired.push_back(i);
  for (std::size_t i = 0; i < stimulus.fired.size(); ++i) {
    const std::string fault = well ? "well" : weights_.choose(random_);
    stimulus.faults.push_back(fault == "well" || random_.chance(40) ? "" : fault);
  }
  stimulus.data = random_.below(SIZE_MAX);
  return stimulus;
}

Sequence::Own ClientSequences::invent() {
  ClientSetUp set_up = invent_set_up();
  if (set_up.blocks.empty()) return nullptr;
  const bool well = random_.chance(30);
  const std::size_t length = random_.chance(80) ? 1 + random_.below(6) : 6 + random_.below(20);
  std::vector<Stimulus> stimuli;
  for (std::size_t i = 0; i < length; ++i)
    stimuli.push_back(invent_stimulus(set_up.blocks.size(), well));
  return played(std::move(set_up), std::move(stimuli));
}

const std::string& ClientSequences::config_of(const Sequence& sequence) {
  return static_cast<const ClientSequence&>(sequence).config();
}

void ClientSequences::done(const Sequence& sequence) { followed_.insert(config_of(sequence)); }

/// The program of this device takes no such configuration (a time-out that it cannot keep).
bool ClientSequences::give_up(const Sequence& sequence) {
  constexpr int enough = 3;  // a fault of the partner alone may be what it cannot have
  const std::string& config = config_of(sequence);
  if (!followed_.contains(config) && ++refused_[config] == enough)
    std::erase_if(pool_.groups, [&](const auto& group) { return group.config.dump() == config; });
  return !pool_.groups.empty();
}

/// Twice where something was not asked for: without the wait for it, the rest may be another.
Sequence::Own ClientSequences::played(ClientSetUp set_up, std::vector<Stimulus> stimuli) {
  // What it has done before, a real device remembers in its results.
  static const std::map<BlockNumber, std::set<Watched>> nowhere;
  auto [one, ends] = client_script(set_up, stimuli, *client_.protocol,
                                   client_.over_the_wire ? nowhere : pool_.results);
  for (int round = 0; round < 2; ++round) {
    json config = one.config;
    config["model"] = client_.model;
    if (!model_->begin(config)) return nullptr;
    for (const auto& [address, hex] : one.memory)
      if (!model_->set(address, hex)) return nullptr;
    const Result<exchange::PreparedCase> prepared = exchange::prepare(one, 1, *client_.protocol);
    if (!prepared) return nullptr;
    const exchange::Transcript transcript =
        exchange::Exchange(*model_, *client_.protocol, {}).run(*prepared);
    bool unasked = false;
    if (transcript.trouble || !fill(one, transcript, pool_.open, unasked)) return nullptr;
    if (!unasked)
      return std::make_unique<ClientSequence>(*this, std::move(set_up), std::move(stimuli),
                                              std::move(one), std::move(ends));
  }
  return nullptr;
}

}  // namespace fieldproof::explore
