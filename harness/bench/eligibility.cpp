#include "harness/bench/eligibility.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/bench/device_set_up.hpp"
#include "harness/exchange/client_program.hpp"
#include "harness/exchange/p2p_blocks.hpp"
#include "harness/exchange/timing.hpp"
#include "harness/safety/placement.hpp"
#include "harness/safety/transposition.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::bench {

using endpoints::plain;
using exchange::PreparedCase;
using harness::Protocol;
using nlohmann::json;
using results::Verdict;
using vectors::Case;

namespace {

/// Programs are the bench's: no part of what a case is about.
json without_programs(json stations) {
  if (stations.is_array())
    for (json& one : stations)
      if (one.is_object()) one.erase("program");
  return stations;
}

/// It acts, or looks, closer to the time-out of a request than anybody says how exact that is.
/// Mails have others.
bool hits_the_time_out(const PreparedCase& prepared) {
  using Kind = vectors::Step::Kind;
  if (!prepared.is_client() || exchange::has_mail(prepared.source->config.value("p2p", json())))
    return false;
  const Duration time_out = prepared.client_time_out();
  Duration waited{};
  bool waits = false;  // the client, for an answer
  for (const exchange::PreparedStep& one : prepared.steps) {
    const vectors::Step& step = *one.step;
    if (step.kind == Kind::expect) waits = !step.partner, waited = {};
    if (step.kind == Kind::send || step.kind == Kind::partner) waits = false;
    if (step.kind != Kind::wait || !waits) continue;
    waited += step.duration;
    if (std::max(waited - time_out, time_out - waited) < exchange::near_the_time_out) return true;
  }
  return false;
}

}  // namespace

Result<PreparedCase> Eligibility::prepare(const Case& source) const {
  return exchange::prepare(source, station_for(source), protocol_, {options_.known, options_.aux});
}

int Eligibility::station_for(const Case& source) const {
  if (endpoint_.capabilities().real_device) return options_.station;
  return vectors::config_station(source.config, options_.station).value_or(options_.station);
}

json Eligibility::device_config(const Case& source) const {
  json config = source.config;
  config["station"] = station_for(source);
  if (!options_.profile.model.empty())
    config["model"] = options_.profile.model;
  else
    config["model"] = source.models.empty() ? protocol_.models().front() : source.models.front();
  return config;
}

/// The case says itself where the memory of a device lies, and this one has it there.
bool Eligibility::places_memory_itself(const Case& source) const {
  const json defaults = protocol_.defaults(options_.profile.model);
  bool any = false, all = true;
  for (const auto& [key, value] : defaults.items()) {
    any = any || source.config.contains(key);
    all = all && means_the_same(options_.profile, key, options_.profile.config.value(key, value),
                                source.config.value(key, value), protocol_);
  }
  return any && all;
}

Ruling Eligibility::outside_profile(const Case& source) const {
  const Profile& profile = options_.profile;
  if (std::ranges::find(profile.protocols, source.protocol) == profile.protocols.end())
    return {Verdict::skip,
            fmt::format("{} is no protocol of the profile {}", source.protocol, profile.name)};
  if (source.protocol != protocol_.name())
    return {Verdict::skip, fmt::format("{} is not what this endpoint speaks ({})", source.protocol,
                                       protocol_.name())};
  if (!profile.model.empty() && !source.models.empty() &&
      std::ranges::find(source.models, profile.model) == source.models.end())
    return {Verdict::skip, fmt::format("for {}; the profile declares {}",
                                       fmt::join(source.models, ", "), profile.model)};
  for (const auto& [pattern, reason] : profile.exclude)
    if (vectors::matches_filter(source.id, pattern))
      return {Verdict::skip, "excluded by the profile: " + reason};
  return {};
}

/// A case that does something to nets is about those that it names, and no others.
std::string Eligibility::not_of_the_case(const Case& source) const {
  const bool acts = std::ranges::any_of(
      source.steps, [](const auto& step) { return step.kind == vectors::Step::Kind::act; });
  if (source.on_model.empty() || !acts) return {};
  for (const auto& [key, value] : options_.profile.config.items())
    if (key != "station" && key != "program" && !default_config().contains(key) &&
        !source.config.contains(key))
      return fmt::format("is about a PLC without {}; the profile declares {}", key, plain(value));
  return {};
}

