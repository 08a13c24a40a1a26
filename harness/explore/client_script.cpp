#include "harness/explore/client_script.hpp"

#include <fmt/format.h>

#include <map>

#include "harness/exchange/client_program.hpp"
#include "harness/exchange/p2p_blocks.hpp"
#include "harness/explore/sequence.hpp"

namespace fieldproof::explore {

using nlohmann::json;
using vectors::Case;
using vectors::PartnerSpec;
using vectors::Step;

namespace {

using Values = std::map<std::string, std::string>;  // address and hex digits

constexpr Duration answered_soon = 150ms;
constexpr Duration behind_time_out = 500ms;  // until a device has surely given up
constexpr Duration longest_wait = 450ms;     // then a device asks by a clock of its own

/// Bits have two digits each, 00 or 01.
std::string random_data(const json& block, std::size_t count, Random& random) {
  if (block.value("type", "word") != "bit") return random.hex(count);
  std::string hex;
  for (std::size_t i = 0; i < count; i += 2) hex += random.chance(50) ? "01" : "00";
  return hex;
}

Step wait_of(Duration duration) {
  Step step = step_of(Step::Kind::wait);
  step.duration = duration;
  return step;
}

Step set_of(const Values& memory) {
  Step step = step_of(Step::Kind::set);
  step.memory.assign(memory.begin(), memory.end());
  return step;
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
    memory.emplace_back(fmt::format("%{}W0", area.name), random.hex(4 * 16));
  return memory;
}

/// Writes the steps.
class Writer {
 public:
  Writer(const ClientSetUp& set_up, const harness::Protocol& protocol,
         const std::map<BlockNumber, std::set<Watched>>& results)
      : blocks_(set_up.blocks),
        protocol_(protocol),
        results_(results),
        given_up_(exchange::client_time_out(set_up.config, !protocol.on_network()) +
                  behind_time_out) {
    Case& one = script_.one;
    one = case_of_own_model(protocol);
    one.config = set_up.config;
    one.transpose = false;
    Random random(set_up.data);
    Values memory;
    for (const json& block : blocks_) {
      one.config["p2p"]["blocks"].push_back(as_given(block));
      for (const auto& [address, count] : own_memory(block))
        memory[address] = random_data(block, count, random);
    }
    one.memory.assign(memory.begin(), memory.end());
  }

  void add(const Stimulus& stimulus) {
    if (stimulus.action.empty())
      fire(stimulus);
    else
      act(stimulus.action);
    script_.ends.push_back(script_.one.steps.size());
  }
  ClientScript take() { return std::move(script_); }

 private:
  void put(Step step) { script_.one.steps.push_back(std::move(step)); }

  void act(const std::string& action) {
    Step step = step_of(Step::Kind::act);
    step.action = action;
    put(std::move(step));
    put(wait_of(answered_soon));
  }

  void fire(const Stimulus& stimulus) {
    Random random(stimulus.data);
    Values sources, on, off;
    for (const std::size_t at : stimulus.fired) {
      const json& block = blocks_[at];
      if (block["function"] == "write")
        for (const auto& [address, count] : own_memory(block))
          sources[address] = random_data(block, count, random);
      on[exchange::flag_of(block)] = "01";
      off[exchange::flag_of(block)] = "00";
    }
    if (!sources.empty()) put(set_of(sources));
    put(set_of(on));
    bool well = true;
    for (std::size_t i = 0; i < stimulus.fired.size(); ++i) {
      put(request_of(blocks_[stimulus.fired[i]], stimulus.faults[i], random));
      well &= stimulus.faults[i].empty();
    }
    put(wait_of(well ? answered_soon : given_up_));
    put(look());
    put(set_of(off));
    put(wait_of(answered_soon));
  }

  Step request_of(const json& block, const std::string& fault, Random& random) const {
    Step step = step_of(Step::Kind::expect);
    step.partner = PartnerSpec{"", json::object(), partner_memory(block, protocol_, random), fault};
    if (block.contains("station")) step.partner->config["station"] = block["station"];
    return step;
  }

  /// At the memory of all blocks, and at their results.
  Step look() const {
    Values places;
    for (const json& block : blocks_) {
      for (const auto& [address, count] : own_memory(block))
        places[address] = std::string(count, '0');
      const auto results = results_.find(number_of(block));
      if (results == results_.end()) continue;
      for (const auto& [address, count] : results->second)
        places.emplace(address, std::string(count, '0'));
    }
    Step step = step_of(Step::Kind::check);
    step.memory.assign(places.begin(), places.end());
    step.numbers.resize(step.memory.size());
    return step;
  }

  const std::vector<json>& blocks_;
  const harness::Protocol& protocol_;
  const std::map<BlockNumber, std::set<Watched>>& results_;
  const Duration given_up_;
  ClientScript script_;
};

}  // namespace

ClientScript client_script(const ClientSetUp& set_up, const std::vector<Stimulus>& stimuli,
                           const harness::Protocol& protocol,
                           const std::map<BlockNumber, std::set<Watched>>& results) {
  Writer writer(set_up, protocol, results);
  for (const Stimulus& stimulus : stimuli) writer.add(stimulus);
  return writer.take();
}

bool fill(Case& one, const exchange::Transcript& transcript, const std::set<std::size_t>& open,
          bool& unasked) {
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
      unasked = true;
      step = wait_of(answered_soon);
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

}  // namespace fieldproof::explore
