#include "src/user_frames/port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "src/base/spelling.hpp"
#include "src/plc/config_reader.hpp"
#include "src/plc/device_action.hpp"

namespace fieldproof {

using user_frames::FrameMatch;
using user_frames::UserFrame;

namespace {
constexpr std::string_view send_verb = "send ";
}  // namespace

UserFramePort::UserFramePort(const user_frames::FrameDefinition& definition, const PortConfig& config)
    : definition_(definition), memory_(*definition.plc), gap_(config.gap()), delay_(config.reply_delay()), run_(config.run) {}

Result<std::unique_ptr<EmulatedDevice>> make_user_frame_device(const user_frames::FrameDefinition& definition,
                                                               const nlohmann::json& config) {
  const std::string what = "the port's configuration";
  if (const Status known = known_keys(config, what, port_keys()); !known) return known.error();
  PortConfig port;
  port.model = definition.plc->name;
  ConfigReader reader(config, what);
  read_port_config(reader, port);
  if (reader.error()) return *reader.error();
  if (const auto model = check_port_config(port); !model) return model.error();
  return std::unique_ptr<EmulatedDevice>(new UserFramePort(definition, port));
}

void UserFramePort::receive(const Burst& burst) {
  if (burst.bytes.empty()) return;
  now_ = std::max(now_, burst.start);
  if (burst.start - last_end_ > gap_) {
    take_frames(now_, true);
    passing_over_ = false;
  }
  Time end = burst.start;
  for (const Byte b : burst.bytes) {
    end += burst.character_time;
    if (run_) heard_.push_back(b);
    take_frames(end, false);
  }
  last_end_ = end;
  now_ = std::max(now_, end);
  character_time_ = burst.character_time;
}

UserFramePort::Found UserFramePort::find(bool ended) const {
  Found best;
  for (const UserFrame& frame : definition_.frames) {
    if (frame.sent) continue;
    FrameMatch match = match_frame(frame, heard_, ended);
    if (match.state == FrameMatch::State::complete && check_holds(frame, match, heard_)) return {std::move(match), &frame};
    if (match.state > best.match.state) best.match = std::move(match);
  }
  return best;
}

void UserFramePort::take_frames(Time now, bool ended) {
  while (!heard_.empty()) {
    if (heard_.size() > user_frames::max_frame) return drop_heard();
    const Found found = find(ended);
    switch (found.match.state) {
      case FrameMatch::State::no: pass_over(); break;
      case FrameMatch::State::complete: take(found, now); break;
      case FrameMatch::State::partial: return ended ? drop_heard() : void();
    }
  }
}

/// Cut off, or too long.
void UserFramePort::drop_heard() {
  counters_.count_error(service_status::tail);
  heard_.clear();
}

/// A run of bytes that belong to no frame is one error.
void UserFramePort::pass_over() {
  if (!passing_over_) counters_.count_error(service_status::head);
  passing_over_ = true;
  heard_.erase(heard_.begin());
}

void UserFramePort::take(const Found& found, Time now) {
  Bytes frame(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(found.match.length()));
  heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(frame.size()));
  passing_over_ = false;
  if (!found.frame) return counters_.count_error(service_status::bcc);
  if (!store(*found.frame, found.match, frame, memory_)) return counters_.count_error(service_status::not_hex);
  counters_.count_service();
  if (found.frame->answer.empty()) return;
  Result<Bytes> answer = build_frame(*definition_.find(found.frame->answer), memory_);
  if (!answer) return counters_.count_error(service_status::not_hex);
  counters_.count_service();
  queue_.put(now + delay_, std::move(*answer));
}

std::optional<Time> UserFramePort::wake_at() const {
  std::optional<Time> silence;
  // A character that begins at the last moment is complete, and heard, one character time later.
  if (!heard_.empty()) silence = last_end_ + gap_ + character_time_ + Duration(1);
  return queue_.wake_at(silence);
}

Bytes UserFramePort::advance(Time now) {
  now_ = std::max(now_, now);
  if (!heard_.empty() && now > last_end_ + gap_ + character_time_) take_frames(now, true);
  return queue_.take(now);
}

Status UserFramePort::set(std::string_view address, std::string_view hex) { return set_by_name(memory_, address, hex); }

Result<std::string> UserFramePort::get(std::string_view address, std::size_t digits) const {
  return address.starts_with('@') ? get_counter(counters_, address, digits) : get_by_name(memory_, address, digits);
}

Status UserFramePort::send(std::string_view name) {
  const UserFrame* frame = definition_.find(name);
  if (!frame || !frame->sent) {
    std::vector<std::string_view> names;
    for (const UserFrame& one : definition_.frames)
      if (one.sent) names.push_back(one.name);
    return fail(fmt::format(
        "cannot send '{}': {}; {}{}", name, frame ? "this frame is received" : "there is no such frame",
        names.empty() ? "the definition has no frame to send" : fmt::format("the first one to send is {}", names.front()),
        suggestion(name, names)));
  }
  if (!run_) return ok();  // P2P rests in STOP
  Result<Bytes> bytes = build_frame(*frame, memory_);
  if (!bytes) return bytes.error();
  counters_.count_service();
  queue_.put(now_, std::move(*bytes));
  return ok();
}

Status UserFramePort::act(std::string_view action) {
  if (action.starts_with(send_verb)) return send(action.substr(send_verb.size()));
  const Result<DeviceAction> known = parse_device_action(action);
  if (!known) return fail(known.error().message + "; or send GROUP.FRAME");
  switch (*known) {
    case DeviceAction::run: run_ = true; return ok();
    case DeviceAction::stop: run_ = false; break;
    case DeviceAction::power_cycle: counters_ = {}; break;
  }
  heard_.clear();
  queue_.clear();
  passing_over_ = false;
  return ok();
}

}  // namespace fieldproof
