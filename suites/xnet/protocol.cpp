#include "suites/xnet/protocol.hpp"

#include <nlohmann/json.hpp>

#include "src/xnet_network/network.hpp"
#include "suites/xnet/facts.hpp"

namespace fieldproof::xnet_suite {

namespace {

class Xnet : public harness::Protocol, public harness::Tables {
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

  // No frame of it is printed (DECISIONS.md xnet/no-frames).
  Bytes station_bytes(int station) const override { return {static_cast<Byte>(station)}; }
  bool is_text() const override { return false; }
  bool has_frame_ends() const override { return false; }
  std::optional<std::size_t> frame_length(ByteView) const override { return std::nullopt; }
  std::vector<harness::Field> explain(ByteView) const override { return {}; }
  std::vector<Written> written_by(ByteView) const override { return {}; }
  std::string_view output_areas() const override { return "Y"; }

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
