#include "suites/xnet/broken/broken_xnet.hpp"

#include <algorithm>
#include <deque>
#include <nlohmann/json.hpp>

#include "src/xnet_network/network.hpp"
#include "suites/broken/wrapped_device.hpp"

namespace fieldproof::xnet_broken {

namespace {

class BrokenXnet : public broken::WrappedDevice {
 public:
  BrokenXnet(std::unique_ptr<plc::EmulatedDevice> right, Behaviour behaviour)
      : WrappedDevice(std::move(right)), behaviour_(std::move(behaviour)) {}

  std::optional<Time> wake_at() const override {
    const std::optional<Time> first = WrappedDevice::wake_at();
    if (waiting_.empty()) return first;
    return std::min(first.value_or(Time::max()), waiting_.front().first);
  }
  Bytes advance(Time now) override {
    now_ = now;
    Bytes sent = WrappedDevice::advance(now);
    while (!waiting_.empty() && waiting_.front().first <= now) {
      (void)WrappedDevice::act(waiting_.front().second);
      waiting_.pop_front();
    }
    follow_up();
    return sent;
  }

  Status set(std::string_view address, std::string_view hex) override {
    const std::string name(address);
    const std::string own =
        behaviour_.set_value ? behaviour_.set_value(name, std::string(hex)) : std::string(hex);
    return WrappedDevice::set(behaviour_.set_name ? behaviour_.set_name(name) : name, own);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    const std::string name(address);
    auto held =
        WrappedDevice::get(behaviour_.look_name ? behaviour_.look_name(name) : name, digits);
    if (!held || !behaviour_.value) return held;
    return behaviour_.value(name, *held);
  }
  Status act(std::string_view action) override {
    std::vector<std::string> actions{std::string(action)};
    if (behaviour_.act) actions = behaviour_.act(actions.front(), looking(), putting());
    if (behaviour_.late == 0ms) {
      const Status done = act_all(actions);
      follow_up();
      return done;
    }
    for (std::string& one : actions) waiting_.emplace_back(now_ + behaviour_.late, std::move(one));
    return ok();
  }
  Trace trace() const override {
    Trace trace = WrappedDevice::trace();
    if (behaviour_.trace) behaviour_.trace(trace);
    return trace;
  }

 private:
  void follow_up() {
    if (behaviour_.after) behaviour_.after(looking(), putting());
  }
  Look looking() {
    return [this](const std::string& name, std::size_t digits) {
      const auto held = right().get(name, digits);
      return held ? *held : std::string(digits, '0');
    };
  }
  Put putting() {
    return
        [this](const std::string& name, const std::string& hex) { (void)right().set(name, hex); };
  }

  Behaviour behaviour_;
  std::deque<std::pair<Time, std::string>> waiting_;
  Time now_{};
};

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_xnet(const Behaviour& behaviour,
                                                              std::string_view model,
                                                              const nlohmann::json& config) {
  nlohmann::json own = config;
  if (behaviour.config) behaviour.config(own);
  auto right = xnet::make_xnet(model, own);
  if (!right) return right.error();
  return std::unique_ptr<plc::EmulatedDevice>(
      std::make_unique<BrokenXnet>(std::move(*right), behaviour));
}

}  // namespace fieldproof::xnet_broken