/// On hardware the configuration of a case must be what is declared.
std::string Eligibility::undeclared(const json& config) const {
  const bool asks = config.value("role", "server") == "client";
  for (const auto& [key, value] : config.items()) {
    if (key == "station" || key == "p2p" || (key == "role" && asks)) continue;  // Arming tells
    if (asks && arming_.tells(key)) continue;
    const bool of_wire = key == "line" || key == "bench_line";
    if (of_wire && !asks && !endpoint_.capabilities().wire) continue;  // below_floor tells
    json has = declared_value(options_.profile, key, protocol_);
    // Nothing is declared: then the device speaks as the port is open, or it would not answer.
    if (key == "line" && has.is_null() && !endpoint_.capabilities().line.empty())
      has = endpoint_.capabilities().line;
    if (!has.is_null() &&
        means_the_same(options_.profile, key, without_programs(has), value, protocol_))
      continue;
    if (key == "services")
      return fmt::format(
          "needs a second line to the same device, which the bench has not: services {}",
          plain(value));
    const bool refused = endpoint_.capabilities().control && !endpoint_.configures(key);
    return fmt::format("needs {} = {}; the profile declares {}{}", key, plain(value),
                       has.is_null() ? "nothing" : plain(has),
                       asks      ? arming_.not_told(key)
                       : refused ? ", and --control does not support it"
                                 : "");
  }
  return {};
}

/// All that a case writes, in its order: what is given, what its steps set, what sets its actions
/// off, and what these write.
std::vector<Protocol::Setting> Eligibility::settings_of(const PreparedCase& prepared) const {
  std::vector<Protocol::Setting> settings = prepared.source->memory;
  const auto add = [&](const std::vector<Protocol::Setting>& more) {
    settings.insert(settings.end(), more.begin(), more.end());
  };
  for (const exchange::PreparedStep& step : prepared.steps) {
    if (step.step->kind == vectors::Step::Kind::set) add(step.step->memory);
    if (step.step->kind != vectors::Step::Kind::act || prepared.is_client()) continue;
    if (const auto off = protocol_.set_off_by(step.step->action)) add(*off);
    add(protocol_.written_by_action(step.step->action));
  }
  return settings;
}

/// What the bench sends to a client are answers; what it sets goes over the second channel, as does
/// what it sets in a partner of the device. An error: it cannot be set.
Result<std::vector<Protocol::Written>> Eligibility::written_over_aux(
    const PreparedCase& prepared) const {
  std::vector<Protocol::Written> written;
  const exchange::Channel& aux = options_.aux;
  if (!aux.endpoint) return written;
  std::vector<Protocol::Setting> memory = settings_of(prepared);
  if (!prepared.is_client())
    std::erase_if(memory, [](const Protocol::Setting& one) {
      return exchange::place_name(one.first).partner.empty();
    });
  for (const nlohmann::json& block : exchange::p2p_blocks(prepared.source->config))
    if (!exchange::flag_of(block).empty() && !exchange::runs_by_clock(block))
      memory.emplace_back(exchange::flag_of(block), "00");
  for (const auto& [address, hex] : memory) {
    const Result<std::vector<Bytes>> requests =
        aux.protocol->write_requests(aux.station, exchange::place_name(address).address, hex);
    if (!requests)
      return fail(fmt::format("cannot set {} over --aux: {}", address, requests.error().message));
    for (const Bytes& request : *requests)
      std::ranges::move(aux.protocol->written_by(request), std::back_inserter(written));
  }
  return written;
}

std::vector<std::string> Eligibility::moved_axes(const PreparedCase& prepared) const {
  std::vector<std::string> axes;
  const auto add = [&](std::string axis) {
    if (!axis.empty() && std::ranges::count(axes, axis) == 0) axes.push_back(std::move(axis));
  };
  for (const exchange::PreparedStep& step : prepared.steps)
    if (step.step->kind == vectors::Step::Kind::act) add(protocol_.moves(step.step->action));
  for (const Protocol::Setting& one : settings_of(prepared))
    if (exchange::place_name(one.first).partner.empty()) add(axis_moved_by(one));
  return axes;
}

