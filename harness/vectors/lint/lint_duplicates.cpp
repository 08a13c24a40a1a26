#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "harness/notation/frame_template.hpp"
#include "harness/vectors/lint/fields_of_steps.hpp"
#include "harness/vectors/lint/lint.hpp"

namespace fieldproof::vectors {

namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

std::string text_of(Pairs memory) {
  for (auto& [address, hex] : memory)
    if (std::optional<std::string> digits = expand_hex(hex)) hex = std::move(*digits);
  std::ranges::sort(memory);
  return fmt::format("{}", memory);
}

/// The bytes, what may stand where they are open, and the pauses.
std::string text_of(const notation::FrameTemplate& frame) {
  std::string text = notation::to_hex_with_holes(frame);
  for (const std::size_t i : frame.holes) {
    const notation::FrameTemplate::Cell& cell = frame.cells[i];
    using Kind = notation::FrameTemplate::Cell::Kind;
    if (cell.kind == Kind::capture || cell.kind == Kind::reuse)
      text += fmt::format(" {}:{}", i, frame.names[cell.part]);
    if (cell.kind == Kind::hex_digit) text += fmt::format(" {}:x", i);
  }
  for (const auto& [before, pause] : frame.gaps)
    text += fmt::format(" {}~{}{}", before, pause.amount, pause.characters ? "c" : "ms");
  return text;
}

std::string text_of(const PartnerSpec& partner) {
  return fmt::format("{} {} {} {}", partner.model, partner.config.dump(), text_of(partner.memory),
                     partner.fault);
}

long long ns(const std::optional<Duration>& duration) {
  return duration ? static_cast<long long>(duration->count()) : -1;
}

/// What the step does on the line and with the device; not what it rests on.
std::string text_of(const Step& step, const notation::Fields& fields) {
  std::string text = fmt::format(
      "{} {} {} {} {} {} {} {} x{} on {} {} {} {} {} {} {}", static_cast<int>(step.kind),
      step.reading, text_of(step.memory), step.action, step.duration.count(), ns(step.within),
      ns(step.every), ns(step.max_gap), step.times, step.on, step.link.protocol,
      static_cast<int>(step.link.transport), step.link.port, static_cast<int>(step.closing),
      step.ending ? static_cast<int>(*step.ending) : -1, step.may_stay);
  const auto add = [&](const std::vector<std::optional<Number>>& numbers) {
    for (const std::optional<Number>& number : numbers)
      if (number) text += " " + number->text();
  };
  add(step.numbers);
  for (const CheckedValues& one : step.alternatives) {
    text += fmt::format("\n {} {}", one.alternative, fmt::join(one.digits, " "));
    add(one.numbers);
  }
  if (step.partner) text += " partner " + text_of(*step.partner);
  for (const Frame& frame : step.frames) {
    const auto templates = notation::make_templates(frame.notation, fields);
    if (!templates) return text + frame.text;  // lint_wires says why
    for (const notation::FrameTemplate& one : *templates)
      text += fmt::format("\n {} {}", frame.alternative, text_of(one));
  }
  return text;
}

/// Two cases with the same text are the same exchange with the same device.
std::string text_of(const Case& one, const harness::Protocol& own,
                    const harness::Protocols& known) {
  nlohmann::json config = one.config;
  if (config_station(config, 1) == 1) config.erase("station");
  std::vector<std::string> models = one.models;
  std::ranges::sort(models);
  std::string text = fmt::format("{} {} {} {} {}", one.protocol, models, config.dump(),
                                 text_of(one.memory), one.fresh);
  FieldsOfSteps fields(one, own, known);
  for (const Step& step : one.steps) {
    const Result<notation::Fields> there = fields.next(step);
    text += "\n" + (there ? text_of(step, *there) : one.id);  // lint_links says why not
  }
  return text;
}

}  // namespace

std::vector<std::string> lint_duplicates(const VectorSet& set,
                                         const harness::Protocols& protocols) {
  std::vector<std::string> problems;
  std::map<std::string, const Case*> seen;
  for (const Case& one : set.cases) {
    const harness::Protocol* const protocol = protocols.find(one.protocol);
    if (!protocol || one.steps.empty()) continue;
    const auto [first, is_new] = seen.emplace(text_of(one, *protocol, protocols), &one);
    if (is_new) continue;
    problems.push_back(fmt::format(
        "{}: {}: repeats the exchange of {} ({}): same bytes, device, memory and line; keep one "
        "of them, and let it name the statements of both",
        one.file, one.id, first->second->id, first->second->file));
  }
  return problems;
}

}  // namespace fieldproof::vectors
