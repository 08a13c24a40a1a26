#include "harness/explore/client_sequences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>

#include "harness/exchange/exchange.hpp"
#include "harness/exchange/p2p_blocks.hpp"
#include "harness/explore/oracle.hpp"

namespace fieldproof::explore {

using nlohmann::json;
using results::CaseResult;
using vectors::Case;
using vectors::PartnerSpec;
using vectors::Step;

namespace {

constexpr std::size_t most_blocks = 4;
constexpr Duration answered_soon = 150ms, given_up = 700ms;  // the usual time-out is 200 ms
constexpr Duration longest_wait = 450ms;  // then a device asks by a clock of its own
const std::vector<std::string> actions{"power_cycle", "stop", "run", "link off", "link on"};

std::string random_hex(std::size_t count, Random& random) {
  std::string hex;
  for (std::size_t i = 0; i < count; ++i) hex += "0123456789ABCDEF"[random.below(16)];
  return hex;
}

/// Bits have two digits each, 00 or 01.
std::string random_data(const json& block, std::size_t count, Random& random) {
  if (block.value("type", "word") != "bit") return random_hex(count, random);
  std::string hex;
  for (std::size_t i = 0; i < count; i += 2) hex += random.chance(50) ? "01" : "00";
  return hex;
}

Step wait_of(Duration duration) {
  Step step = step_of(Step::Kind::wait);
  step.duration = duration;
  return step;
}

Step set_of(const std::map<std::string, std::string>& memory) {
  Step step = step_of(Step::Kind::set);
  step.memory.assign(memory.begin(), memory.end());
  return step;
}

std::string kind_of(const Stimulus& stimulus) {
  if (!stimulus.action.empty()) return stimulus.action;
  if (stimulus.fired.size() > 1) return "at once";
  return stimulus.faults.front().empty() ? "well" : stimulus.faults.front();
}

std::string name_of(const json& block) {
  return block.value("function", "read") + ' ' + block.value("command", "single");
}

/// As it stands in a configuration: what all of them share stands beside them.
json as_given(json block) {
  if (block.value("command", "single") == "single") block.erase("size");
  block.erase("parameter");
  block.erase("transport");
  return block;
}

/// What the partner holds where the block reads, in the spelling of both; where the partner's is
/// another, some words of each area of it.
std::vector<std::pair<std::string, std::string>> partner_memory(const json& block,
                                                                const harness::Protocol& protocol,
                                                                Random& random) {
  std::vector<std::pair<std::string, std::string>> memory;
  if (block.value("function", "") != "read") return memory;
  const std::size_t each = own_memory(block).front().second;
  for (const std::string& address : block["read"].get<std::vector<std::string>>())
    if (address.starts_with('%')) memory.emplace_back(address, random_data(block, each, random));
  if (!memory.empty()) return memory;
  for (const harness::Protocol::Area& area : protocol.areas())
    memory.emplace_back(fmt::format("%{}W0", area.name), random_hex(4 * 16, random));
  return memory;
}

/// The steps of a sequence, in which what the device asks is still open.
class Script {
 public:
  Script(const ClientSequences& inventor, const ClientSequences::SetUp& set_up,
         const std::vector<Stimulus>& stimuli)
      : client_(inventor.client()), pool_(inventor.pool()), blocks_(set_up.blocks) {
    one_ = case_of_own_model(*client_.protocol);
    one_.config = set_up.config;
    one_.transpose = false;
    Random random(set_up.data);
    std::map<std::string, std::string> memory;
    for (const json& block : blocks_) {
      one_.config["p2p"]["blocks"].push_back(as_given(block));
      for (const auto& [address, count] : own_memory(block))
        memory[address] = random_data(block, count, random);
    }
    one_.memory.assign(memory.begin(), memory.end());
    for (const Stimulus& stimulus : stimuli) {
      add(stimulus);
      ends_.push_back(one_.steps.size());
    }
  }

  Case take() { return std::move(one_); }
  /// The first step behind each part.
  std::vector<std::size_t> take_ends() { return std::move(ends_); }