/// Of all that a setting covers: "1" of the device, "B:1" of its partner.
std::string Eligibility::axis_moved_by(const Protocol::Setting& setting) const {
  const exchange::PlaceName name = exchange::place_name(setting.first);
  const Protocol* const owner = name.partner.empty() ? &protocol_ : options_.aux.protocol;
  const auto covers = owner ? owner->named(name.address, setting.second.size()) : std::nullopt;
  if (!covers || covers->unknown()) return {};
  for (std::uint32_t word = covers->first_word; word <= covers->last_word; ++word)
    if (const std::string axis = owner->moved_by(owner->spell(covers->area, word)); !axis.empty())
      return name.partner.empty() ? axis : fmt::format("{}:{}", name.partner, axis);
  return {};
}

/// Nothing that moves is set in motion unless it is named.
std::string Eligibility::motion_objection(const PreparedCase& prepared) const {
  for (const exchange::PreparedStep& step : prepared.steps)
    if (step.step->kind == vectors::Step::Kind::act)
      if (std::string why = options_.fence.motion_objection(protocol_.moves(step.step->action),
                                                            step.step->action);
          !why.empty())
        return why;
  for (const Protocol::Setting& one : settings_of(prepared))
    if (std::string why = options_.fence.motion_objection(axis_moved_by(one), "sets " + one.first);
        !why.empty())
      return why;
  return {};
}

std::string Eligibility::only_read(const PreparedCase& prepared,
                                   const Protocol::Setting& given) const {
  const auto& [address, hex] = given;
  const endpoints::Capabilities& can = endpoint_.capabilities();
  if (can.back_door || can.control || prepared.is_client()) return {};
  if (!exchange::place_name(address).partner.empty()) return {};
  const Result<std::vector<Bytes>> requests =
      protocol_.write_requests(prepared.station, address, hex);
  if (requests || !protocol_.read_requests(prepared.station, address, hex.size())) return {};
  return requests.error().message;
}

std::string Eligibility::fence_objection(const PreparedCase& prepared) const {
  const Result<std::vector<Protocol::Written>> over_aux = written_over_aux(prepared);
  if (!over_aux) return over_aux.error().message;
  if (!over_aux->empty())
    if (std::string why = options_.fence.objection(*over_aux, *options_.aux.protocol); !why.empty())
      return why;
  if (prepared.is_client()) return {};
  if (std::string why = motion_objection(prepared); !why.empty()) return why;
  const std::vector<Protocol::Setting> settings = settings_of(prepared);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const auto& [address, hex] = settings[i];
    if (!exchange::place_name(address).partner.empty()) continue;
    const Result<std::vector<Bytes>> requests =
        protocol_.write_requests(prepared.station, address, hex);
    const bool is_given = i < prepared.source->memory.size();
    if (requests || (is_given && !only_read(prepared, settings[i]).empty())) continue;
    const auto named = protocol_.named(address, hex.size());
    if (!endpoint_.capabilities().control || !named)
      return fmt::format("cannot set {}: {}", address, requests.error().message);
    if (std::string why = options_.fence.objection({*named}, protocol_); !why.empty()) return why;
  }
  const std::vector<Protocol::Written> written = written_by(prepared);
  if (std::string why = options_.fence.objection(written, protocol_); !why.empty()) return why;
  return options_.fence.motion_objection(written, protocol_);
}

/// In the order of the case.
std::vector<Protocol::Written> Eligibility::written_by(const PreparedCase& prepared) const {
  if (prepared.is_client()) return *written_over_aux(prepared);  // the fence has let it pass
  std::vector<Protocol::Written> written;
  const auto add = [&](ByteView request, const Protocol& protocol) {
    std::ranges::move(protocol.written_by(request), std::back_inserter(written));
  };
  for (const auto& [address, hex] : settings_of(prepared))
    if (const Result<std::vector<Bytes>> requests =
            protocol_.write_requests(prepared.station, address, hex);
        requests)
      for (const Bytes& request : *requests) add(request, protocol_);
  for (const exchange::PreparedStep& step : prepared.steps)
    if (step.step->kind == vectors::Step::Kind::send)
      add(step.frames.front().frame.bytes, *step.protocol);
  return written;
}

