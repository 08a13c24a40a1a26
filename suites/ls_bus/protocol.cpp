#include "suites/ls_bus/protocol.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "src/ls_bus/inverter.hpp"
#include "src/ls_bus/p2p_driver.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/plc/config_reader.hpp"
#include "suites/checks/checks.hpp"
#include "suites/ls_bus/facts.hpp"
#include "suites/ls_bus/frame_parts.hpp"
#include "suites/ls_bus/memory_requests.hpp"

namespace fieldproof::ls_bus_suite {

using harness::Protocol;

namespace {

constexpr std::size_t command_at = 3, count_at = 8;

std::string station_text(int station) { return hex_number(static_cast<unsigned>(station), 2); }

/// Would a reply to this request have one word of data?
bool reads_one_word(ByteView request) {
  const auto behind_header = std::find(request.rbegin(), request.rend(), enq).base();
  const ByteView frame =
      behind_header == request.begin() ? request : ByteView(behind_header - 1, request.end());
  return frame.size() > count_at && frame[command_at] == 'R' && frame[count_at] == '1';
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_client(std::string_view model,
                                                         const nlohmann::json& config) {
  bool address_first = true;
  plc::ConfigReader reader(config, "the LS Bus client's configuration");
  reader.either("write_order", "address_first", "count_first", address_first);
  if (reader.error()) return *reader.error();
  const ls_bus::LsWriteOrder order =
      address_first ? ls_bus::LsWriteOrder::address_first : ls_bus::LsWriteOrder::count_first;
  return p2p::make_p2p_device(model, config,
                              [order](const plc::PortConfig& port) {
                                return ls_bus::make_ls_bus_p2p_driver(order, port.gap());
                              },
                              {"write_order"});
}

class LsBus : public Protocol,
              public harness::Probing,
              public harness::MemoryRequests,
              public harness::Tables {
 public:
  /// `count_first`: the order of writes that a device declares; nothing: it declares none.
  explicit LsBus(std::optional<bool> count_first = {})
      : order_(count_first), count_first_(count_first.value_or(false)) {}

  std::string_view name() const override { return "ls-bus"; }
  std::vector<std::string> models() const override { return {"inverter"}; }

  /// In role client the device is the PLC that asks the inverter.
  bool has_model(std::string_view model) const override {
    return Protocol::has_model(model) || plc::find_plc_model(model);
  }

  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const override {
    if (!has_model(model))
      return fail(fmt::format(
          "cannot make a device '{}': the LS Bus has the inverter, and in role client {}", model,
          plc::plc_model_names()));
    if (p2p::is_p2p_client(config))
      return make_client(plc::find_plc_model(model) ? model : plc::plc_models().front().name,
                         config);
    if (plc::find_plc_model(model))
      return fail(
          fmt::format("cannot make {} an LS Bus server: a PLC is its client; set role client, or "
                      "use the inverter",
                      model));
    return ls_bus::make_inverter(config);
  }

  notation::Checks checks() const override { return {&checks::sum, 1}; }
  Bytes station_bytes(int station) const override { return to_bytes(station_text(station)); }
  /// Eight words in twice the digits, for what is wrong with it.
  std::size_t longest_frame() const override { return 96; }
  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    return ls_bus_suite::frame_length(bytes);
  }
  std::vector<harness::Field> explain(ByteView frame) const override {
    return ls_bus_suite::explain(frame);
  }
  Bytes in_plain_letters(ByteView request) const override {
    return ls_bus_suite::in_plain_letters(request);
  }
  /// The manual's list knows no LS Bus: 7 is this project's.
  plc::FrameResult monitor_result(ByteView frame, bool client, bool sent) const override {
    const bool request = !frame.empty() && frame[0] == enq;
    return request == (client == sent) && harness::faultless(explain(frame))
               ? plc::FrameResult{7, "LS Bus"}
               : plc::unknown_frame;
  }

  const harness::Probing* probing() const override { return this; }
  const harness::MemoryRequests* memory() const override { return this; }
  const harness::Tables* tables() const override { return this; }

  /// Parameter 0000, which inverters have for their model: one word, or two where the tested
  /// request reads one. So no reply to the tested request has its length and its command.
  Bytes probing_request(int station, ByteView tested) const override {
    return request(fmt::format("{}R0000{}", station_text(station), reads_one_word(tested) ? 2 : 1));
  }

  bool answers_probe(ByteView probe, ByteView reply) const override {
    const std::size_t words = probe[count_at] == '2' ? 2 : 1;
    return reply.size() == command_at + 1 + 4 * words + 3 && reply[0] == ack &&
           reply[command_at] == 'R';
  }

  Result<std::vector<Bytes>> requests_to_write(int station, std::string_view address,
                                               std::string_view hex) const override {
    return ls_bus_suite::write_requests(station_text(station), address, hex, count_first_);
  }
  Result<std::vector<Bytes>> requests_to_read(int station, std::string_view address,
                                              std::size_t digits) const override {
    return ls_bus_suite::read_requests(station_text(station), address, digits);
  }
  Status acknowledged(ByteView reply) const override { return ls_bus_suite::write_reply(reply); }
  Result<std::string> digits_in(ByteView reply) const override {
    return ls_bus_suite::read_reply(reply);
  }
  bool answers(ByteView request, ByteView reply) const override {
    return ls_bus_suite::answers(request, reply);
  }
  std::vector<Written> written_by(ByteView request) const override {
    return ls_bus_suite::written_by(request, order_);
  }

  Result<std::unique_ptr<Protocol>> configured(std::string_view,
                                               const nlohmann::json& config) const override {
    bool address_first = true;
    plc::ConfigReader reader(config, "the inverter's configuration");
    reader.either("write_order", "address_first", "count_first", address_first);
    if (reader.error()) return *reader.error();
    const bool declared = config.contains("write_order");
    return std::unique_ptr<Protocol>(
        std::make_unique<LsBus>(declared ? std::optional(!address_first) : std::nullopt));
  }
  /// "h1230", "1230", or "h": all of them.
  std::optional<WordName> read_word(std::string_view text) const override {
    const bool marked = text.starts_with('h') || text.starts_with('H');
    const std::string_view number = text.substr(marked ? 1 : 0);
    if (marked && number.empty()) return WordName{std::string(parameter_area), {}};
    const std::optional<Bytes> word = from_hex(number);
    if (number.size() != 4 || !word || word->size() != 2) return std::nullopt;
    return WordName{std::string(parameter_area), (*word)[0] * 256u + (*word)[1]};
  }
  std::string spell(std::string_view, std::uint32_t word) const override {
    return "h" + hex_number(word, 4);
  }
  std::vector<Place> places(const Written& written) const override {
    return ls_bus_suite::places(written);
  }
  std::optional<Written> named(std::string_view address, std::size_t digits) const override {
    return ls_bus_suite::named(address, digits);
  }
  std::optional<std::string> moved(std::string_view address, int words) const override {
    return ls_bus_suite::moved(address, words);
  }
  std::vector<AddressField> address_fields(ByteView frame, bool reply) const override {
    return reply ? std::vector<AddressField>() : ls_bus_suite::address_fields(frame, count_first_);
  }
  /// A parameter may be the run command: a motor turns.
  std::vector<std::string_view> output_areas() const override { return {parameter_area}; }

  Status check_table(const nlohmann::json& facts) const override {
    return ls_bus_suite::check_fact(facts);
  }

 private:
  std::optional<bool> order_;
  bool count_first_;
};

}  // namespace

const Protocol& protocol() {
  static const LsBus ls_bus;
  return ls_bus;
}

}  // namespace fieldproof::ls_bus_suite