 private:
  void add(const Stimulus& stimulus) {
    if (!stimulus.action.empty()) {
      Step act = step_of(Step::Kind::act);
      act.action = stimulus.action;
      one_.steps.push_back(std::move(act));
      one_.steps.push_back(wait_of(answered_soon));
      return;
    }
    Random random(stimulus.data);
    std::map<std::string, std::string> sources, on, off;
    for (const std::size_t at : stimulus.fired) {
      const json& block = blocks_[at];
      if (block["function"] == "write")
        for (const auto& [address, count] : own_memory(block))
          sources[address] = random_data(block, count, random);
      on[exchange::flag_of(block)] = "01";
      off[exchange::flag_of(block)] = "00";
    }
    if (!sources.empty()) one_.steps.push_back(set_of(sources));
    one_.steps.push_back(set_of(on));
    bool well = true;
    for (std::size_t i = 0; i < stimulus.fired.size(); ++i) {
      one_.steps.push_back(request_of(blocks_[stimulus.fired[i]], stimulus.faults[i], random));
      well &= stimulus.faults[i].empty();
    }
    one_.steps.push_back(wait_of(well ? answered_soon : given_up));
    one_.steps.push_back(look());
    one_.steps.push_back(set_of(off));
    one_.steps.push_back(wait_of(answered_soon));
  }

  Step request_of(const json& block, const std::string& fault, Random& random) const {
    Step step = step_of(Step::Kind::expect);
    step.partner =
        PartnerSpec{"", json::object(), partner_memory(block, *client_.protocol, random), fault};
    if (block.contains("station")) step.partner->config["station"] = block["station"];
    return step;
  }

  /// At the memory of all blocks; where nobody has asked before, at their results, too.
  Step look() const {
    std::map<std::string, std::string> places;
    for (const json& block : blocks_) {
      for (const auto& [address, count] : own_memory(block))
        places[address] = std::string(count, '0');
      if (client_.over_the_wire) continue;
      const auto results =
          pool_.results.find({block.value("parameter", 1), block.value("block", 0)});
      if (results == pool_.results.end()) continue;
      for (const auto& [address, count] : results->second)
        places.emplace(address, std::string(count, '0'));
    }
    Step step = step_of(Step::Kind::check);
    step.memory.assign(places.begin(), places.end());
    step.numbers.resize(step.memory.size());
    return step;
  }

  const Client& client_;
  const ClientPool& pool_;
  const std::vector<json>& blocks_;
  Case one_;
  std::vector<std::size_t> ends_;
};

class ClientSequence : public Sequence {
 public:
  ClientSequence(ClientSequences& inventor, ClientSequences::SetUp set_up,
                 std::vector<Stimulus> stimuli, Case one, std::vector<std::size_t> ends)
      : inventor_(inventor),
        set_up_(std::move(set_up)),
        stimuli_(std::move(stimuli)),
        case_(std::move(one)),
        ends_(std::move(ends)) {}

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
    const bool well = std::ranges::all_of(
        stimuli_, [](const Stimulus& stimulus) { return kind_of(stimulus) == "well"; });
    one.basis = well && requests() == parts() ? "derived" : "decision";
    if (!well || requests() != parts()) one.decisions = {{own_model_decision, one.source.quote}};
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

  Own without(std::size_t from, std::size_t count) const override {
    std::vector<Stimulus> fewer = stimuli_;
    const auto first = fewer.begin() + static_cast<std::ptrdiff_t>(from);
    fewer.erase(first, first + static_cast<std::ptrdiff_t>(std::min(count, fewer.size() - from)));
    return inventor_.played(set_up_, std::move(fewer));
  }

  /// Blocks.
  std::size_t settings() const override { return set_up_.blocks.size(); }
  Own without_setting(std::size_t at) const override {
    ClientSequences::SetUp fewer = set_up_;
    fewer.blocks.erase(fewer.blocks.begin() + static_cast<std::ptrdiff_t>(at));
    std::vector<Stimulus> stimuli = stimuli_;
    for (Stimulus& stimulus : stimuli) {
      if (std::ranges::find(stimulus.fired, at) != stimulus.fired.end()) return nullptr;
      for (std::size_t& fired : stimulus.fired) fired -= fired > at;
    }
    return inventor_.played(std::move(fewer), std::move(stimuli));
  }

