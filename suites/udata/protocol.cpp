#include "suites/udata/protocol.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "src/udata/modem.hpp"
#include "src/udata/port.hpp"
#include "suites/checks/checks.hpp"

namespace fieldproof::udata_suite {

namespace {

constexpr std::string_view modem = "modem";

class Udata : public harness::Protocol {
 public:
  std::string_view name() const override { return "udata"; }
  std::vector<std::string> models() const override {
    return {"xbc-h", "xec-h", std::string(modem)};
  }

  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const override {
    return model == modem ? udata::make_modem(config) : udata::make_udata_port(model, config);
  }

  /// There is no station in the data; this is how XGT writes one.
  notation::Checks checks() const override {
    static const std::array all{checks::bcc, checks::sum, checks::crc, checks::lrc};
    return all;
  }
  Bytes station_bytes(int station) const override {
    return to_bytes(hex_number(static_cast<unsigned>(station), 2));
  }
  /// What a case expects is as long as it is; nothing in the bytes ends them.
  bool has_frame_ends() const override { return false; }
  std::optional<std::size_t> frame_length(ByteView) const override { return std::nullopt; }

  std::vector<harness::Field> explain(ByteView frame) const override {
    if (frame.empty()) return {};
    return {{"data", 0, frame.size(), to_hex(frame),
             frame.size() > udata::udata_max ? "more than 1024 bytes" : ""}};
  }

  /// A program receives it, or a modem obeys it: it may dial.
  std::vector<Written> written_by(ByteView request) const override {
    if (request.empty()) return {};
    return {{"?", 0, 0, "what the program behind the port makes of it"}};
  }
  std::vector<std::string_view> output_areas() const override { return {"P", "Q", "U"}; }
};

}  // namespace

const harness::Protocol& protocol() {
  static const Udata udata;
  return udata;
}

}  // namespace fieldproof::udata_suite