/// Why the bench cannot do what the case does to the device or its partners, or look at it; empty:
/// it can.
std::string Eligibility::out_of_reach(const PreparedCase& prepared) const {
  for (const exchange::PreparedStep& step : prepared.steps) {
    if (step.step->kind == vectors::Step::Kind::act)
      if (const auto off = protocol_.set_off_by(step.step->action); !off)
        return off.error().message;
    if (step.step->kind != vectors::Step::Kind::check) continue;
    for (const auto& [address, hex] : step.step->memory)
      if (std::string why = unreadable(address, hex.size()); !why.empty()) return why;
  }
  for (const auto& [address, hex] : settings_of(prepared))
    if (const Status there = memory_.partner_of(address); !there) return there.error().message;
  return {};
}

std::string Eligibility::unreadable(const std::string& address, std::size_t digits) const {
  if (const Status there = memory_.partner_of(address); !there) return there.error().message;
  const exchange::PlaceName name = exchange::place_name(address);
  const Protocol& protocol = name.partner.empty() ? protocol_ : *options_.aux.protocol;
  const auto requests = protocol.read_requests(options_.station, name.address, digits);
  return requests || endpoint_.capabilities().control ? "" : requests.error().message;
}

/// A network device that is not reached by what the case opens: connections, or datagrams.
std::string Eligibility::not_carried(const PreparedCase& prepared) const {
  const endpoints::Capabilities& can = endpoint_.capabilities();
  if (!can.connections && !can.datagrams) return {};
  for (const exchange::PreparedStep& step : prepared.steps) {
    if (step.step->kind != vectors::Step::Kind::open || !step.network) continue;
    const bool udp = step.step->link.transport == Transport::udp;
    if (udp && !can.datagrams)
      return "needs datagrams; say where the device takes them: {udp_port} in the command of "
             "exec:, "
             "udp=PORT behind tcp:HOST:PORT";
    if (!udp && !can.connections)
      return "needs connections; name the endpoint tcp:HOST:PORT?udp=PORT";
  }
  return {};
}

Ruling Eligibility::blocked(const Case& source, const PreparedCase& prepared) const {
  const endpoints::Capabilities& can = endpoint_.capabilities();
  if (!can.real_device) return {};
  if (std::string why = not_carried(prepared); !why.empty()) return {Verdict::blocked, why};
  if (prepared.is_client()) {
    if (std::string why = arming_.undeclared(source, options_.profile.config); !why.empty())
      return {Verdict::skip, why};
    if (std::string why = arming_.objection(source, device_config(source)); !why.empty())
      return {arming_.declares() ? Verdict::skip : Verdict::blocked, why};
  } else if (!source.transpose &&
             vectors::config_station(source.config, options_.station) != options_.station)
    return {Verdict::blocked,
            fmt::format("is about station {}; the device is station {}",
                        *vectors::config_station(source.config, 1), options_.station)};
  if (!source.on_model.empty() && !prepared.is_client())
    for (std::string why : {not_of_the_case(source), out_of_reach(prepared)})
      if (!why.empty()) return {Verdict::blocked, why};
  if (std::string why = undeclared(source.config); !why.empty())
    return {prepared.is_client() && arming_.declares() ? Verdict::skip : Verdict::blocked, why};
  if (prepared.counts_from_power_on() && can.control && !can.renews)
    return {Verdict::blocked,
            "looks at the status counters as they are from power-on; the bench's own requests have "
            "moved them"};
  if (prepared.looks_at_counters() && !prepared.is_client() && !can.control)
    return {Verdict::blocked,
            "looks at the status counters, which no command reads; see XG5000, status by service"};
  if (prepared.looks_for_what_is_kept() && can.can_power_cycle && !can.control &&
      options_.power_cycle_command.empty())
    return {Verdict::blocked,
            "looks for what is kept without power; a program that is started again has forgotten "
            "it: --control can switch it off and on"};
  if (source.fresh && !can.can_power_cycle && !can.control && options_.power_cycle_command.empty())
    return {Verdict::blocked, "needs a device fresh from power-on; give --power-cycle COMMAND"};
  return {};
}

/// Those that no request here hits; none where each moment is kept.
Moments Eligibility::moments(const PreparedCase& prepared) const {
  if (endpoint_.capabilities().wire || prepared.source->on_model.empty()) return {};
  return moments_of(prepared, protocol_);
}

