#include "harness/exchange/prepared_case.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstdlib>

#include "harness/exchange/p2p_blocks.hpp"

namespace fieldproof::exchange {

using vectors::Step;

namespace {

/// Values of a configuration may be numbers or text.
int number_of(const nlohmann::json& config, const char* key, int fallback) {
  const nlohmann::json value = config.value(key, nlohmann::json(fallback));
  if (value.is_string()) return std::atoi(value.get_ref<const std::string&>().c_str());
  return value.is_number() ? value.get<int>() : fallback;
}

}  // namespace

bool PreparedCase::is_client() const { return vectors::is_client_case(*source); }

bool PreparedCase::runs_by_clock() const {
  return is_client() &&
         std::ranges::any_of(p2p_blocks(source->config), fieldproof::exchange::runs_by_clock);
}

bool PreparedCase::answers_probes() const {
  return has_probe && !is_client() && !source->config.contains("bench_line");
}

Duration PreparedCase::client_time_out() const {
  return Duration((number_of(source->config, "time_out", 1) + 1) * 100ms);
}

Duration PreparedCase::reply_delay() const {
  return Duration(number_of(source->config, "delay_ms", 0) * 1ms);
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
           std::ranges::any_of(step.step->memory,
                               [](const auto& entry) { return entry.first.starts_with('@'); });
  });
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

Duration reply_limit(const Step& step, Duration response_max) {
  return step.within.value_or(response_max + step.every.value_or(Duration{}));
}

Result<PreparedCase> prepare(const vectors::Case& source, int station,
                             const harness::Protocol& protocol) {
  PreparedCase prepared{&source, station, !protocol.probe(station, {}).empty(), {}};
  const notation::Fields stations = protocol.fields_at(station);
  for (std::size_t i = 0; i < source.steps.size(); ++i) {
    PreparedStep step{&source.steps[i], {}};
    for (const vectors::Frame& frame : source.steps[i].frames) {
      Result<std::vector<notation::FrameTemplate>> templates =
          notation::make_templates(frame.notation, stations);
      if (!templates)
        return fail(fmt::format("{}: steps[{}]: {}", source.id, i, templates.error().message));
      for (notation::FrameTemplate& one : *templates)
        step.frames.push_back({frame.reading, &frame, std::move(one)});
    }
    prepared.steps.push_back(std::move(step));
  }
  return prepared;
}

}  // namespace fieldproof::exchange
