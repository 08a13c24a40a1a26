#include "suites/hs_link/protocol.hpp"

#include <nlohmann/json.hpp>

#include "src/hs_link/network.hpp"
#include "src/plc/model.hpp"
#include "suites/hs_link/facts.hpp"

namespace fieldproof::hs_link_suite {

namespace {

class HsLink : public harness::Protocol, public harness::Tables {
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

  // No manual prints a frame of it (DECISIONS.md hslink/no-frames).
  Bytes station_bytes(int station) const override { return {static_cast<Byte>(station)}; }
  bool is_text() const override { return false; }
  bool has_frame_ends() const override { return false; }
  std::optional<std::size_t> frame_length(ByteView) const override { return std::nullopt; }
  std::vector<harness::Field> explain(ByteView) const override { return {}; }
  std::vector<Written> written_by(ByteView) const override { return {}; }
  std::string_view output_areas() const override { return "PQU"; }

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
