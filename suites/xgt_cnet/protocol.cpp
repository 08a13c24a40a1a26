#include "suites/xgt_cnet/protocol.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/plc_protocol.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/plc/model.hpp"
#include "src/xgt_cnet/p2p_driver.hpp"
#include "src/xgt_cnet/plc.hpp"
#include "src/xgt_cnet/plc_config.hpp"
#include "suites/checks/checks.hpp"
#include "suites/services/services.hpp"
#include "suites/xgt_cnet/frame_parts.hpp"
#include "suites/xgt_cnet/memory_requests.hpp"
#include "suites/xgt_cnet/p2p_facts.hpp"

namespace fieldproof::xgt_cnet_suite {

using plc::PlcModel;

namespace {

std::string station_text(int station) { return hex_number(static_cast<unsigned>(station), 2); }

class XgtCnet : public harness::PlcProtocol,
                public harness::Probing,
                public harness::MemoryRequests,
                public harness::Tables {
 public:
  using PlcProtocol::PlcProtocol;

  std::string_view name() const override { return "xgt-cnet"; }

  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const override {
    if (p2p::is_p2p_client(config)) {
      return p2p::make_p2p_device(model, config, [](const plc::PortConfig& port) {
        return std::make_unique<xgt_cnet::XgtP2pDriver>(port.gap());
      });
    }
    if (services::wants_services(config))
      return services::make_plc(model, config, [](plc::Plc& plc, const nlohmann::json& own) {
        const Result<plc::PortConfig> port =
            xgt_cnet::parse_plc_config(plc.memory().model().name, own);
        return port ? xgt_cnet::add_server(plc, 1, *port) : Status(port.error());
      });
    Result<plc::PortConfig> parsed = xgt_cnet::parse_plc_config(model, config);
    if (!parsed) return parsed.error();
    Result<std::unique_ptr<plc::Plc>> plc = xgt_cnet::make_plc(*parsed);
    if (!plc) return plc.error();
    return std::unique_ptr<plc::EmulatedDevice>(std::move(*plc));
  }

  notation::Checks checks() const override { return {&checks::bcc, 1}; }
  notation::NameHead name_head() const override {
    return [](std::size_t characters) { return to_bytes(hex_number(characters, 2)); };
  }
  Bytes station_bytes(int station) const override { return to_bytes(station_text(station)); }
  /// WSS of 16 long words with names of 16 characters (Cnet EN 7.1.5 (2)).
  std::size_t longest_frame() const override { return 600; }
  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    return xgt_cnet_suite::frame_length(bytes);
  }
  std::vector<harness::Field> explain(ByteView frame) const override {
    return xgt_cnet_suite::explain(frame);
  }
  Bytes in_plain_letters(ByteView request) const override {
    return xgt_cnet_suite::in_plain_letters(request);
  }

  /// Requests go from the client to the server.
  plc::FrameResult monitor_result(ByteView frame, bool client, bool sent) const override {
    const bool request = !frame.empty() && frame[0] == enq;
    if (request != (client == sent) || !harness::faultless(explain(frame)))
      return plc::unknown_frame;
    return client ? plc::FrameResult{2, "XGT client"} : plc::FrameResult{1, "XGT server"};
  }

  const harness::Probing* probing() const override { return this; }
  const harness::MemoryRequests* memory() const override { return this; }
  const harness::Tables* tables() const override { return this; }

  /// The first word of M, which every model has, in the other case than the tested command: the
  /// reply repeats the case of the request, so that no reply to the tested frame looks like the
  /// probe's.
  Bytes probing_request(int station, ByteView tested) const override {
    const bool tested_lower = tested.size() > 3 && tested[3] >= 'a' && tested[3] <= 'z';
    const std::string body =
        fmt::format("\x05{}{}SS0104%MW0\x04", station_text(station), tested_lower ? 'R' : 'r');
    Bytes frame = to_bytes(body);
    if (tested_lower) return frame;
    unsigned sum = 0;
    for (Byte b : frame) sum += b;
    for (char c : hex_number(sum & 0xFF, 2)) frame.push_back(static_cast<Byte>(c));
    return frame;
  }

  bool answers_probe(ByteView probe, ByteView reply) const override {
    return reply.size() > 3 && (reply[0] == ack || reply[0] == nak) && reply[3] == probe[3];
  }

  Result<std::vector<Bytes>> requests_to_write(int station, std::string_view address,
                                               std::string_view hex) const override {
    return xgt_cnet_suite::write_requests(station_text(station), address, hex);
  }
  Result<std::vector<Bytes>> requests_to_read(int station, std::string_view address,
                                              std::size_t digits) const override {
    return xgt_cnet_suite::read_requests(station_text(station), address, digits);
  }
  Status acknowledged(ByteView reply) const override { return xgt_cnet_suite::write_reply(reply); }
  Result<std::string> digits_in(ByteView reply) const override {
    return xgt_cnet_suite::read_reply(reply);
  }
  bool answers(ByteView request, ByteView reply) const override {
    return xgt_cnet_suite::answers(request, reply);
  }
  bool is_checked(ByteView request) const override { return xgt_cnet_suite::is_checked(request); }
  std::vector<std::pair<std::string, std::string>> sets(ByteView request) const override {
    return xgt_cnet_suite::sets(request);
  }
  Bytes without_check(ByteView request) const override {
    return xgt_cnet_suite::without_check(request);
  }
  std::vector<Written> written_by(ByteView request) const override {
    return xgt_cnet_suite::written_by(request, declared_model());
  }

  Result<std::unique_ptr<harness::Protocol>> configured(std::string_view model,
                                                        const nlohmann::json&) const override {
    return std::unique_ptr<harness::Protocol>(
        std::make_unique<XgtCnet>(plc::find_plc_model(model)));
  }
  std::vector<AddressField> address_fields(ByteView frame, bool reply) const override {
    return reply ? std::vector<AddressField>() : xgt_cnet_suite::address_fields(frame, model());
  }
  /// Bits: cnet/bit-names, fenet/memory-map.
  bool is_spelt_by_decision(std::string_view address) const override {
    return harness::is_bit_name(address);
  }
  std::vector<std::string_view> output_areas() const override { return {"P", "Q", "U"}; }

  Status check_table(const nlohmann::json& facts) const override {
    if (facts.contains("p2p")) return check_p2p_fact(facts);
    const PlcModel* model = plc::find_plc_model(facts.value("model", ""));
    const std::string letter = facts.value("area", "");
    if (!model || letter.size() != 1)
      return fail("a fact has model (" + plc::plc_model_names() + ") and area (one letter)");
    const plc::DeviceArea* area = model->area(letter[0]);
    const std::uint32_t words = area ? area->words : 0;
    if (const std::uint32_t due = facts.value("words", words); due != words)
      return fail(fmt::format("{} of {}: the table has {} words, the manual {}", letter,
                              model->name, words, due));
    if (area && facts.value("write", area->write) != area->write)
      return fail(fmt::format("{} of {}: the table has it {}", letter, model->name,
                              area->write ? "writable" : "read only"));
    for (const auto& [key, value] : facts.items())
      if (key != "model" && key != "area" && key != "words" && key != "write")
        return fail(fmt::format("unknown fact '{}'", key));
    return ok();
  }
};

}  // namespace

const harness::Protocol& protocol() {
  static const XgtCnet xgt_cnet;
  return xgt_cnet;
}

}  // namespace fieldproof::xgt_cnet_suite
