#include "suites/p2p/broken/broken_core.hpp"

#include <algorithm>
#include <set>

namespace fieldproof::p2p_broken {

using p2p::P2pClient;
using p2p::P2pParameters;

BrokenCore::BrokenCore(const plc::PlcModel& model, const P2pParameters& parameters, bool run,
                       const Behaviour& behaviour)
    : memory_(model),
      behaviour_(behaviour),
      parameters_(parameters),
      run_(run || behaviour.deaf_to == "stop"),
      link_(parameters.link || behaviour.deaf_to == "link off") {
  P2pParameters shown = parameters;
  if (behaviour_.shows) behaviour_.shows(shown);
  p2p::write_p2p_registers(memory_, shown);
  if (behaviour_.works_with) behaviour_.works_with(parameters_);
}

void BrokenCore::asked(const p2p::P2pBlock& of) {
  Block& block = *std::ranges::find(blocks_, of.number, &Block::number);
  block.under_way = true;
  if (behaviour_.clears_results)
    show(block, {.services = block.outcome.services, .errors = block.outcome.errors});
}

void BrokenCore::make_engines(P2pClient::Timing timing, const MakeDriver& driver,
                              const Place& place) {
  if (behaviour_.timing) behaviour_.timing(timing);
  const auto make = [&](const P2pParameters& of, unsigned channel) {
    auto engine = std::make_unique<P2pClient>(
        memory_, of, channel, driver([this](const p2p::P2pBlock& block) { asked(block); }, channel),
        timing, [this] { saved(); });
    engines_.push_back(engine.get());
    power_cycles_.push_back(place(std::move(engine), channel));
  };
  std::set<unsigned> channels;
  P2pParameters one = parameters_;
  for (const p2p::P2pBlock& block : parameters_.blocks) {
    blocks_.push_back(
        {.number = block.number,
         .flags = p2p::p2p_result_flags(memory_.model(), parameters_.parameter, block.number),
         .condition = block.condition.flag});
    channels.insert(block.channel);
    one.blocks = {block};
    if (behaviour_.all_at_once) make(one, block.channel);
  }
  // A line has one channel, a network all of them.
  if (!parameters_.network) channels = {parameters_.channel};
  if (!behaviour_.all_at_once)
    for (const unsigned channel : channels) make(parameters_, channel);
  update_mode();
}

void BrokenCore::remember() {
  for (Block& block : blocks_) block.outcome = outcome(block);
}

bool BrokenCore::is_busy() const { return std::ranges::any_of(blocks_, &Block::under_way); }

Status BrokenCore::set(std::string_view address, std::string_view hex) {
  const Status status = plc::set_by_name(memory_, address, hex);
  if (status) look_at_flags();
  return status;
}

Result<std::string> BrokenCore::get(std::string_view address, std::size_t digits) const {
  if (address.starts_with('@'))
    return plc::get_counter(engines_.front()->counters(), address, digits);
  return plc::get_by_name(memory_, address, digits);
}

Status BrokenCore::act(std::string_view action) {
  if (action == behaviour_.deaf_to) return ok();
  if (action == "power_cycle") {
    for (const auto& power_cycle : power_cycles_) power_cycle();
  } else if (action == "run" || action == "stop") {
    run_ = action == "run";
  } else if (action == "link on" || action == "link off") {
    link_ = action == "link on";
  } else {
    return fail("cannot do '" + std::string(action) + "': there is no such action");
  }
  update_mode();
  return ok();
}

void BrokenCore::give_up() {
  for (P2pClient* engine : engines_) engine->set_active(false);
  std::ranges::for_each(blocks_, [](Block& block) { block.under_way = false; });
  for (P2pClient* engine : engines_) engine->set_active(run_ && link_);
}

void BrokenCore::update_mode() {
  if (!run_ || !link_) give_up();
  for (P2pClient* engine : engines_) engine->set_active(run_ && link_);
  if (behaviour_.trigger != Trigger::held_flag || !run_) return;
  for (const Block& block : blocks_)
    if (block.on) fire(block);
}

void BrokenCore::look_at_flags() {
  for (Block& block : blocks_) {
    if (!block.condition) continue;
    const bool on = memory_.read(*block.condition) != 0;
    if (on != std::exchange(block.on, on) && fires(block, on)) fire(block);
  }
}

/// The flag has changed.
bool BrokenCore::fires(Block& block, bool on) {
  switch (behaviour_.trigger) {
    case Trigger::both_edges: return true;
    case Trigger::aborted_by_fall:
      if (!on && block.under_way) give_up();
      return on;
    case Trigger::falling_edge: return !on;
    case Trigger::every_second_edge: return on && ++block.edges % 2 == 1;
    case Trigger::queued_edges: block.again = block.again || (on && block.under_way); return on;
    default: return on;
  }
}

/// The engine sees a rising edge of this block's flag alone; the other flags it sees off.
void BrokenCore::fire(const Block& block) {
  std::vector<std::pair<plc::DeviceAddress, std::uint64_t>> kept;
  for (const Block& other : blocks_) {
    if (!other.condition) continue;
    kept.emplace_back(*other.condition, memory_.read(*other.condition));
    memory_.write(*other.condition, 0);
  }
  const auto scan = [this] {
    for (P2pClient* engine : engines_) engine->scan();
  };
  scan();
  memory_.write(*block.condition, 1);
  scan();
  memory_.write(*block.condition, 0);
  scan();
  for (auto one = kept.rbegin(); one != kept.rend(); ++one) memory_.write(one->first, one->second);
}

Outcome BrokenCore::outcome(const Block& block) const {
  const auto read = [this](const plc::DeviceAddress& at) { return memory_.read(at); };
  return {.ndr = read(block.flags.ndr) != 0,
          .err = read(block.flags.err) != 0,
          .status = static_cast<std::uint16_t>(read(block.flags.status)),
          .services = static_cast<std::uint32_t>(read(block.flags.services)),
          .errors = static_cast<std::uint32_t>(read(block.flags.errors))};
}

void BrokenCore::show(const Block& block, const Outcome& outcome) {
  memory_.write(block.flags.ndr, outcome.ndr);
  memory_.write(block.flags.err, outcome.err);
  memory_.write(block.flags.status, outcome.status);
  memory_.write(block.flags.services, outcome.services);
  memory_.write(block.flags.errors, outcome.errors);
}

void BrokenCore::saved() {
  for (Block& block : blocks_) {
    Outcome now = outcome(block);
    if (now.services == block.outcome.services && now.errors == block.outcome.errors) continue;
    bool again = behaviour_.ends && behaviour_.ends(block.outcome, now);
    show(block, now);
    block.outcome = now;
    block.under_way = false;
    again = again || (behaviour_.trigger == Trigger::level && block.on) ||
            std::exchange(block.again, false);
    if (again && block.condition) fire(block);
  }
  look_at_flags();
}

}  // namespace fieldproof::p2p_broken