Ruling Eligibility::below_floor(const PreparedCase& prepared, const Moments& moments) const {
  const endpoints::Capabilities& can = endpoint_.capabilities();
  if (can.real_device && hits_the_time_out(prepared))
    return {Verdict::inconclusive,
            fmt::format("acts within {:.0f} ms of the client's time-out: how exactly that is kept, "
                        "no manual prints",
                        to_ms(exchange::near_the_time_out))};
  if (can.wire) return {};
  const json& config = prepared.source->config;
  if (config.contains("line") || config.contains("bench_line"))
    return {Verdict::inconclusive,
            "is about speed and character format, which a pty or socket does not carry"};
  if (const std::string& kind = prepared.source->on_model; !kind.empty()) {
    if (kind == "timing" || moments.alone)
      return {Verdict::inconclusive,
              "looks at what is so for milliseconds, which no request that is sent here hits"};
    if (moments.acted_in)
      return {Verdict::inconclusive,
              "does something to what is so for milliseconds, which no request that is sent here "
              "hits"};
    return {};  // waiting longer does no harm
  }
  // On a network a pause may be longer than it is written: it only sees that a segment has come.
  if (protocol_.on_network()) return {};
  const Duration pause = prepared.shortest_pause(endpoint_.character_time());
  if (pause > 0ns && pause < shortest_judged)
    return {
        Verdict::inconclusive,
        fmt::format(
            "needs a time of {:.1f} ms; below {:.0f} ms nothing is certain behind a pty or socket",
            to_ms(pause), to_ms(shortest_judged))};
  return {};
}

/// Whatever can be settled before a byte is sent.
ReadyCase Eligibility::ready(const Case& source) const {
  ReadyCase ready;
  const auto declined = [&](Ruling why) {
    ready.why = std::move(why);
    return std::move(ready);
  };
  if (const Ruling outside = outside_profile(source); !outside.may_run()) return declined(outside);
  Result<PreparedCase> prepared = prepare(source);
  if (!prepared) return declined({Verdict::error, prepared.error().message});
  if (const Ruling why = blocked(source, *prepared); !why.may_run()) return declined(why);
  // Memory is asked for where a real device declares it to lie, and written only where it is
  // allowed.
  const bool real = endpoint_.capabilities().real_device;
  if (real && !prepared->is_client()) {
    Result<std::optional<Case>> placed = std::optional<Case>();
    if (!places_memory_itself(source)) placed = safety::placed_case(*prepared, protocol_);
    if (!placed) return declined({Verdict::blocked, placed.error().message});
    if (*placed) ready.elsewhere = std::make_unique<Case>(std::move(**placed));
    const Case& here = ready.elsewhere ? *ready.elsewhere : source;
    const Result<std::vector<results::Move>> planned =
        safety::plan_moves(here, station_for(source), options_.fence, protocol_);
    if (!planned) return declined({Verdict::blocked, planned.error().message});
    ready.moves = *planned;
    if (!ready.moves.empty()) {
      Result<Case> moved = safety::moved_case(here, station_for(source), ready.moves, protocol_);
      if (!moved) return declined({Verdict::blocked, moved.error().message});
      ready.elsewhere = std::make_unique<Case>(std::move(*moved));
    }
  }
  if (ready.elsewhere) {
    prepared = prepare(*ready.elsewhere);
    if (!prepared) return declined({Verdict::error, prepared.error().message});
  }
  if (std::string why = real ? fence_objection(*prepared) : ""; !why.empty())
    return declined({Verdict::blocked, why});
  const Moments passing = moments(*prepared);
  if (const Ruling why = below_floor(*prepared, passing); !why.may_run()) return declined(why);
  for (const std::size_t step : passing.steps) prepared->steps[step].passed_over = true;
  ready.prepared = std::move(*prepared);
  return ready;
}

Ruling Eligibility::unmoved(const Case& source) const {
  if (Ruling outside = outside_profile(source); !outside.may_run()) return outside;
  const Result<PreparedCase> prepared = prepare(source);
  if (!prepared) return {Verdict::error, prepared.error().message};
  if (Ruling why = blocked(source, *prepared); !why.may_run()) return why;
  return below_floor(*prepared, moments(*prepared));
}

}  // namespace fieldproof::bench
