#include "suites/email/broken/broken_module.hpp"

#include <nlohmann/json.hpp>

#include "src/email/email_plc.hpp"

namespace fieldproof::email_broken {

namespace {

class BrokenModule : public plc::EmulatedDevice, public net::Host {
 public:
  BrokenModule(const Behaviour& behaviour, std::unique_ptr<plc::EmulatedDevice> good, bool run)
      : behaviour_(behaviour), good_(std::move(good)), module_{*good_, {}, run} {}

  net::Host* network() override { return this; }
  line::Device* line(unsigned channel = 0) override { return good_->line(channel); }
  Status set(std::string_view address, std::string_view hex) override {
    const Status done = good_->set(address, hex);
    show();
    return done;
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return good_->get(address, digits);
  }
  Status act(std::string_view action) override {
    const bool ignored = behaviour_.ignores && behaviour_.ignores(action, module_);
    if (action == "run" || action == "stop") module_.run = action == "run";
    if (action.starts_with("link")) module_.link = action == "link on";
    return ignored ? ok() : good_->act(action);
  }

  bool listens(Transport, std::uint16_t) const override { return false; }
  void receive(const Burst& burst) override {
    module_.now = burst.start;
    Burst heard = burst;
    if (burst.event == LinkEvent::data && behaviour_.hears) {
      heard.bytes = to_bytes(behaviour_.hears(to_text(burst.bytes), module_));
      if (heard.bytes.empty()) return;
    }
    good_->network()->receive(heard);
    show();
  }
  std::optional<Time> wake_at() const override { return good_->network()->wake_at(); }
  std::vector<Burst> advance(Time now) override {
    module_.now = now;
    Bursts does = good_->network()->advance(now);
    for (Burst& one : does) spoil(one);
    std::erase_if(
        does, [](const Burst& one) { return one.event == LinkEvent::data && one.bytes.empty(); });
    if (behaviour_.acts) behaviour_.acts(does, module_);
    show();
    return does;
  }

 private:
  void spoil(Burst& one) {
    if (one.event != LinkEvent::data) return;
    std::string text = to_text(one.bytes);
    if (behaviour_.says) one.bytes = to_bytes(behaviour_.says(text, module_));
    module_.last_said = std::move(text);
  }
  void show() {
    if (behaviour_.shows) behaviour_.shows(module_);
  }

  Behaviour behaviour_;
  std::unique_ptr<plc::EmulatedDevice> good_;
  Module module_;
};

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_module(const Behaviour& behaviour,
                                                                std::string_view model,
                                                                const nlohmann::json& config) {
  nlohmann::json own = config;
  if (behaviour.works_with) behaviour.works_with(own);
  Result<std::unique_ptr<plc::EmulatedDevice>> good = email::make_email_plc(model, own);
  if (!good || !(*good)->network()) return good;
  return std::unique_ptr<plc::EmulatedDevice>(std::make_unique<BrokenModule>(
      behaviour, std::move(*good), config.value("mode", "run") == "run"));
}

}  // namespace fieldproof::email_broken
