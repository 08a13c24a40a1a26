#include "harness/exchange/stimulus_hash.hpp"

#include <fmt/format.h>

#include "harness/vectors/fingerprint.hpp"

namespace fieldproof::exchange {

using vectors::Step;

namespace {

/// Nothing for a step on a line.
void add_link(const PreparedStep& step, std::string& text) {
  if (!step.link.empty()) text += fmt::format("@{} ", step.link);
  if (step.step->kind == Step::Kind::open)
    text += fmt::format("{} {} {} ", step.protocol->name(),
                        step.step->link.transport == Transport::udp ? "udp" : "tcp", step.port);
  if (step.step->kind == Step::Kind::close)
    text += fmt::format("{} ", static_cast<int>(step.step->closing));
}

/// In a text of no other use.
std::string stimulus_text(const PreparedCase& prepared) {
  const vectors::Case& source = *prepared.source;
  std::string text =
      fmt::format("{} {} {}\n", prepared.station, source.fresh, source.config.dump());
  const auto add_memory = [&](const std::vector<std::pair<std::string, std::string>>& memory) {
    for (const auto& [address, hex] : memory) text += fmt::format("{}={} ", address, hex);
  };
  add_memory(source.memory);
  for (const PreparedStep& step : prepared.steps) {
    text += fmt::format("\n{} x{} {} {} ", static_cast<int>(step.step->kind), step.step->times,
                        step.step->action, step.step->duration.count());
    if (step.step->kind == Step::Kind::set) add_memory(step.step->memory);
    if (step.step->kind == Step::Kind::check)
      for (const auto& [address, hex] : step.step->memory)
        text += fmt::format("{}:{} ", address, hex.size());
    if (const std::optional<vectors::PartnerSpec>& partner = step.step->partner) {
      text += fmt::format("{} {} {} ", partner->model, partner->config.dump(), partner->fault);
      add_memory(partner->memory);
    }
    add_link(step, text);
    if (step.step->kind != Step::Kind::send) continue;
    const notation::FrameTemplate& frame = step.frames.front().frame;
    text += notation::to_hex_with_holes(frame);
    for (const std::string& name : frame.names) text += " {" + name + "}";
    for (const notation::FrameTemplate::Gap& gap : frame.gaps)
      text +=
          fmt::format(" ~{}:{}{}", gap.before, gap.pause.amount, gap.pause.characters ? "c" : "");
  }
  return text;
}

}  // namespace

std::string stimulus_hash(const PreparedCase& prepared) {
  return fmt::format(
      "{:016x}", vectors::extend_fingerprint(vectors::empty_fingerprint, stimulus_text(prepared)));
}

}  // namespace fieldproof::exchange