 private:
  ClientSequences& inventor_;
  ClientSequences::SetUp set_up_;
  std::vector<Stimulus> stimuli_;
  Case case_;
  std::vector<std::size_t> ends_;
};

/// Puts what our own device did where it is expected. False: something came that no step was
/// waiting for, before an answer was out, or long after it; or a step could not be done. `unasked`:
/// steps whose request did not come.
bool fill(Case& one, const exchange::Transcript& transcript, const std::set<std::size_t>& open,
          std::vector<std::size_t>& unasked) {
  const exchange::Shares shares = exchange::shares_of(transcript);
  if (transcript.steps.size() != one.steps.size() || transcript.flooded) return false;
  if (!shares.surplus.received.bytes.empty()) return false;
  for (std::size_t i = 0; i < one.steps.size(); ++i) {
    Step& step = one.steps[i];
    const exchange::StepRecord& record = transcript.steps[i];
    const Bytes& came = shares.steps[i].received.bytes;
    if (!record.refused.empty()) return false;
    if (step.kind == Step::Kind::check) step.memory = record.memory;
    if (step.kind != Step::Kind::expect) {
      if (!came.empty()) return false;
      continue;
    }
    if (came.empty()) {
      unasked.push_back(i);
      continue;
    }
    const Duration took = shares.steps[i].received.arrivals.front().start - record.cause;
    if (took < 0ns || took > longest_wait) return false;
    vectors::Frame frame;
    frame.notation = request_notation(came, open);
    frame.text = notation::print(frame.notation);
    step.frames = {std::move(frame)};
  }
  return true;
}

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
    SetUp set_up = invent_set_up();
    if (set_up.blocks.empty()) continue;
    const std::size_t last = set_up.blocks.size() - 1;
    if (!played(std::move(set_up), {{"", {0}, {""}, 1}, {"", {last}, {fault}, 2}})) continue;
    weights_.add(fault);
    return;
  }
}

/// Numbers and flags that are their own.
ClientSequences::SetUp ClientSequences::invent_set_up() {
  if (pool_.groups.empty() || pool_.results.empty()) return {};
  const ClientPool::Group& group = random_.of(pool_.groups);
  SetUp set_up{group.config, {}, random_.below(SIZE_MAX)};
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
  for (std::size_t i = 0; i < blocks; ++i)
    if (i == first || (!well && random_.chance(15))) stimulus.fired.push_back(i);
  for (std::size_t i = 0; i < stimulus.fired.size(); ++i) {
    const std::string fault = well ? "well" : weights_.choose(random_);
    stimulus.faults.push_back(fault == "well" || random_.chance(40) ? "" : fault);
  }
  stimulus.data = random_.below(SIZE_MAX);
  return stimulus;
}

Sequence::Own ClientSequences::invent() {
  SetUp set_up = invent_set_up();
  if (set_up.blocks.empty()) return nullptr;
  const bool well = random_.chance(30);
  const std::size_t length = random_.chance(80) ? 1 + random_.below(6) : 6 + random_.below(20);
  std::vector<Stimulus> stimuli;
  for (std::size_t i = 0; i < length; ++i)
    stimuli.push_back(invent_stimulus(set_up.blocks.size(), well));
  return played(std::move(set_up), std::move(stimuli));
}

/// What was not asked for is waited for no more, the second time.
Sequence::Own ClientSequences::played(SetUp set_up, std::vector<Stimulus> stimuli) {
  Script script(*this, set_up, stimuli);
  Case one = script.take();
  std::vector<std::size_t> ends = script.take_ends();
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
    std::vector<std::size_t> unasked;
    if (transcript.trouble || !fill(one, transcript, pool_.open, unasked)) return nullptr;
    if (unasked.empty())
      return std::make_unique<ClientSequence>(*this, std::move(set_up), std::move(stimuli),
                                              std::move(one), std::move(ends));
    for (const std::size_t at : unasked) one.steps[at] = wait_of(answered_soon);
  }
  return nullptr;
}

}  // namespace fieldproof::explore
