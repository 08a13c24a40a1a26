#include "harness/exchange/prepared_case.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstdlib>
#include <map>

#include "harness/exchange/client_program.hpp"
#include "harness/exchange/p2p_blocks.hpp"
#include "harness/exchange/stimulus_hash.hpp"
#include "harness/vectors/link_names.hpp"

namespace fieldproof::exchange {

using vectors::Step;

namespace {

bool is_counter(const std::pair<std::string, std::string>& entry) {
  return entry.first.starts_with('@');
}

}  // namespace

int number_of(const nlohmann::json& config, const char* key, int fallback) {
  const nlohmann::json value = config.value(key, nlohmann::json(fallback));
  if (value.is_string()) return std::atoi(value.get_ref<const std::string&>().c_str());
  return value.is_number() ? value.get<int>() : fallback;
}

bool PreparedCase::is_client() const { return vectors::is_client_case(*source); }

bool PreparedCase::runs_by_clock() const {
  return is_client() &&
         std::ranges::any_of(p2p_blocks(source->config), fieldproof::exchange::runs_by_clock);
}

bool PreparedCase::answers_probes() const {
  return has_probe && !is_client() && !source->config.contains("bench_line") && !is_shut_out();
}

bool PreparedCase::is_shut_out() const {
  return source->config.contains("host_table") && !is_client() &&
         std::ranges::none_of(
             steps, [](const PreparedStep& step) { return step.step->kind == Step::Kind::expect; });
}

Duration PreparedCase::client_time_out() const {
  const bool network =
      std::ranges::any_of(steps, [](const PreparedStep& step) { return step.network; });
  return exchange::client_time_out(source->config, !network);
}

Duration PreparedCase::client_settles() const {
  return exchange::client_time_out(source->config, true);
}

bool PreparedCase::expects_requests() const {
  return is_client() && std::ranges::any_of(steps, [](const PreparedStep& step) {
           return step.step->kind == Step::Kind::expect || step.step->kind == Step::Kind::partner;
         });
}

bool PreparedCase::listens_for_silence() const {
  return std::ranges::any_of(
      steps, [](const PreparedStep& step) { return step.step->kind == Step::Kind::silence; });
}

bool PreparedCase::looks_at_counters() const {
  return std::ranges::any_of(steps, [](const PreparedStep& step) {
    return step.step->kind == Step::Kind::check &&
           std::ranges::any_of(step.step->memory, is_counter);
  });
}

bool PreparedCase::counts_from_power_on() const {
  if (is_client()) return false;
  bool sent = false, disturbed = false;
  for (const PreparedStep& one : steps) {
    const Step& step = *one.step;
    const bool counter =
        step.kind == Step::Kind::check && std::ranges::all_of(step.memory, is_counter);
    if (counter && (!sent || disturbed)) return true;
    sent = sent || step.kind == Step::Kind::send;
    disturbed = disturbed || step.kind == Step::Kind::set || step.kind == Step::Kind::act ||
                (step.kind == Step::Kind::check && !counter);
  }
  return false;
}

bool PreparedCase::looks_for_what_is_kept() const {
  const auto is_zero = [](const auto& place) {
    return is_counter(place) || place.second.find_first_not_of('0') == std::string::npos;
  };
  bool again = false;  // it was off, and nothing has been done to it since
  for (const PreparedStep& one : steps) {
    const Step& step = *one.step;
    if (again && step.kind == Step::Kind::check && !std::ranges::all_of(step.memory, is_zero))
      return true;
    if (step.kind == Step::Kind::wait || step.kind == Step::Kind::check) continue;
    again = step.kind == Step::Kind::act && step.action == "power_cycle";
  }
  return false;
}

Duration PreparedCase::shortest_pause(Duration character_time) const {
  Duration shortest{};
  const auto consider = [&](Duration pause) {
    if (pause > 0ns && (shortest == 0ns || pause < shortest)) shortest = pause;
  };
  for (const PreparedStep& step : steps) {
    if (step.step->kind == Step::Kind::wait) consider(step.step->duration);
    if (step.step->kind != Step::Kind::send) continue;
    for (const notation::FrameTemplate::Gap& gap : step.frames.front().frame.gaps)
      consider(gap.pause.at(character_time));
  }
  return shortest;
}

Duration PreparedCase::reply_limit(const Step& step, Duration response_max) const {
  if (step.within) return *step.within;
  const bool delayed = reply_delay > 0ns && !is_client();
  return response_max + (delayed ? reply_delay : 0ns) + step.every.value_or(0ns);
}

namespace {

/// What is spoken on each link of a case.
class Spoken {
 public:
  Spoken(const vectors::Case& source, int station, const harness::Protocol& protocol,
         const OtherWays& others)
      : source_(source), others_(others), own_{nullptr, &protocol, station} {
    by_link_[std::string(vectors::aux_link)] = others.aux ? others.aux : own_;
  }

