#include "src/xnet_motion/motion_bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "src/xnet/words.hpp"

namespace fieldproof::xnet {

namespace {

constexpr std::uint32_t refresh_register = 2990, slaves_register = 2991, retries_register = 2992;

using Name = MotionInstruction;
struct Form {
  std::string_view name;
  Name what;
  unsigned operands;    // before the axis
  bool registers_only;  // no constant
};
constexpr std::array forms{
    Form{"MOTO", Name::moto, 3, false},     Form{"MOTOA", Name::motoa, 3, false},
    Form{"MOTOS", Name::motos, 2, true},    Form{"MOSTOP", Name::mostop, 1, false},
    Form{"MOGOON", Name::mogoon, 0, false}, Form{"MOSYN", Name::mosyn, 1, false},
    Form{"MOUSYN", Name::mousyn, 0, false}, Form{"MOWRITE", Name::mowrite, 1, true},
    Form{"MOREAD", Name::moread, 1, true}};

const Form* find_form(std::string_view name) {
  const auto found = std::ranges::find(forms, name, &Form::name);
  return found == forms.end() ? nullptr : &*found;
}

/// Operands of the motion bus are D and HD, and constants (the tables of 2-2).
std::optional<Component> read_register(std::string_view word, const Memory& memory) {
  const std::optional<Component> found = memory.find(word);
  const bool suits = found && (found->area->name == "D" || found->area->name == "HD");
  return suits && memory.room_from(*found) >= 2 ? found : std::nullopt;  // a double word
}

std::optional<double> read_float(std::string_view word) {
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (!word.empty() && error == std::errc() && stop == end)
    return std::isfinite(value) ? std::optional(value) : std::nullopt;  // "nan", "inf"
  const std::optional<std::int32_t> whole = constant<std::int32_t>(word);
  return whole ? std::optional<double>(*whole) : std::nullopt;
}

Error wrong(std::string_view text, const std::string& what) {
  return fail(fmt::format("cannot execute '{}': {}", text, what));
}

}  // namespace

struct MotionBus::Order {
  MotionInstruction what{};
  std::array<std::string_view, 3> operands{};
  int master = 1;
  unsigned axis = 1;
  std::string_view text;  // but for its own axis
};

MotionBus::MotionBus(Memory& memory, std::vector<Servo> servos, unsigned slaves)
    : memory_(memory), settings_(memory.body(area_named("SFD"))) {
  memory_.write(component_in("SFD", refresh_register), slaves > 10 ? 6000 : 3000);
  memory_.write(component_in("SFD", slaves_register), slaves);
  memory_.write(component_in("SFD", retries_register), 20);
  for (unsigned number = 1; number <= last_axis; ++number) {
    const auto own = std::ranges::find(servos, number, &Servo::axis);
    Servo none;
    none.axis = number;
    none.connected = false;
    axes_.push_back(std::make_unique<Axis>(memory_, own == servos.end() ? none : *own));
  }
}

Axis* MotionBus::find(unsigned number) const {
  const auto found =
      std::ranges::find_if(axes_, [&](const auto& axis) { return axis->number() == number; });
  return found == axes_.end() ? nullptr : found->get();
}

void MotionBus::advance(Time now, bool run) {
  if (!begun_) {
    begun_ = true;
    next_ = now;
  }
  while (next_ <= now) {
    const auto us = std::max<unsigned>(settings_[refresh_register], 1000);
    const Duration period = us * 1us;
    const unsigned slaves = settings_[slaves_register];
    const bool look = memory_.touched() != touched_ || ran_ != run;
    touched_ = memory_.touched();
    ran_ = run;
    for (const auto& axis : axes_)
      if (!axis->is_bound() && (look || !axis->is_quiet()))
        axis->refresh(next_, period, run, slaves);
    follow(next_, period);
    for (const auto& axis : axes_)
      if (axis->is_bound()) axis->refresh(next_, period, run, slaves);
    if (std::ranges::any_of(axes_, [](const auto& axis) { return axis->was_cut(); }))
      downloads_ = true;
    next_ += period;
  }
}

double MotionBus::place_of(int master) const {
  if (master < 0)
    return read_number(memory_, component_in("HSCD", static_cast<std::uint32_t>(-master - 1) * 2),
                       Kind::dword);
  const Axis* const axis = find(static_cast<unsigned>(master));
  return axis ? axis->place() : 0;
}

void MotionBus::follow(Time now, Duration period) {
  std::erase_if(bindings_, [&](const Binding& one) { return !find(one.slave)->is_bound(); });
  for (Binding& one : bindings_) {
    const double place = place_of(one.master), way = place - one.seen;
    one.seen = place;
    const double seconds = std::chrono::duration<double>(period).count();
    const double speed =
        one.master < 0 ? way / seconds : find(static_cast<unsigned>(one.master))->speed();
    find(one.slave)->follow(way, speed, now);
  }
}

// ---- instructions ----

bool MotionBus::knows(std::string_view action) {
  const std::string_view name = action.substr(0, action.find(' '));
  return name == "servo" || find_form(name) != nullptr;
}

Result<MotionBus::Order> MotionBus::read(std::string_view action, const Memory& memory) {
  Words words(action);
  const Form* const form = find_form(words.next());
  if (!form) return wrong(action, "it is no instruction of the motion bus");
  Order order;
  order.what = form->what;
  order.text = action.substr(0, action.rfind(" axis "));
  for (unsigned i = 0; i < form->operands; ++i) {
    const std::string_view word = order.operands[i] = words.next();
    const bool is_number = form->what == Name::mosyn ? read_float(word).has_value()
                                                     : constant<std::int32_t>(word).has_value();
    if (read_register(word, memory) || (is_number && !form->registers_only)) continue;
    return wrong(action, fmt::format("'{}' is no {}", word,
                                     form->registers_only ? "register D or HD"
                                                          : "number, nor a register D or HD"));
  }
  if (form->what == Name::mosyn) {
    if (const std::string_view word = words.next(); word != "master")
      return wrong(action, fmt::format("'{}' where 'master' belongs", word));
    const std::string_view word = words.next();
    const std::optional<std::int32_t> master = constant<std::int32_t>(word);
    if (!master) return wrong(action, fmt::format("the master '{}' is no number", word));
    order.master = *master;
  }
  const std::string_view keyword = form->what == Name::mosyn ? "slave" : "axis";
  if (const std::string_view word = words.next(); word != keyword)
    return wrong(action, fmt::format("'{}' where '{}' belongs", word, keyword));
  const std::string_view word = words.next();
  const std::optional<std::uint32_t> axis = plain_number(word);
  if (!axis || *axis < 1 || *axis > last_axis)
    return wrong(action, fmt::format("the axis '{}'; axes are 1 to {}", word, last_axis));
  order.axis = *axis;
  if (!words.next().empty()) return wrong(action, "there is something behind its end");
  return order;
}

Status MotionBus::act(std::string_view action) {
  memory_.touch();
  if (action.starts_with("servo ")) return act_on_servo(action);
  const Result<Order> order = read(action, memory_);
  if (!order) return order.error();
  if (!downloads_) execute(*order, next_);
  return ok();
}

double MotionBus::operand(std::string_view word, bool floating) const {
  if (const std::optional<Component> found = read_register(word, memory_))
    return read_number(memory_, *found, floating ? Kind::floating : Kind::dword);
  return *read_float(word);
}

void MotionBus::execute(const Order& order, Time now) {
  Axis& axis = *find(order.axis);
  if (order.what != Name::moread) axis.note(now, std::string(order.text));
  const auto number = [&](std::size_t i) { return operand(order.operands[i], false); };
  switch (order.what) {
    case Name::moto: return axis.move(true, number(0), number(1), number(2), now);
    case Name::motoa: return axis.move(false, number(0), number(1), number(2), now);
    case Name::motos: return move_segments(order, axis, now);
    case Name::mostop: return axis.stop(number(0), now);
    case Name::mogoon: return axis.go_on(now);
    case Name::mosyn: return bind(order);
    case Name::mousyn: return axis.release();
    case Name::mowrite: return axis.write_position(number(0));
    case Name::moread:
      return write_number(memory_, *read_register(order.operands[0], memory_), Kind::dword,
                          axis.position());
  }
}

/// The tables of 2-2-3: data from S0 on, ten registers a segment; parameters from S1 on.
void MotionBus::move_segments(const Order& order, Axis& axis, Time now) {
  const Component data = *read_register(order.operands[0], memory_);
  const Component parameters = *read_register(order.operands[1], memory_);
  constexpr std::uint32_t of_a_segment = 10, last_of_a_segment = 4, parameter_registers = 8;
  const auto room = [&](const Component& from) { return memory_.room_from(from); };
  const auto at = [&](const Component& from, std::uint32_t offset) {
    return read_number(memory_, {from.area, from.number + offset}, Kind::dword);
  };
  if (room(parameters) < parameter_registers) return axis.fail(AxisError::segments);
  const double count = at(parameters, 2);
  if (count < 1 || count > 100 || (count - 1) * of_a_segment + last_of_a_segment > room(data))
    return axis.fail(AxisError::segments);
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i)
    segments.push_back({at(data, of_a_segment * i), at(data, of_a_segment * i + 2)});
  axis.move_segments(at(parameters, 0) == 0, std::move(segments), at(parameters, 4),
                     at(parameters, 6), now);
}

