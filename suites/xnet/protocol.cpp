#include "suites/xnet/protocol.hpp"

#include <nlohmann/json.hpp>

#include "harness/frameless_protocol.hpp"
#include "src/xnet_network/network.hpp"
#include "suites/xnet/facts.hpp"
#include "suites/xnet/over_modbus.hpp"

namespace fieldproof::xnet_suite {

namespace {

/// DECISIONS.md xnet/no-frames
class Xnet : public harness::FramelessProtocol, public harness::Tables {
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

  std::string_view output_areas() const override { return "Y"; }
  std::optional<WordName> read_word(std::string_view text) const override {
    const bool whole = text.find_first_of("0123456789") == text.npos;
    const auto found = xnet::find_component(whole ? std::string(text) + "0" : std::string(text));
    if (!found) return std::nullopt;
    return WordName{std::string(found->area->name),
                    whole ? std::nullopt : std::optional(found->number)};
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
