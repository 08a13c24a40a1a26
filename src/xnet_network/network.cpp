#include "src/xnet_network/network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "src/base/bytes.hpp"
#include "src/base/duration.hpp"
#include "src/xnet_network/check_text.hpp"
#include "src/xnet_network/port_results.hpp"

namespace fieldproof::xnet {

namespace {

using nlohmann::json;

// DECISIONS.md xnet/overtime, xnet/ethernet-time.
constexpr Duration overtime = 100ms, least_on_ethernet = 2ms;
constexpr Duration ethernet_word = 2us;  // 5000 words in 10 ms (3-3-1)
constexpr unsigned most_hops = 8;
constexpr Duration look_period = 1ms;  // how old its time may be when it is told something

constexpr unsigned result_register = 141, presence_relay = 1200, initial_on = 2;
constexpr unsigned times_of_ethernet = 194, failures_of_ethernet = 196, overtimes_of_ethernet = 198;

void count_up(Memory& memory, unsigned number) {
  const Component low = component_in("SD", number), high = component_in("SD", number + 1);
  const unsigned next = (memory.read(high) << 16 | memory.read(low)) + 1;
  memory.write(low, next & 0xFFFF);
  memory.write(high, next >> 16);
}

/// Is it an object of that PLC, all of it in one range (1-3, note 2)?
std::optional<Component> reach(const Memory& memory, unsigned type, std::uint32_t address,
                               std::uint32_t count) {
  const std::optional<Component> first = component_of(type, address, memory.series());
  return first && count <= memory.room_from(*first) ? first : std::nullopt;
}

/// Its port is free for it (2-1-2, notes 2 and 3), or configured for servos.
bool has_motion_bus(const StationConfig& plc) {
  if (!plc.model->motion) return false;
  const Port* const port = plc.port(motion_port(*plc.model));
  return !port || port->type == NetType::omms;
}

}  // namespace

XnetNetwork::XnetNetwork(std::vector<StationConfig> stations) {
  for (StationConfig& one : stations) {
    const Model& model = *one.model;
    plcs_.push_back(std::make_unique<Plc>(
        Plc{.config = std::move(one), .memory = Memory(model.series, model.d)}));
    Plc& plc = *plcs_.back();
    plc.run = plc.config.run;
    const Ethernet& own = plc.config.ethernet;
    const std::array<std::uint32_t, 3> shown{own.address, own.mask, own.gateway};
    for (std::uint32_t i = 0; own.address != 0 && i < shown.size(); ++i) {
      plc.memory.write(component_in("SD", 1905 + 2 * i), shown[i] >> 16);
      plc.memory.write(component_in("SD", 1906 + 2 * i), shown[i] & 0xFFFF);
    }
    if (has_motion_bus(plc.config))
      plc.motion = std::make_unique<MotionBus>(plc.memory, plc.config.servos, plc.config.slaves);
  }
  for (const auto& plc : plcs_) power(*plc, true);
}

Result<std::unique_ptr<XnetNetwork>> make_network(std::string_view model, const json& config) {
  json own = config;
  own["model"] = model;
  std::vector<StationConfig> stations;
  std::vector<json> all{std::move(own)};
  for (const json& other : config.value("stations", json::array())) all.push_back(other);
  for (const json& one : all) {
    const std::string name(1, static_cast<char>('A' + stations.size() % 26));
    const std::string round = stations.size() < 26 ? "" : fmt::format("{}", stations.size() / 26);
    Result<StationConfig> read = read_station(one, name + round);
    if (!read) return read.error();
    stations.push_back(std::move(*read));
  }
  if (const Status right = check_nets(stations); !right) return right.error();
  return std::make_unique<XnetNetwork>(std::move(stations));
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_xnet(std::string_view model, const json& config) {
  Result<std::unique_ptr<XnetNetwork>> made = make_network(model, config);
  if (!made) return made.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::move(*made));
}

XnetNetwork::Plc* XnetNetwork::named(std::string_view name) const {
  const auto found =
      std::ranges::find_if(plcs_, [&](const auto& plc) { return plc->config.name == name; });
  return found == plcs_.end() ? nullptr : found->get();
}

/// Takes "B:" and blanks behind it off the text.
XnetNetwork::Plc* XnetNetwork::addressed(std::string_view& text) const {
  const std::size_t colon = text.find(':');
  if (colon == text.npos) return plcs_.front().get();
  Plc* const plc = named(text.substr(0, colon));
  text.remove_prefix(colon + 1);
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  return plc;
}

XnetNetwork::Plc* XnetNetwork::station_on(std::uint16_t net, std::uint32_t station) const {
  for (const auto& plc : plcs_)
    for (const Port& port : plc->config.ports)
      if (port.net == net && port.station == station) return plc.get();
  return nullptr;
}

TokenBus& XnetNetwork::bus(const Port& port) {
  return buses_.try_emplace(port.net, port.cycle, port.baud).first->second;
}

std::optional<Time> XnetNetwork::wake_at() const {
  std::optional<Time> first;
  const auto consider = [&](Time at) { first = std::min(first.value_or(at), at); };
  if (!events_.empty()) consider(events_.begin()->first);
  for (const auto& [net, bus] : buses_)
    if (const std::optional<Time> at = bus.wake_at()) consider(std::min(*at, now_ + look_period));
  for (const auto& plc : plcs_)
    if (plc->motion && plc->powered) consider(plc->motion->wake_at());
  if (std::ranges::any_of(plcs_, [](const auto& plc) {
        return has_to_look(*plc) || (plc->in_first_scan && plc->powered);
      }))
    consider(now_);
  return first;
}

Bytes XnetNetwork::advance(Time now) {
  now_ = now;
  while (!events_.empty() && events_.begin()->first <= now) {
    const auto event = std::move(events_.begin()->second);
    const Time at = events_.begin()->first;
    events_.erase(events_.begin());
    event(at);
  }
  for (auto& [net, bus] : buses_) bus.advance(now);
  for (const auto& plc : plcs_)
    if (plc->motion && plc->powered) plc->motion->advance(now, plc->run);
  for (const auto& plc : plcs_) {
    if (has_to_look(*plc)) run_program(*plc);
    if (plc->in_first_scan && plc->powered) end_first_scan(*plc);
  }
  return {};
}

bool XnetNetwork::has_to_look(const Plc& plc) {
  return !plc.config.program.empty() && plc.looked != plc.memory.touched();
}

/// What became of its relays since it was last looked at.
void XnetNetwork::run_program(Plc& plc) {
  plc.looked = plc.memory.touched();
  plc.relays_on.resize(plc.config.program.size());
  for (std::size_t i = 0; i < plc.config.program.size(); ++i) {
    const Rung& rung = plc.config.program[i];
    const bool on = plc.run && plc.powered && plc.memory.read(rung.relay) != 0;
    const bool was = plc.relays_on[i];
    plc.relays_on[i] = on;
    const std::string what =
        plc.config.name + ": " + (rung.level ? "hold " : "") + rung.instruction;
    // An operand in a register may be wrong: then it does nothing.
    if (on && !was) [[maybe_unused]]
      const Status done = act(what);
    if (was && !on && rung.level) plc.held.clear();
  }
}

void XnetNetwork::later(Time at, std::function<void(Time)> what) {
  events_.emplace(at, std::move(what));
}

Status XnetNetwork::set(std::string_view address, std::string_view hex) {
  std::string_view own = address;
  Plc* const plc = addressed(own);
  if (!plc) return fail(fmt::format("cannot set {}: there is no such PLC", address));
  return plc->memory.set(own, hex);
}

Result<std::string> XnetNetwork::get(std::string_view address, std::size_t digits) const {
  std::string_view own = address;
  const Plc* const plc = addressed(own);
  if (!plc) return fail(fmt::format("cannot read {}: there is no such PLC", address));
  if (own.starts_with("@U0-") && plc->motion) {
    const std::optional<unsigned> count = plc->motion->count(own.substr(1));
    if (!count) return unknown_counter(address);
    return hex_number(*count, static_cast<int>(digits));
  }
  if (own != "@turns") return plc->memory.get(own, digits);
  std::string turns;
  for (const Port& port : plc->config.ports)
    if (const auto bus = buses_.find(port.net); bus != buses_.end())
      for (const TokenTurn& turn : bus->second.turns()) turns += hex_number(turn.station, 2);
  return turns.substr(turns.size() - std::min(turns.size(), digits));
}

Status XnetNetwork::act(std::string_view action) {
  std::string_view what = action;
  Plc* const plc = addressed(what);
  if (!plc) return fail(fmt::format("cannot do '{}': there is no such PLC", action));
  constexpr std::string_view hold = "hold ", slow_by = "slow ";
  const bool held = what.starts_with(hold);
  if (held && MotionBus::knows(what.substr(hold.size())))
    what.remove_prefix(hold.size());  // it acts at the edge
  if (MotionBus::knows(what)) {
    if (plc->motion) return plc->motion->act(what);
    if (plc->config.model->motion) return ok();  // its port is of another net: nothing moves
    return fail(fmt::format(
        "cannot do '{}': {} has no motion bus; XDC, XDE and XG1 have, where its port is "
        "not of another net",
        action, plc->config.model->name));
  }
  if (is_instruction(what)) return execute(*plc, what, false);
  if (held) return execute(*plc, what.substr(hold.size()), true);
  if (is_port_result(what)) return tell_port_result(what, *plc->config.model, plc->memory);
  if (what == "release" || what.starts_with("release "))
    plc->held.clear();
  else if (what == "run" || what == "stop")
    switch_to(*plc, what == "run");
  else if (what == "noise on" || what == "noise off")
    plc->noisy = what == "noise on";
  else if (what.starts_with(slow_by))
    return slow_down(*plc, what.substr(slow_by.size()));
  else if (what == "on" || what == "off")
    power(*plc, what == "on");
  else if (what == "power_cycle") {
    power(*plc, false);
    power(*plc, true);
  } else
    return unknown_action(action);
  return ok();
}

Status XnetNetwork::slow_down(Plc& plc, std::string_view by) {
  const Result<Duration> late = parse_duration(by);
  if (!late) return fail(fmt::format("cannot do 'slow {}': {}", by, late.error().message));
  plc.late = *late;
  return ok();
}

void XnetNetwork::switch_to(Plc& plc, bool run) {
  if (run && !plc.run) begin_scans(plc);
  plc.run = run;
}

/// SM2 is on in the first scan of RUN (2-2-2).
void XnetNetwork::begin_scans(Plc& plc) {
  plc.in_first_scan = true;
  plc.memory.write(component_in("SM", initial_on), 1);
  plc.memory.touch();
}

void XnetNetwork::end_first_scan(Plc& plc) {
  plc.in_first_scan = false;
  plc.memory.write(component_in("SM", initial_on), 0);
  plc.memory.touch();
}

Trace XnetNetwork::trace() const {
  Trace trace;
  for (const auto& plc : plcs_) {
    if (!plc->motion) continue;
    for (AxisTrace& one : plc->motion->trace(now_)) {
      if (plc != plcs_.front()) one.axis = plc->config.name + ":" + one.axis;
      trace.axes.push_back(std::move(one));
    }
  }
  for (const auto& [net, bus] : buses_)
    if (std::vector<TokenTurn> turns = bus.shown_turns(now_); !turns.empty())
      trace.nets.push_back({net, std::move(turns), bus.cycle()});
  return trace;
}

Status XnetNetwork::execute(Plc& plc, std::string_view text, bool held) {
  const Result<Instruction> read = read_instruction(text, plc.memory);
  if (!read) return read.error();
  if (held) plc.held.push_back(*read);
  start(plc, *read, held);
  return ok();
}

/// Where the route leads: the port whose register has the result.
void XnetNetwork::start(Plc& plc, const Instruction& instruction, bool held) {
  if (!plc.run || !plc.powered) return;
  const Route* const route = plc.config.route(instruction.net);
  Job job{&plc, instruction, 0, 0, held, plc.lives};
  if (route)
    job.port = route->port;
  else if (!plc.config.ports.empty())
    job.port = plc.config.ports.front().number;
  if (++plc.under_way > plc.config.model->instructions) return finish(job, Outcome::overtime, now_);
  const std::uint32_t most = instruction.bits ? bits_at_once : words_at_once;
  const std::uint32_t room = plc.memory.room_from(instruction.local);
  if (instruction.count == 0 || instruction.count > most || instruction.count > room)
    return finish(job, Outcome::memory, now_);
  forward(plc, job, now_);
}

void XnetNetwork::forward(Plc& via, Job job, Time now) {
  const Route* const route = via.config.route(job.instruction.net);
  const Port* const port = route ? via.config.port(route->port) : nullptr;
  if (!port || ++job.hops > most_hops) return fail_later(job, now);
  carry(via, *route, *port, job, now);
}

void XnetNetwork::carry(Plc& via, const Route& route, const Port& port, Job job, Time now) {
  const std::uint16_t net = port.net;
  const std::uint32_t station = route.gateway ? route.gateway : job.instruction.station;
  const bool last = route.gateway == 0;
  const auto there = [=, this](Time at) {
    if (job.is_lost()) return;
    Plc* const next = station_on(net, station);
    if (!next || !next->powered || (next == partner_ && !last)) return fail_later(job, at);
    if (next->noisy || job.from->noisy) return finish(job, Outcome::crc, at);
    if (next == partner_) return ask_partner(job, at);
    last ? finish(job, move(*next, job), at) : forward(*next, job, at);
  };
  const Plc* const other = station_on(net, station);
  const Duration late = via.late + (other ? other->late : 0ms);
  // A gateway that loses its power answers nobody.
  const auto lost = [=, this, own = job.from == &via] {
    if (!own) fail_later(job, now_);
  };
  if (port.type != NetType::ethernet)
    return bus(port).queue(port.station, {job.instruction.words(), there, lost, late}, now);
  // One after the other through the port; each instruction takes its 2 ms.
  via.ethernet_free = std::max(via.ethernet_free, now) + ethernet_word * job.instruction.words();
  later(std::max(via.ethernet_free, now + least_on_ethernet), there);
}

void XnetNetwork::fail_later(const Job& job, Time now) {
  later(now + overtime, [=, this](Time at) { finish(job, Outcome::overtime, at); });
}

/// Nothing is moved unless all of it can be.
Outcome XnetNetwork::move(Plc& target, const Job& job) {
  const Instruction& one = job.instruction;
  const std::optional<Component> there = reach(target.memory, one.type, one.address, one.count);
  if (!there || there->area->bits != one.bits) return Outcome::memory;
  target.memory.touch();
  job.from->memory.touch();
  for (std::uint32_t i = 0; i < one.count; ++i) {
    const Component far{there->area, there->number + i};
    const Component near{one.local.area, one.local.number + i};
    if (one.reads)
      job.from->memory.write(near, target.memory.read(far));
    else
      target.memory.write(far, job.from->memory.read(near));
  }
  return Outcome::done;
}

void XnetNetwork::finish(const Job& job, Outcome outcome, Time now) {
  if (job.is_lost()) return;
  Plc& plc = *job.from;
  --plc.under_way;
  if (job.port != ethernet_port)
    return plc.memory.write(component_in("SD", result_register + 10 * job.port),
                            static_cast<unsigned>(outcome));
  count_up(plc.memory, times_of_ethernet);
  if (outcome != Outcome::done) count_up(plc.memory, failures_of_ethernet);
  if (outcome == Outcome::overtime) count_up(plc.memory, overtimes_of_ethernet);
  // A condition that stays on executes it again and again (3-3-1).
  if (job.held)
    later(now + (outcome == Outcome::done ? 0ms : least_on_ethernet), [=, this](Time) {
      if (!job.is_lost() && !job.from->held.empty()) start(*job.from, job.instruction, true);
    });
}

void XnetNetwork::power(Plc& plc, bool on) {
  plc.powered = on;
  if (!on) ++plc.lives;
  plc.under_way = 0;
  plc.held.clear();
  plc.relays_on.clear();
  if (on && plc.run) begin_scans(plc);
  if (plc.motion && !on) plc.motion->restart();
  for (const Port& port : plc.config.ports) {
    if (port.type == NetType::ethernet) continue;
    if (on)
      bus(port).join(port.station);
    else
      for (const TokenBus::Transfer& one : bus(port).leave(port.station)) one.lost();
  }
  show_presence();
}

/// Presence of each station on the nets of a PLC (1-5-2).
void XnetNetwork::show_presence() {
  for (const auto& plc : plcs_)
    for (const Port& port : plc->config.ports)
      for (unsigned station = 1; port.type == NetType::tbn && station <= last_station; ++station)
        plc->memory.write(component_in("SM", presence_relay + 100 * port.number + station - 1),
                          plc->powered && bus(port).is_there(station));
}

}  // namespace fieldproof::xnet
