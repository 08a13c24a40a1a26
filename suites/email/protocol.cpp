#include "suites/email/protocol.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/plc_protocol.hpp"
#include "src/email/email_plc.hpp"
#include "src/email/settings.hpp"
#include "src/plc/config_reader.hpp"
#include "suites/email/frame_parts.hpp"
#include "suites/xgt_cnet/protocol.hpp"

namespace fieldproof::email_suite {

using nlohmann::json;

namespace {

/// {"parameter": {...p2p...}, "accepted": false, "says": "at most 10"}: does the module take such a
/// parameter, and what does it say?
Status check_parameter(const json& facts) {
  constexpr std::array<std::string_view, 3> keys{"accepted", "parameter", "says"};
  if (const Status known = plc::known_keys(facts, "facts", keys); !known) return known;
  const auto made =
      email::make_email_plc("xbc-h", {{"role", "client"}, {"p2p", facts.at("parameter")}});
  if (bool(made) != facts.value("accepted", true))
    return fail(made ? "the parameter is accepted" : "it is refused: " + made.error().message);
  const std::string says = facts.value("says", "");
  if (!made && made.error().message.find(says) == std::string::npos)
    return fail(fmt::format("the error says '{}', without '{}'", made.error().message, says));
  return ok();
}

class Email : public harness::PlcProtocol, public harness::Tables {
 public:
  using PlcProtocol::PlcProtocol;

  std::string_view name() const override { return "email"; }
  std::uint16_t default_port() const override { return email::smtp_port; }

  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(std::string_view model,
                                                           const json& config) const override {
    return email::make_email_plc(model, config);
  }

  /// No line names a station.
  Bytes station_bytes(int) const override { return {}; }
  /// Ten recipients in the header, and some lines of text.
  std::size_t longest_frame() const override { return 8192; }
  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    return email_suite::frame_length(bytes);
  }
  std::vector<harness::Field> explain(ByteView frame) const override {
    return email_suite::explain(frame);
  }

  const harness::Tables* tables() const override { return this; }
  std::vector<Written> written_by(ByteView) const override { return {}; }
  std::vector<std::string_view> output_areas() const override { return {"P", "Q", "U"}; }

  Result<std::unique_ptr<harness::Protocol>> configured(std::string_view model,
                                                        const json&) const override {
    return std::unique_ptr<harness::Protocol>(std::make_unique<Email>(plc::find_plc_model(model)));
  }
  /// Flags and registers of P2P are those of the same PLC on Cnet.
  Status check_table(const json& facts) const override {
    return facts.contains("parameter") ? check_parameter(facts)
                                       : xgt_cnet_suite::protocol().check_fact(facts);
  }
};

}  // namespace

const harness::Protocol& protocol() {
  static const Email email;
  return email;
}

}  // namespace fieldproof::email_suite
