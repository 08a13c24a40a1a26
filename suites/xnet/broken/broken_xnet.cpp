#include "suites/xnet/broken/broken_xnet.hpp"

#include <algorithm>
#include <deque>
#include <nlohmann/json.hpp>

#include "src/xnet_network/network.hpp"

namespace fieldproof::xnet_broken {

namespace {

constexpr Duration look_period = 3ms;

class BrokenXnet : public plc::SerialDevice {
 public:
  BrokenXnet(std::unique_ptr<plc::EmulatedDevice> right, Behaviour behaviour)
      : right_(std::move(right)), behaviour_(std::move(behaviour)) {}

  void receive(const Burst& burst) override { right_->line()->receive(burst); }
  std::optional<Time> wake_at() const override {
    std::optional<Time> first = right_->line()->wake_at();
    const auto consider = [&](Time at) { first = std::min(first.value_or(at), at); };
    if (behaviour_.meddle) consider(next_look_);
    if (!waiting_.empty()) consider(waiting_.front().first);
    return first;
  }
  Bytes advance(Time now) override {
    now_ = now;
    Bytes sent = right_->line()->advance(now);
    while (!waiting_.empty() && waiting_.front().first <= now) {
      (void)right_->act(waiting_.front().second);
      waiting_.pop_front();
    }
    if (behaviour_.meddle && now >= next_look_) {
      behaviour_.meddle(looking(), putting());
      next_look_ = now + look_period;
    }
    return sent;
  }

  Status set(std::string_view address, std::string_view hex) override {
    const std::string name(address);
    return right_->set(behaviour_.set_name ? behaviour_.set_name(name) : name, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    const std::string name(address);
    auto held = right_->get(behaviour_.look_name ? behaviour_.look_name(name) : name, digits);
    if (!held || !behaviour_.value) return held;
    return behaviour_.value(name, *held);
  }
  Status act(std::string_view action) override {
    Status done = ok();
    const std::string own(action);
    for (const std::string& one :
         behaviour_.act ? behaviour_.act(own, looking(), putting()) : std::vector{own}) {
      if (!done) return done;
      if (behaviour_.late > 0ms)
        waiting_.emplace_back(now_ + behaviour_.late, one);
      else
        done = right_->act(one);
    }
    return done;
  }

 private:
  Look looking() {
    return [this](const std::string& name, std::size_t digits) {
      const auto held = right_->get(name, digits);
      return held ? *held : std::string(digits, '0');
    };
  }
  Put putting() {
    return
        [this](const std::string& name, const std::string& hex) { (void)right_->set(name, hex); };
  }

  std::unique_ptr<plc::EmulatedDevice> right_;
  Behaviour behaviour_;
  std::deque<std::pair<Time, std::string>> waiting_;
  Time now_{}, next_look_{};
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
