#include "suites/hs_link/protocol.hpp"

#include <nlohmann/json.hpp>

#include "harness/frameless_protocol.hpp"
#include "src/hs_link/network.hpp"
#include "src/plc/model.hpp"
#include "suites/hs_link/facts.hpp"

namespace fieldproof::hs_link_suite {

namespace {

/// DECISIONS.md hslink/no-frames
class HsLink : public harness::FramelessProtocol, public harness::Tables {
 public:
  std::string_view name() const override { return "hs-link"; }
  std::vector<std::string> models() const override {
    std::vector<std::string> names;
    for (const plc::PlcModel& model : plc::plc_models()) names.emplace_back(model.name);
    return names;
  }

  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const override {
    return hs_link::make_hs_network(model, config);
  }

  std::vector<std::string_view> output_areas() const override { return {"P", "Q", "U"}; }

  const harness::Tables* tables() const override { return this; }
  Status check_table(const nlohmann::json& facts) const override {
    return hs_link_suite::check_fact(facts);
  }
};

}  // namespace

const harness::Protocol& protocol() {
  static const HsLink protocol;
  return protocol;
}

}  // namespace fieldproof::hs_link_suite
