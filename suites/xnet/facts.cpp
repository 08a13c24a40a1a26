#include "suites/xnet/facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "src/xnet_motion/axis_registers.hpp"
#include "src/xnet_motion/omms.hpp"
#include "src/xnet_network/network.hpp"

namespace fieldproof::xnet_suite {

namespace {

using namespace xnet;
using nlohmann::json;

/// Each key of `facts` but the first ones names what `row` has.
Status compare(const json& facts, const json& row) {
  for (const auto& [key, printed] : facts.items()) {
    const auto held = row.find(key);
    if (held == row.end())
      return fail(fmt::format("'{}' is no key of such a fact; there are {}", key, row.dump()));
    // Rows of `each` are text.
    const bool same = printed == *held || (printed.is_string() && !held->is_string() &&
                                           printed.get<std::string>() == held->dump());
    if (!same)
      return fail(fmt::format("{}: the manual prints {}, the table has {}", key, printed.dump(),
                              held->dump()));
  }
  return ok();
}

Result<Series> series_of(const json& facts) {
  const std::string name = facts.value("series", "");
  if (name == "xd3") return Series::xd3;
  if (name == "xd5") return Series::xd5;
  return fail(fmt::format("series '{}'; there are xd3 and xd5", name));
}

/// A number, or one in the text of a row.
double number_in(const json& object, const char* key, double otherwise) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  return found->is_string() ? std::stod(found->get<std::string>()) : found->get<double>();
}
unsigned count_in(const json& object, const char* key, unsigned otherwise) {
  return static_cast<unsigned>(number_in(object, key, otherwise));
}

/// A row of 1-3.
Status check_range(const json& facts) {
  const Result<Series> series = series_of(facts);
  if (!series) return series.error();
  const std::string first_name = facts.value("first", "");
  const std::optional<Component> first = find_component(first_name, *series);
  if (!first) return fail(fmt::format("{} has no object '{}'", facts["series"].dump(), first_name));
  for (const Range& range : ranges_of(*first->area, *series)) {
    if (range.first != first->number) continue;
    const std::uint32_t end = range.first + range.count - 1;
    return compare(facts, {{"series", facts["series"]},
                           {"first", first_name},
                           {"last", to_string({first->area, end})},
                           {"type", first->area->type},
                           {"quantity", range.count},
                           {"decimal", fmt::format("{}~{}", range.first, end)},
                           {"hex", fmt::format("{:X}~{:X}", range.first, end)}});
  }
  return fail(fmt::format("no range of the table begins with {}", first_name));
}

Status check_object(const json& facts) {
  const Result<Series> series = series_of(facts);
  if (!series) return series.error();
  const std::string name = facts["object"].get<std::string>();
  const std::optional<Component> found = find_component(name, *series);
  json row{{"series", facts["series"]}, {"object", name}, {"exists", found && found->area->type}};
  if (found) {
    row["type"] = found->area->type;
    row["address"] = found->number;
    row["coil"] = found->area->bits;
  }
  return compare(facts, row);
}

Status check_model(const json& facts) {
  const Model* const model = find_model(facts.value("model", ""));
  if (!model) return fail(fmt::format("no model {}", facts["model"].dump()));
  return compare(facts, {{"model", model->name},
                         {"instructions", model->instructions},
                         {"last", fmt::format("D{}", model->d - 1)},
                         {"series", model->series == Series::xd3 ? "xd3" : "xd5"},
                         {"ethernet", model->ethernet},
                         {"motion", model->motion}});
}

Status check_register(const json& facts) {
  const std::string name = facts["register"].get<std::string>();
  const auto found = std::ranges::find(axis_registers(), name, &Register::name);
  if (found == axis_registers().end()) return fail(fmt::format("no register '{}'", name));
  const unsigned axis = count_in(facts, "axis", 1);
  const std::uint32_t number = found->first + stride_of(found->area) * (axis - 1);
  const bool one = found->kind == Kind::coil || found->kind == Kind::word;
  const json initial =
      found->kind == Kind::floating || found->initial != static_cast<long long>(found->initial)
          ? json(found->initial)
          : json(static_cast<long long>(found->initial));
  return compare(facts, {{"register", name},
                         {"axis", axis},
                         {"address", fmt::format("{}{}", found->area, number)},
                         {"words", one                          ? 1
                                   : found->kind == Kind::qword ? 4
                                                                : 2},
                         {"float", found->kind == Kind::floating},
                         {"initial", initial}});
}

Status accepted_or_not(const json& facts, const Status& done) {
  // Rows of `each` are text.
  const auto given = facts.find("accepted");
  const bool wanted = given == facts.end() || *given == true || *given == "true";
  if (bool(done) == wanted) {
    const std::string says = facts.value("says", "");
    if (done || done.error().message.find(says) != std::string::npos) return ok();
    return fail(fmt::format("refused, but not with '{}': {}", says, done.error().message));
  }
  return wanted ? Status(fail("refused: " + done.error().message)) : Status(fail("accepted"));
}

Status configured(const json& config) {
  const auto made = make_xnet(config.value("model", "xd3"), [&] {
    json own = config;
    own.erase("model");
    return own;
  }());
  return made ? ok() : Status(made.error());
}

Status check_instruction(const json& facts) {
  const std::string text = facts["instruction"].get<std::string>();
  const Model* const model = find_model(facts.value("model", "xd3"));
  if (!model) return fail(fmt::format("no model {}", facts["model"].dump()));
  Result<std::unique_ptr<plc::EmulatedDevice>> made =
      make_xnet(model->name, {{"ports", {{{"port", 1}}}}});
  if (!made) return made.error();
  return accepted_or_not(facts, (*made)->act(text));
}

Status check_ip(const json& facts) {
  const std::string text = facts["ip"].get<std::string>();
  const std::optional<NetAndStation> read = from_ip(text);
  json row{{"ip", text}, {"exists", read.has_value()}};
  if (read) {
    row["net"] = read->net;
    row["station"] = read->station;
    row["net_hex"] = fmt::format("{:X}", read->net);
    row["station_hex"] = fmt::format("{:X}", read->station);
  }
  return compare(facts, row);
}

Status check_cable(const json& facts) {
  const std::optional<unsigned> reach = longest_cable(count_in(facts["cable"], "baud", 0));
  const bool fits = reach && count_in(facts["cable"], "metres", 0) <= *reach;
  if (fits == facts.value("accepted", true)) return ok();
  return fail(fmt::format("the table has {} m", reach.value_or(0)));
}

Status check_servo_fact(const json& facts) {
  const Result<Servo> servo = read_servo(facts["servo"]);
  if (!servo) return accepted_or_not(facts, servo.error());
  const unsigned axes = count_in(facts, "axes", 10);
  return accepted_or_not(facts, check_servo(*servo, axes, axes > 10 ? 6000 : 3000));
}

/// Does the moment, in us, agree with what the fact has under `key`?
Status check_moment(const json& facts, const char* key, Duration held) {
  const double us = to_ms(held) * 1000, printed = number_in(facts, key, 0);
  if (std::abs(us - printed) < 0.5) return ok();
  return fail(fmt::format("{}: the manual gives {}, it is {:.1f}", key, printed, us));
}

Status check_characters(const json& facts) {
  const SerialFormat format{count_in(facts, "baud", 0), count_in(facts, "bits", 0)};
  if (format.baud == 0) return fail("'characters' without a baud");
  return check_moment(facts, "us", format.time_of(count_in(facts, "characters", 0)));
}

Status check_sampling(const json& facts) {
  const Result<Servo> servo = read_servo(facts["sampling"]);
  if (!servo) return servo.error();
  const Result<Duration> time = sampling_time(*servo);
  return time ? check_moment(facts, "us", *time) : Status(time.error());
}

/// The slot of one axis, or whether they all fit.
Status check_slots(const json& facts) {
  const Result<Servo> servo = read_servo(facts["slots"]);
  if (!servo) return servo.error();
  const Result<std::vector<Slot>> slots = slots_of(*servo, count_in(facts, "frame", 0));
  if (facts.contains("accepted"))
    return accepted_or_not(facts, slots ? ok() : Status(slots.error()));
  if (!slots) return slots.error();
  const auto own = std::ranges::find(*slots, count_in(facts, "axis", 1), &Slot::axis);
  if (own == slots->end()) return fail("that axis has no slot");
  for (const auto& [key, held] :
       {std::pair{"from_us", own->from}, std::pair{"to_us", own->to},
        std::pair{"sends_from_us", own->sends_from}, std::pair{"sends_to_us", own->sends_to}})
    if (const Status right = check_moment(facts, key, held); !right) return right;
  return ok();
}

}  // namespace

Status check_fact(const json& facts) {
  struct Form {
    const char* key;
    Status (*check)(const json&);
  };
  constexpr std::array forms{
      Form{"first", check_range},
      Form{"object", check_object},
      Form{"register", check_register},
      Form{"configuration",
           [](const json& one) { return accepted_or_not(one, configured(one["configuration"])); }},
      Form{"instruction", check_instruction},
      Form{"ip", check_ip},
      Form{"cable", check_cable},
      Form{"servo", check_servo_fact},
      Form{"characters", check_characters},
      Form{"sampling", check_sampling},
      Form{"slots", check_slots},
      Form{"model", check_model}};
  for (const Form& form : forms)
    if (facts.contains(form.key)) return form.check(facts);
  return fail(
      "a fact of X-NET has one of first, object, register, configuration, instruction, ip, cable, "
      "servo, characters, sampling, slots, model");
}

}  // namespace fieldproof::xnet_suite
