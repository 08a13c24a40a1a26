// A PLC on X-NET whose memory is in another process: objects by type and address, as values.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "src/base/nesting.hpp"

#include "src/xnet_network/network.hpp"

namespace fieldproof::xnet {

namespace {

using nlohmann::json;

constexpr Duration patience = 100ms;  // DECISIONS.md xnet/overtime

json shown(const Port& port) {
  return {{"port", port.number},           {"net", port.net},
          {"station", port.station},       {"baud", port.baud},
          {"cycle_ms", to_ms(port.cycle)}, {"max_station", port.max_station}};
}

std::string in_dots(std::uint32_t address) {
  return fmt::format("{}.{}.{}.{}", address >> 24, address >> 16 & 0xFF, address >> 8 & 0xFF,
                     address & 0xFF);
}

/// A whole number of a line, or nothing.
std::optional<std::uint64_t> number_in(const json& line, const char* key) {
  const auto found = line.find(key);
  if (found == line.end() || !found->is_number_unsigned()) return std::nullopt;
  return found->get<std::uint64_t>();
}

/// A list of a line, empty where there is none.
json values_in(const json& line) {
  const auto found = line.find("values");
  return found != line.end() && found->is_array() ? *found : json::array();
}

}  // namespace

std::string XnetNetwork::hello() const {
  const StationConfig& own = plcs_.front()->config;
  json told{{"model", own.model->name}, {"ports", json::array()}};
  for (const Port& port : own.ports)
    if (port.type == NetType::tbn) told["ports"].push_back(shown(port));
  if (own.ethernet.address != 0) told["ip"] = in_dots(own.ethernet.address);
  return json{{"hello", told}}.dump();
}

Status XnetNetwork::hear(std::string_view line) {
  const json told = json::parse(not_too_deep(line), nullptr, false);
  if (!told.is_object()) return fail("the other end of the bus tells no line of JSON");
  if (told.contains("hello")) return join(told["hello"]);
  if (told.contains("ask")) answer_partner(told);
  if (told.contains("answer")) take_answer(told);
  return ok();
}

Status XnetNetwork::join(const json& hello) {
  if (!hello.is_object()) return fail("the other end of the bus does not say who it is");
  Result<StationConfig> read = read_station(
      hello, std::string(1, static_cast<char>('A' + plcs_.size() - (partner_ ? 1 : 0))));
  if (!read) return read.error();
  std::vector<StationConfig> all;
  for (const auto& plc : plcs_)
    if (plc.get() != partner_) all.push_back(plc->config);
  all.push_back(*read);
  if (const Status right = check_nets(all); !right) return right;
  if (partner_) part();
  if (!partner_) {
    const Series series = read->model->series;
    plcs_.push_back(std::make_unique<Plc>(Plc{.config = {}, .memory = Memory(series)}));
    partner_ = plcs_.back().get();
  }
  partner_->config = std::move(*read);
  power(*partner_, true);
  return ok();
}

void XnetNetwork::part() {
  if (partner_ && partner_->powered) power(*partner_, false);
}

void XnetNetwork::ask_partner(const Job& job, Time now) {
  const Instruction& one = job.instruction;
  const std::uint64_t number = ++asked_so_far_;
  json line{{"ask", number},          {"reads", one.reads},     {"bits", one.bits},
            {"type", one.type},       {"address", one.address}, {"count", one.count},
            {"values", json::array()}};
  for (std::uint32_t i = 0; i < one.count && !one.reads; ++i)
    line["values"].push_back(job.from->memory.read({one.local.area, one.local.number + i}));
  to_partner_.push_back(line.dump());
  asked_[number] = job;
  later(now + patience, [=, this](Time at) {
    const auto waiting = asked_.extract(number);
    if (!waiting.empty()) finish(waiting.mapped(), Outcome::overtime, at);
  });
}

/// The partner's instruction, on the memory of the first PLC: through a PLC that holds its values.
void XnetNetwork::answer_partner(const json& asked) {
  const json values = values_in(asked);
  Instruction one;
  one.reads = asked.value("reads", json()) == json(true);
  one.bits = asked.value("bits", json()) == json(true);
  one.type = static_cast<unsigned>(number_in(asked, "type").value_or(0));
  one.address = static_cast<std::uint32_t>(number_in(asked, "address").value_or(~0u));
  one.count = static_cast<std::uint32_t>(number_in(asked, "count").value_or(0));
  one.local = component_in(one.bits ? "M" : "D", 0);
  Plc& own = *plcs_.front();
  if (!own.powered || !partner_ || one.count == 0 ||
      one.count > (one.bits ? bits_at_once : words_at_once))
    return;
  for (std::size_t i = 0; i < values.size() && i < one.count && !one.reads; ++i)
    if (values[i].is_number_unsigned())
      partner_->memory.write({one.local.area, static_cast<std::uint32_t>(i)},
                             values[i].get<unsigned>() & (one.bits ? 1 : 0xFFFF));
  const Outcome outcome = move(own, {.from = partner_, .instruction = one});
  json answer{{"answer", asked["ask"]}, {"outcome", outcome}, {"values", json::array()}};
  for (std::uint32_t i = 0; i < one.count && one.reads && outcome == Outcome::done; ++i)
    answer["values"].push_back(partner_->memory.read({one.local.area, i}));
  to_partner_.push_back(answer.dump());
}

void XnetNetwork::take_answer(const json& answer) {
  const auto waiting = asked_.extract(number_in(answer, "answer").value_or(0));
  if (waiting.empty() || waiting.mapped().is_lost()) return;
  const Job& job = waiting.mapped();
  const Instruction& one = job.instruction;
  const json values = values_in(answer);
  const std::uint64_t outcome = number_in(answer, "outcome").value_or(1);
  const bool whole = values.size() == (one.reads && outcome == 0 ? one.count : 0);
  if (!whole) return finish(job, Outcome::overtime, now_);
  for (std::uint32_t i = 0; i < values.size(); ++i)
    if (values[i].is_number_unsigned())
      job.from->memory.write({one.local.area, one.local.number + i},
                             values[i].get<unsigned>() & (one.bits ? 1 : 0xFFFF));
  job.from->memory.touch();
  finish(job, static_cast<Outcome>(std::min<std::uint64_t>(outcome, 3)), now_);
}

}  // namespace fieldproof::xnet