/// Is it bound to that axis, directly or by others? A ring would have no master.
bool MotionBus::follows(int axis, unsigned master) const {
  const auto own = std::ranges::find_if(bindings_, [&](const Binding& one) {
    return static_cast<int>(one.slave) == axis && find(one.slave)->is_bound();
  });
  if (own == bindings_.end()) return false;
  return own->master == static_cast<int>(master) || follows(own->master, master);
}

void MotionBus::bind(const Order& order) {
  Axis& slave = *find(order.axis);
  const Axis* const master = order.master > 0 ? find(static_cast<unsigned>(order.master)) : nullptr;
  const bool there = master || (order.master < 0 && order.master >= -4);
  if (!there || master == &slave) return slave.fail(AxisError::bound_axis);
  if (follows(order.master, order.axis)) return slave.fail(AxisError::bound_not_ready);
  const bool master_ready = !master || (master->is_enabled() && !master->is_moving());
  if (!master_ready || !slave.is_enabled() || slave.is_moving() || slave.is_bound())
    return slave.fail(AxisError::bound_not_ready);
  const double ratio = operand(order.operands[0], true);
  if (!std::isfinite(ratio)) return slave.fail(AxisError::bound_not_ready);
  slave.bind(ratio);
  bindings_.push_back({order.master, order.axis, place_of(order.master)});
}

