#include "suites/hs_link/broken/broken_network.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "src/hs_link/network.hpp"
#include "suites/broken/wrapped_device.hpp"

namespace fieldproof::hs_link_broken {

namespace {

class BrokenNetwork : public broken::WrappedDevice {
 public:
  BrokenNetwork(std::unique_ptr<plc::EmulatedDevice> right, const plc::PlcModel& model,
                Behaviour behaviour)
      : WrappedDevice(std::move(right)), model_(model), behaviour_(std::move(behaviour)) {}

  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    const plc::ParsedAddress parsed = plc::parse_address(model_, address);
    if (behaviour_.bit && parsed && address.starts_with("%L")) return of_l(parsed.address, digits);
    if (behaviour_.show && address.starts_with('@'))
      return WrappedDevice::get(behaviour_.show(address), digits);
    return WrappedDevice::get(address, digits);
  }
  Status act(std::string_view action) override {
    if (!behaviour_.act) return WrappedDevice::act(action);
    return act_all(behaviour_.act(std::string(action)));
  }

 private:
  std::string look(unsigned bit) const {
    const std::string word = *right().get(fmt::format("%LW{}", bit / 16), 4);
    return std::stoul(word, nullptr, 16) >> bit % 16 & 1 ? "01" : "00";
  }
  /// Bits and words of L, bit by bit.
  std::string of_l(const plc::DeviceAddress& address, std::size_t digits) const {
    const Look right = [this](unsigned bit) { return look(bit); };
    if (address.type == 'X') return behaviour_.bit(address.index, right);
    std::string text;
    for (unsigned word = 0; word < std::max<std::size_t>(1, digits / 4); ++word) {
      unsigned value = 0;
      for (unsigned bit = 0; bit < 16; ++bit)
        if (behaviour_.bit((address.index + word) * 16 + bit, right) == "01") value |= 1u << bit;
      text += fmt::format("{:04X}", value);
    }
    return text;
  }

  const plc::PlcModel& model_;
  Behaviour behaviour_;
};

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_network(const Behaviour& behaviour,
                                                                 std::string_view model,
                                                                 const nlohmann::json& config) {
  nlohmann::json own = config;
  if (behaviour.config) behaviour.config(own);
  auto right = hs_link::make_hs_network(model, own);
  if (!right) return right.error();
  return std::unique_ptr<plc::EmulatedDevice>(
      std::make_unique<BrokenNetwork>(std::move(*right), *plc::find_plc_model(model), behaviour));
}

}  // namespace fieldproof::hs_link_broken