  Status open(const Step& step) {
    const std::string& name = step.link.protocol;
    Channel to = own_;
    if (!name.empty() && name != own_.protocol->name()) {
      to.protocol = others_.known.find(name);
      if (!to.protocol) return fail(fmt::format("there is no protocol '{}'", name));
      const nlohmann::json none = nlohmann::json::object();
      const nlohmann::json services = source_.config.value("services", none);
      to.station = number_of(services.value(name, none), "station", own_.station);
    }
    by_link_[step.on] = to;
    return ok();
  }
  const Channel& on(const std::string& link) const {
    const auto found = by_link_.find(link);
    return found == by_link_.end() ? own_ : found->second;
  }

 private:
  const vectors::Case& source_;
  const OtherWays& others_;
  Channel own_;
  std::map<std::string, Channel> by_link_;
};

Status add_frames(PreparedStep& step) {
  const notation::Fields stations = step.protocol->fields_at(step.station);
  for (const vectors::Frame& frame : step.step->frames) {
    Result<std::vector<notation::FrameTemplate>> templates =
        notation::make_templates(frame.notation, stations);
    if (!templates) return templates.error();
    for (notation::FrameTemplate& one : *templates)
      step.frames.push_back({frame.alternative, &frame, std::move(one)});
  }
  return ok();
}

Result<PreparedStep> prepare_step(const Step& source, vectors::LinkNames& links, Spoken& spoken) {
  const Result<std::string> link = links.next(source);
  if (!link) return link.error();
  if (source.kind == Step::Kind::open || source.kind == Step::Kind::expect_open)
    if (const Status opened = spoken.open(source); !opened) return opened.error();
  const Channel& to = spoken.on(*link);
  PreparedStep step{&source, {}, *link, to.protocol, to.station};
  step.network = to.protocol->on_network() && *link != vectors::aux_link;
  step.port =
      source.link.port != 0 ? source.link.port : to.protocol->port_for(source.link.transport);
  if (const Status added = add_frames(step); !added) return added.error();
  return step;
}

Duration reply_delay_of(const nlohmann::json& config) {
  const nlohmann::json rs485 = config.value("rs485", nlohmann::json());
  return rs485 == true || rs485 == "true" ? number_of(config, "delay_ms", 0) * 1ms : 0ns;
}

}  // namespace

Result<PreparedCase> prepare(const vectors::Case& source, int station,
                             const harness::Protocol& protocol, const OtherWays& others) {
  const bool has_probe = !protocol.probe(station, {}).empty();
  PreparedCase prepared{&source, station, has_probe, false, reply_delay_of(source.config), {}, {}};
  vectors::LinkNames links(source, protocol.on_network(), [&](const std::string& name) {
    const harness::Protocol* const other = others.known.find(name);
    return other && !other->on_network();
  });
  prepared.implicit_link = links.implicit();
  Spoken spoken(source, station, protocol, others);
  for (std::size_t i = 0; i < source.steps.size(); ++i) {
    Result<PreparedStep> step = prepare_step(source.steps[i], links, spoken);
    if (!step) return fail(fmt::format("{}: steps[{}]: {}", source.id, i, step.error().message));
    prepared.steps.push_back(std::move(*step));
  }
  prepared.stimulus = stimulus_hash(prepared);
  return prepared;
}

}  // namespace fieldproof::exchange
