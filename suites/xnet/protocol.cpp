#include "suites/xnet/protocol.hpp"

#include <nlohmann/json.hpp>

#include "harness/frameless_protocol.hpp"
#include "src/xnet_motion/axis_registers.hpp"
#include "src/xnet_network/check_text.hpp"
#include "src/xnet_network/network.hpp"
#include "suites/modbus/xinje_objects.hpp"
#include "suites/xnet/facts.hpp"
#include "suites/xnet/over_modbus.hpp"

namespace fieldproof::xnet_suite {

namespace {

/// DECISIONS.md xnet/no-frames
class Xnet : public harness::FramelessProtocol, public harness::Tables, public harness::Texts {
 public:
  std::string_view name() const override { return "xnet"; }
  std::vector<std::string> models() const override {
    std::vector<std::string> names;
    for (const xnet::Model& model : xnet::models()) names.emplace_back(model.name);
    return names;
  }

  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const override {
    return xnet::make_xnet(model, config);
  }

  const harness::Protocol* carried(bool network) const override {
    return network ? &over_modbus_tcp() : &over_modbus_rtu();
  }

  std::vector<std::string_view> output_areas() const override {
    return modbus_suite::xinje_outputs();
  }
  unsigned last_axis() const override { return xnet::last_axis; }
  std::optional<WordName> read_word(std::string_view text) const override {
    return modbus_suite::read_xinje_word(text);
  }

  const harness::Texts* texts() const override { return this; }
  Status check_texts(std::string_view model, const nlohmann::json& config,
                     const std::vector<Setting>& memory,
                     const std::vector<std::string>& actions) const override {
    const xnet::TextCheck check(model, config);
    for (const auto& [address, hex] : memory)
      if (const Status right = check.address(address, hex.size()); !right) return right;
    for (const std::string& action : actions)
      if (const Status right = check.action(action); !right) return right;
    return ok();
  }

  const harness::Tables* tables() const override { return this; }
  Status check_table(const nlohmann::json& facts) const override {
    return xnet_suite::check_fact(facts);
  }
};

}  // namespace

const harness::Protocol& protocol() {
  static const Xnet protocol;
  return protocol;
}

}  // namespace fieldproof::xnet_suite
