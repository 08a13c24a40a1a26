#include "suites/user_frames/broken/faults.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "src/user_frames/codec.hpp"
#include "src/user_frames/port.hpp"
#include "suites/user_frames/definition_files.hpp"

namespace fieldproof::user_frames_broken {

using plc::EmulatedDevice;
using user_frames::Segment;
using user_frames::UserFrame;

const std::vector<Fault>& faults() {
  static const std::vector<Fault> table = [] {
    std::vector<Fault> all;
    for (auto part : {check_faults, frame_faults, variable_faults})
      std::ranges::move(part(), std::back_inserter(all));
    return all;
  }();
  return table;
}

Behaviour each_frame(std::function<void(UserFrame& frame)> edit) {
  return {.works_with =
              [edit = std::move(edit)](user_frames::FrameDefinition& definition) {
                std::ranges::for_each(definition.frames, edit);
              },
          .set_to = {},
          .says = {},
          .deaf_to = {}};
}

Behaviour each_received(std::function<void(UserFrame& frame)> edit) {
  return each_frame([edit = std::move(edit)](UserFrame& frame) {
    if (!frame.sent) edit(frame);
  });
}

Behaviour each_sent(std::function<void(UserFrame& frame)> edit) {
  return each_frame([edit = std::move(edit)](UserFrame& frame) {
    if (frame.sent) edit(frame);
  });
}

Behaviour each_segment(std::function<void(Segment& segment)> edit) {
  return each_frame(
      [edit = std::move(edit)](UserFrame& frame) { std::ranges::for_each(frame.segments, edit); });
}

Behaviour each_check(std::function<void(Segment& check)> edit) {
  return each_segment([edit = std::move(edit)](Segment& segment) {
    if (segment.kind == Segment::Kind::check) edit(segment);
  });
}

void accept_anything(Segment& segment) { segment.kind = Segment::Kind::data; }

void remove_segment(UserFrame& frame, std::size_t position) {
  frame.segments.erase(frame.segments.begin() + static_cast<std::ptrdiff_t>(position));
  for (Segment& segment : frame.segments) {
    if (segment.first > position) --segment.first;
    if (segment.last > 0 && segment.last >= position) --segment.last;
  }
}

void insert_behind(UserFrame& frame, std::size_t position, Segment segment) {
  frame.segments.insert(frame.segments.begin() + static_cast<std::ptrdiff_t>(position + 1),
                        std::move(segment));
  for (Segment& one : frame.segments) {
    if (one.first > position) ++one.first;
    if (one.last > position) ++one.last;
  }
}

namespace {

/// A port that speaks otherwise than it should, or does not listen to its switch.
class MisspeakingPort : public plc::SerialDevice {
 public:
  MisspeakingPort(std::unique_ptr<EmulatedDevice> port, Behaviour behaviour)
      : port_(std::move(port)), behaviour_(std::move(behaviour)) {}

  void receive(const Burst& burst) override { port_->line()->receive(burst); }
  std::optional<Time> wake_at() const override { return port_->line()->wake_at(); }
  Bytes advance(Time now) override {
    const Bytes bytes = port_->line()->advance(now);
    return behaviour_.says && !bytes.empty() ? behaviour_.says(bytes) : bytes;
  }
  Status set(std::string_view address, std::string_view hex) override {
    return port_->set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return port_->get(address, digits);
  }
  Status act(std::string_view action) override {
    return action == behaviour_.deaf_to ? ok() : port_->act(action);
  }

 private:
  std::unique_ptr<EmulatedDevice> port_;
  Behaviour behaviour_;
};

}  // namespace

Result<user_frames::FrameDefinition> broken_definition(const Behaviour& behaviour,
                                                       std::string_view model,
                                                       nlohmann::json& config) {
  Result<user_frames_suite::NamedDefinition> loaded =
      user_frames_suite::load_definition(model, user_frames_suite::definitions_folder());
  if (!loaded) return loaded.error();
  if (behaviour.works_with) behaviour.works_with(loaded->definition);
  if (behaviour.set_to) behaviour.set_to(config);
  return std::move(loaded->definition);
}

Result<std::unique_ptr<EmulatedDevice>> make_broken_port(const Behaviour& behaviour,
                                                         std::string_view model,
                                                         nlohmann::json config) {
  const Result<user_frames::FrameDefinition> definition =
      broken_definition(behaviour, model, config);
  if (!definition) return definition.error();
  Result<std::unique_ptr<EmulatedDevice>> port =
      user_frames::make_user_frame_device(*definition, config);
  if (!port) return port.error();
  return std::unique_ptr<EmulatedDevice>(
      std::make_unique<MisspeakingPort>(std::move(*port), behaviour));
}

}  // namespace fieldproof::user_frames_broken
