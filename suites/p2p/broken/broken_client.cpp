#include "suites/p2p/broken/broken_client.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "src/p2p/registers.hpp"
#include "suites/p2p/broken/broken_driver.hpp"
#include "suites/p2p/broken/drivers.hpp"

namespace fieldproof::p2p_broken {

using p2p::P2pClient;
using p2p::P2pParameters;

namespace {

class BrokenClient : public plc::SerialDevice {
 public:
  using DriverFactory = std::function<std::unique_ptr<p2p::P2pDriver>(BrokenDriver::Asked asked)>;

  BrokenClient(const plc::PlcModel& model, const P2pParameters& parameters, bool run,
               P2pClient::Timing timing, const Behaviour& behaviour, const DriverFactory& driver);

  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  Status set(std::string_view address, std::string_view hex) override {
    const Status status = plc::set_by_name(memory_, address, hex);
    if (status) look_at_flags();
    return status;
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    if (address.starts_with('@'))
      return plc::get_counter(engines_.front()->counters(), address, digits);
    return plc::get_by_name(memory_, address, digits);
  }
  Status act(std::string_view action) override;

 private:
  struct Block {
    unsigned number = 0;
    p2p::P2pResultFlags flags{};
    Outcome outcome{};
    std::optional<plc::DeviceAddress> condition{};
    bool on = false, under_way = false, again = false;
    unsigned edges = 0;
  };

  void make_engines(const P2pParameters& parameters, const P2pClient::Timing& timing,
                    const DriverFactory& driver);
  void give_up();
  void update_mode();
  void look_at_flags();
  bool fires(Block& block, bool on);
  void fire(const Block& block);
  Outcome outcome(const Block& block) const;
  void show(const Block& block, const Outcome& outcome);
  void saved();

