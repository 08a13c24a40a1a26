#include "src/user_frames/port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "src/base/spelling.hpp"
#include "src/plc/config_reader.hpp"

namespace fieldproof::user_frames {

namespace {
constexpr std::string_view send_verb = "send ";
}  // namespace

UserFramePort::UserFramePort(const FrameDefinition& definition, plc::PlcMemory& memory,
                             const plc::PortConfig& config)
    : definition_(definition),
      memory_(memory),
      delay_(config.reply_delay()),
      finder_(user_frames::received_frames(definition_), config.gap()) {}

Result<std::unique_ptr<plc::EmulatedDevice>> make_user_frame_device(
    const FrameDefinition& definition, const nlohmann::json& config) {
  const std::string what = "the port's configuration";
  if (const Status known = plc::known_keys(config, what, plc::port_keys()); !known)
    return known.error();
  plc::PortConfig port;
  port.model = definition.plc->name;
  plc::ConfigReader reader(config, what);
  plc::read_port_config(reader, port);
  if (reader.error()) return *reader.error();
  if (const auto model = plc::check_port_config(port); !model) return model.error();
  auto plc = std::make_unique<plc::Plc>(*definition.plc, port.run);
  (void)plc->add(1, std::make_unique<UserFramePort>(definition, plc->memory(), port));
  return std::unique_ptr<plc::EmulatedDevice>(std::move(plc));
}

void UserFramePort::receive(const Burst& burst) {
  if (run_) finder_.receive(burst, *this);
  now_ = std::max(now_, burst.end());
}

void UserFramePort::on_user_frame(const UserFrame& frame, const FrameMatch& match, ByteView bytes,
                                  Time end) {
  if (store(frame, match, bytes, memory_) != Stored::yes)
    return counters_.count_error(plc::service_status::not_hex);
  counters_.count_service();
  memory_.written();
  if (frame.answer.empty()) return;
  Result<Bytes> answer = build_frame(*definition_.find(frame.answer), memory_);
  if (!answer) return counters_.count_error(plc::service_status::not_hex);
  counters_.count_service();
  queue_.put(end + delay_, std::move(*answer));
}

std::optional<Time> UserFramePort::wake_at() const { return queue_.wake_at(finder_.wake_at()); }

Bytes UserFramePort::advance(Time now) {
  now_ = std::max(now_, now);
  finder_.advance(now, *this);
  return queue_.take(now);
}

Status UserFramePort::send(std::string_view name) {
  const UserFrame* frame = definition_.find(name);
  if (!frame || !frame->sent) {
    std::vector<std::string_view> names;
    for (const UserFrame& one : definition_.frames)
      if (one.sent) names.push_back(one.name);
    return fail(fmt::format("cannot send '{}': {}; {}{}", name,
                            frame ? "this frame is received" : "there is no such frame",
                            names.empty()
                                ? "the definition has no frame to send"
                                : fmt::format("the first one to send is {}", names.front()),
                            suggestion(name, names)));
  }
  if (!run_) return ok();  // P2P rests in STOP
  Result<Bytes> bytes = build_frame(*frame, memory_);
  if (!bytes) return bytes.error();
  counters_.count_service();
  queue_.put(now_, std::move(*bytes));
  return ok();
}

std::optional<Status> UserFramePort::act(std::string_view action) {
  if (!action.starts_with(send_verb)) return std::nullopt;
  return send(action.substr(send_verb.size()));
}

void UserFramePort::set_run(bool run) {
  run_ = run;
  forget();
}

void UserFramePort::power_cycle() {
  counters_ = {};
  forget();
}

void UserFramePort::forget() {
  finder_.reset();
  queue_.clear();
}

}  // namespace fieldproof::user_frames
