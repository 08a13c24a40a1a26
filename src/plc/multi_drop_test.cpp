#include "src/plc/multi_drop.hpp"

#include <gtest/gtest.h>

namespace fieldproof::plc {
namespace {

/// Says its name once it has heard it; keeps all that it hears.
class Talker : public SerialDevice {
 public:
  Talker(std::string name, std::string& heard) : name_(std::move(name)), heard_(heard) {}
  void receive(const Burst& burst) override {
    const std::string text = to_text(burst.bytes);
    heard_ += text + ";";
    if (text == name_) due_ = burst.end() + 1ms;
  }
  std::optional<Time> wake_at() const override { return due_; }
  Bytes advance(Time now) override {
    if (!due_ || now < *due_) return {};
    due_.reset();
    return to_bytes("I am " + name_);
  }
  Status set(std::string_view address, std::string_view) override {
    return fail(name_ + " has no " + std::string(address));
  }
  Result<std::string> get(std::string_view, std::size_t) const override { return name_; }
  Status act(std::string_view) override { return ok(); }

 private:
  std::string name_;
  std::string& heard_;
  std::optional<Time> due_;
};

TEST(MultiDrop, TheOneThatIsMeantAnswersAndAllHearIt) {
  std::string heard_by_a, heard_by_b;
  std::vector<std::unique_ptr<EmulatedDevice>> devices;
  devices.push_back(std::make_unique<Talker>("a", heard_by_a));
  devices.push_back(std::make_unique<Talker>("b", heard_by_b));
  MultiDrop line(std::move(devices));
  EXPECT_FALSE(line.wake_at());
  line.receive({to_bytes("b"), 10ms, 0ms});
  EXPECT_EQ(line.wake_at(), 11ms);
  EXPECT_EQ(to_text(line.advance(11ms)), "I am b");
  EXPECT_TRUE(line.advance(11ms).empty());
  EXPECT_EQ(heard_by_a, "b;I am b;");
  EXPECT_EQ(heard_by_b, "b;") << "nobody hears itself";
  EXPECT_EQ(*line.get("%MW0", 4), "a") << "the back door leads to the first";
}

}  // namespace
}  // namespace fieldproof::plc