  plc::PlcMemory memory_;
  Behaviour behaviour_;
  bool run_, link_;
  std::vector<Block> blocks_;
  std::vector<std::unique_ptr<P2pClient>> engines_;  // one, unless all blocks are asked at once
  std::vector<Burst> late_;
};

BrokenClient::BrokenClient(const plc::PlcModel& model, const P2pParameters& parameters, bool run,
                           P2pClient::Timing timing, const Behaviour& behaviour,
                           const DriverFactory& driver)
    : memory_(model),
      behaviour_(behaviour),
      run_(run || behaviour.deaf_to == "stop"),
      link_(parameters.link || behaviour.deaf_to == "link off") {
  P2pParameters shown = parameters, worked_with = parameters;
  if (behaviour_.shows) behaviour_.shows(shown);
  p2p::write_p2p_registers(memory_, shown);
  if (behaviour_.works_with) behaviour_.works_with(worked_with);
  if (behaviour_.timing) behaviour_.timing(timing);
  make_engines(worked_with, timing, driver);
  update_mode();
}

void BrokenClient::make_engines(const P2pParameters& parameters, const P2pClient::Timing& timing,
                                const DriverFactory& driver) {
  const auto asked = [this](const p2p::P2pBlock& of) {
    Block& block = *std::ranges::find(blocks_, of.number, &Block::number);
    block.under_way = true;
    if (behaviour_.clears_results)
      show(block, {.services = block.outcome.services, .errors = block.outcome.errors});
  };
  const auto make = [&](const P2pParameters& of) {
    engines_.push_back(std::make_unique<P2pClient>(memory_, of, of.channel, driver(asked), timing,
                                                   [this] { saved(); }));
  };
  P2pParameters one = parameters;
  for (const p2p::P2pBlock& block : parameters.blocks) {
    blocks_.push_back(
        {.number = block.number,
         .flags = p2p::p2p_result_flags(memory_.model(), parameters.parameter, block.number),
         .condition = block.condition.flag});
    one.blocks = {block};
    if (behaviour_.all_at_once) make(one);
  }
  if (!behaviour_.all_at_once) make(parameters);
}

void BrokenClient::receive(const Burst& burst) {
  for (Block& block : blocks_) block.outcome = outcome(block);
  const bool asked = std::ranges::any_of(blocks_, &Block::under_way);
  if (behaviour_.keeps_late_replies && !asked) late_.push_back(burst);
  for (const auto& engine : engines_) engine->receive(burst);
}

std::optional<Time> BrokenClient::wake_at() const {
  std::optional<Time> first;
  for (const auto& engine : engines_) {
    const std::optional<Time> wake = engine->wake_at();
    if (wake && (!first || *wake < *first)) first = wake;
  }
  return first;
}

Bytes BrokenClient::advance(Time now) {
  for (Block& block : blocks_) block.outcome = outcome(block);
  Bytes bytes;
  for (const auto& engine : engines_) {
    const Bytes more = engine->advance(now);
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  if (bytes.empty()) return bytes;
  for (Burst& burst : std::exchange(late_, {})) {
    burst.start = now;
    for (const auto& engine : engines_) engine->receive(burst);
  }
  return bytes;
}

Status BrokenClient::act(std::string_view action) {
  if (action == behaviour_.deaf_to) return ok();
  if (action == "power_cycle") {
    for (const auto& engine : engines_) engine->power_cycle();
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

void BrokenClient::give_up() {
  for (const auto& engine : engines_) engine->set_active(false);
  std::ranges::for_each(blocks_, [](Block& block) { block.under_way = false; });
  for (const auto& engine : engines_) engine->set_active(run_ && link_);
}

void BrokenClient::update_mode() {
  if (!run_ || !link_) give_up();
  for (const auto& engine : engines_) engine->set_active(run_ && link_);
  if (behaviour_.trigger != Trigger::held_flag || !run_) return;
  for (const Block& block : blocks_)
    if (block.on) fire(block);
}

void BrokenClient::look_at_flags() {
  for (Block& block : blocks_) {
    if (!block.condition) continue;
    const bool on = memory_.read(*block.condition) != 0;
    if (on != std::exchange(block.on, on) && fires(block, on)) fire(block);
  }
}

/// The flag has changed.
bool BrokenClient::fires(Block& block, bool on) {
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
void BrokenClient::fire(const Block& block) {
  std::vector<std::pair<plc::DeviceAddress, std::uint64_t>> kept;
  for (const Block& other : blocks_) {
    if (!other.condition) continue;
    kept.emplace_back(*other.condition, memory_.read(*other.condition));
    memory_.write(*other.condition, 0);
  }
  const auto scan = [this] {
    for (const auto& engine : engines_) engine->scan();
  };
  scan();
  memory_.write(*block.condition, 1);
  scan();
  memory_.write(*block.condition, 0);
  scan();
  for (auto one = kept.rbegin(); one != kept.rend(); ++one) memory_.write(one->first, one->second);
}

Outcome BrokenClient::outcome(const Block& block) const {
  const auto read = [this](const plc::DeviceAddress& at) { return memory_.read(at); };
  return {.ndr = read(block.flags.ndr) != 0,
          .err = read(block.flags.err) != 0,
          .status = static_cast<std::uint16_t>(read(block.flags.status)),
          .services = static_cast<std::uint32_t>(read(block.flags.services)),
          .errors = static_cast<std::uint32_t>(read(block.flags.errors))};
}

void BrokenClient::show(const Block& block, const Outcome& outcome) {
  memory_.write(block.flags.ndr, outcome.ndr);
  memory_.write(block.flags.err, outcome.err);
  memory_.write(block.flags.status, outcome.status);
  memory_.write(block.flags.services, outcome.services);
  memory_.write(block.flags.errors, outcome.errors);
}

void BrokenClient::saved() {
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

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_client(const Behaviour& behaviour,
                                                                std::string_view protocol,
                                                                std::string_view model,
                                                                const nlohmann::json& config) {
  if (protocol == "udata") return make_broken_udata_port(behaviour, model, config);
  plc::PortConfig port;
  if (plc::find_plc_model(model)) port.model = model;
  unsigned time_out = 1;
  plc::ConfigReader reader(config, "the P2P client's configuration");
  plc::read_port_config(reader, port);
  reader.whole("time_out", 50, time_out);
  if (reader.error()) return *reader.error();
  const Result<const plc::PlcModel*> plc = plc::check_port_config(port);
  if (!plc) return plc.error();
  const Result<P2pParameters> parameters = p2p::parse_p2p_parameters(config.at("p2p"), **plc);
  if (!parameters) return parameters.error();
  const auto good = [&] { return make_driver(protocol, port, config, model, *parameters); };
  if (const auto first = good(); !first) return first.error();
  const P2pClient::Timing timing{100ms * (time_out + 1), port.reply_delay(),
                                 port.line.character_time()};
  return std::unique_ptr<plc::EmulatedDevice>(std::make_unique<BrokenClient>(
      **plc, *parameters, port.run, timing, behaviour, [&](BrokenDriver::Asked asked) {
        return std::make_unique<BrokenDriver>(std::move(*good()), behaviour, std::move(asked));
      }));
}

}  // namespace fieldproof::p2p_broken
