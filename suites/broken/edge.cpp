#include "suites/broken/edge.hpp"

#include <utility>

namespace fieldproof::broken {

/// One channel.
class EdgeDevice::Line : public line::Device {
 public:
  Line(line::Device& right, const Edge& edge, unsigned channel)
      : right_(right), edge_(edge), channel_(channel) {}

  void receive(const Burst& burst) override {
    Burst heard = burst;
    if (!edge_.hears || edge_.hears(heard, channel_)) right_.receive(heard);
  }
  std::optional<Time> wake_at() const override { return right_.wake_at(); }
  Bytes advance(Time now) override {
    Bytes bytes = right_.advance(now);
    if (edge_.says && !bytes.empty()) edge_.says(bytes, channel_);
    return bytes;
  }

 private:
  line::Device& right_;
  const Edge& edge_;
  unsigned channel_;
};

EdgeDevice::EdgeDevice(std::unique_ptr<plc::EmulatedDevice> right, Edge edge)
    : right_(std::move(right)), edge_(std::move(edge)) {}

EdgeDevice::~EdgeDevice() = default;

line::Device* EdgeDevice::line(unsigned channel) {
  line::Device* const right = right_->line(channel);
  if (!right) return nullptr;
  std::unique_ptr<Line>& own = lines_[right];
  if (!own) own = std::make_unique<Line>(*right, edge_, channel);
  return own.get();
}

void EdgeDevice::receive(const Burst& burst) {
  Burst heard = burst;
  if (!edge_.hears_link || edge_.hears_link(heard)) right_->network()->receive(heard);
}

std::vector<Burst> EdgeDevice::advance(Time now) {
  std::vector<Burst> doings = right_->network()->advance(now);
  if (edge_.does) edge_.does(doings);
  return doings;
}

Result<std::string> EdgeDevice::get(std::string_view address, std::size_t digits) const {
  Result<std::string> right = right_->get(address, digits);
  return right && edge_.shows ? Result<std::string>(edge_.shows(address, *right)) : right;
}

}  // namespace fieldproof::broken