// ---- servos ----

namespace {

constexpr std::string_view push = "push ";

struct OfServo {
  std::optional<std::uint32_t> number;  // nothing: there can be none such
  std::string_view what;
};

std::optional<std::uint32_t> servo_number(std::string_view word) {
  const std::optional<std::uint32_t> number = plain_number(word);
  return number && *number >= 1 && *number <= last_axis ? number : std::nullopt;
}

/// "servo 1 alarm": 1, and "alarm".
OfServo read_servo_action(std::string_view action) {
  Words words(action);
  words.next();
  const std::optional<std::uint32_t> number = servo_number(words.next());
  return {number, words.rest()};
}

/// "U0-62 of servo 1": 1, and "U0-62".
OfServo read_counter(std::string_view text) {
  Words words(text);
  const std::string_view counter = words.next();
  if (words.next() != "of" || words.next() != "servo") return {};
  return {servo_number(words.rest()), counter};
}

/// "have 3 sync errors"
bool expect_errors(BusCounters& counters, std::string_view what) {
  Words words(what);
  if (words.next() != "have") return false;
  const std::optional<std::uint32_t> periods = plain_number(words.next());
  const std::string_view kind = words.next();
  return periods && words.rest() == "errors" && counters.expect(kind, *periods);
}

std::optional<std::int32_t> pushed_by(std::string_view what) {
  return what.starts_with(push) ? constant<std::int32_t>(what.substr(push.size())) : std::nullopt;
}

/// What happens to the drive itself. False: there is no such thing.
bool happens_to(Servo& servo, std::string_view what) {
  if (what == "off" || what == "on")
    servo.connected = what == "on";
  else if (what == "alarm" || what == "stuck alarm") {
    servo.alarm = true;
    servo.clearable = what == "alarm";
  } else if (what == "well")
    servo.alarm = false;
  else if (what == "stall" || what == "free")
    servo.stalled = what == "stall";
  else if (what == "enable" || what == "disable")
    servo.enabled_by_hand = what == "enable";
  else
    return expect_errors(servo.counters, what);
  return true;
}

Status check_servo_action(std::string_view action) {
  const auto [number, what] = read_servo_action(action);
  if (!number) return wrong(action, "there is no such servo");
  Servo untouched;
  if (pushed_by(what) || happens_to(untouched, what)) return ok();
  return wrong(action,
               "a servo can off, on, alarm, stuck alarm, well, stall, free, enable, disable, "
               "push 500, have 3 sync errors (data, crc, uart)");
}

}  // namespace

bool MotionBus::is_counter(std::string_view text) {
  const auto [number, counter] = read_counter(text);
  return number && BusCounters().get(counter);
}

std::optional<unsigned> MotionBus::count(std::string_view text) const {
  const auto [number, counter] = read_counter(text);
  Axis* const axis = number ? find(*number) : nullptr;
  return axis ? axis->servo().counters.get(counter) : std::nullopt;
}

Status MotionBus::check(std::string_view action, const Memory& memory) {
  if (action.starts_with("servo ")) return check_servo_action(action);
  const Result<Order> order = read(action, memory);
  return order ? ok() : Status(order.error());
}

Status MotionBus::act_on_servo(std::string_view action) {
  if (const Status right = check_servo_action(action); !right) return right;
  const auto [number, what] = read_servo_action(action);
  Axis* const axis = find(*number);
  axis->note(next_, "servo " + std::string(what));
  if (const std::optional<std::int32_t> pulses = pushed_by(what))
    axis->push(*pulses);
  else
    happens_to(axis->servo(), what);
  return ok();
}

std::vector<AxisTrace> MotionBus::trace(Time now) const {
  std::vector<AxisTrace> traces;
  for (const auto& axis : axes_)
    if (std::optional<AxisTrace> one = axis->trace(now)) traces.push_back(std::move(*one));
  return traces;
}

void MotionBus::restart() {
  bindings_.clear();
  downloads_ = begun_ = false;
  for (const auto& axis : axes_) axis->restart();
}

}  // namespace fieldproof::xnet
