#include "suites/modbus/protocol.hpp"
#include "suites/checks/checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "harness/plc_protocol.hpp"
#include "src/base/letters.hpp"
#include "src/base/spelling.hpp"
#include "src/email/email_plc.hpp"
#include "src/modbus/modbus_plc.hpp"
#include "src/modbus/p2p_driver.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/plc/model.hpp"
#include "src/xnet/plc.hpp"
#include "src/xnet_motion/axis_registers.hpp"
#include "src/xnet_network/configuration.hpp"
#include "src/xnet_network/served_plc.hpp"
#include "suites/modbus/facts.hpp"
#include "suites/modbus/framing.hpp"
#include "suites/modbus/functions.hpp"
#include "suites/modbus/memory_requests.hpp"
#include "suites/modbus/message.hpp"
#include "suites/modbus/placing.hpp"
#include "suites/modbus/xinje_objects.hpp"
#include "suites/services/clients.hpp"
#include "suites/services/services.hpp"

namespace fieldproof::modbus_suite {

using harness::Protocol;

namespace {

/// XINJE PLCs have no Modbus ASCII.
Error unknown_model(std::string_view model, modbus::ModbusMode mode) {
  std::vector<std::string_view> names;
  for (const plc::PlcModel& one : plc::plc_models()) names.push_back(one.name);
  if (mode != modbus::ModbusMode::ascii) {
    if (mode == modbus::ModbusMode::tcp) names.push_back(xnet::xd);
    for (const xnet::Model& one : xnet::models()) names.push_back(one.name);
  }
  return fail(fmt::format("there is no model '{}'; use one of {}{}", model, fmt::join(names, ", "),
                          suggestion(model, names)));
}

class Modbus : public harness::PlcProtocol,
               public harness::Probing,
               public harness::MemoryRequests,
               public harness::Tables {
 public:
  Modbus(modbus::ModbusMode mode, const Framing& framing, Bases bases = default_bases())
      : PlcProtocol(bases.model), mode_(mode), framing_(framing), bases_(std::move(bases)) {}

  std::string_view name() const override { return framing_.protocol_name(); }

  std::vector<std::string> models() const override {
    std::vector<std::string> names = PlcProtocol::models();
    if (mode_ == modbus::ModbusMode::tcp) names.emplace_back(xnet::xd);
    return names;
  }
  std::uint16_t default_port() const override { return mode_ == modbus::ModbusMode::tcp ? 502 : 0; }

  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const override {
    if (has_model(model) && model == xnet::xd) return xnet::make_xinje_plc(mode_, config);
    if (xnet::find_model(model) && mode_ != modbus::ModbusMode::ascii)
      return xnet::make_served_plc(mode_, model, config);
    if (!model.empty() && !plc::find_plc_model(model)) return unknown_model(model, mode_);
    return services::make_plc(model, config, [this](plc::Plc& plc, const nlohmann::json& own) {
      return p2p::is_p2p_client(own) ? add_clients(plc, own)
                                     : modbus::add_modbus_server(plc, mode_, 1, own);
    });
  }

  Bytes station_bytes(int station) const override { return framing_.station_bytes(station); }
  /// Of all framings: a case may send a frame of another one.
  notation::Checks checks() const override {
    static const std::array all{checks::crc, checks::lrc, checks::length};
    return all;
  }
  bool is_text() const override { return framing_.dressing().digits; }
  const notation::Dressing* dressing() const override { return &framing_.dressing(); }
  /// 256 bytes (Cnet EN 9.3.2), each in two characters where it is text, and start and end.
  std::size_t longest_frame() const override { return is_text() ? 520 : 264; }
  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    return framing_.frame_length(bytes);
  }
  std::vector<harness::Field> explain(ByteView frame) const override {
    return framing_.explain(frame, Way::unknown);
  }
  std::vector<harness::Field> explain_as(ByteView frame, bool request) const override {
    return framing_.explain(frame, request ? Way::request : Way::reply);
  }
  /// A write of one bit or word (Cnet EN 9.4.5, 9.4.6).
  bool reply_repeats(ByteView request) const override {
    const Bytes message = framing_.unwrap(request);
    const FunctionCode* function = message.size() > 1 ? find_function(message[1]) : nullptr;
    return function && function->write && !function->many;
  }
  /// Nothing says in which case the digits of ASCII are written; the LRC is that of the bytes.
  Bytes in_plain_letters(ByteView request) const override {
    Bytes plain(request.begin(), request.end());
    if (is_text())
      for (Byte& b : plain) b = static_cast<Byte>(upper(static_cast<char>(b)));
    return plain;
  }
  plc::FrameResult monitor_result(ByteView frame, bool client, bool sent) const override {
    const bool request = client == sent;
    if (!harness::faultless(explain(frame)) || !can_be(framing_.unwrap(frame), request))
      return plc::unknown_frame;
    return client ? plc::FrameResult{4, "Modbus client"} : plc::FrameResult{3, "Modbus server"};
  }
  Duration frame_gap(Duration character_time) const override {
    return framing_.frame_gap(character_time);
  }

  const harness::Probing* probing() const override { return this; }
  const harness::MemoryRequests* memory() const override { return this; }
  const harness::Tables* tables() const override { return this; }

  /// One element at data address 0, which every model has, by a function code that was not tested:
  /// a reply or an exception to the tested frame carries another one.
  Bytes probing_request(int station, ByteView tested) const override {
    constexpr std::array<Byte, 4> reads{0x03, 0x01, 0x04, 0x02};
    const std::vector<Bytes> messages = framing_.messages(tested);
    const auto was_tested = [&](Byte function) {
      return std::ranges::any_of(messages, [function](const Bytes& message) {
        return message.size() > 1 && (message[1] & ~exception_bit) == function;
      });
    };
    const auto free = std::ranges::find_if_not(reads, was_tested);
    return framing_.wrap(
        Bytes{static_cast<Byte>(station), free == reads.end() ? reads.front() : *free, 0, 0, 0, 1});
  }

  std::vector<harness::ReadLimit> read_limits() const override {
    const auto read = [this](Byte function) {
      return [this, function](unsigned count) {
        return framing_.wrap(
            Bytes{1, function, 0, 0, static_cast<Byte>(count >> 8), static_cast<Byte>(count)});
      };
    };
    return {{"words of a read (03)", 125, 127, read(0x03)},
            {"bits of a read (01)", 2000, 2040, read(0x01)}};
  }

  bool answers_probe(ByteView probe, ByteView reply) const override {
    const Bytes asked = framing_.unwrap(probe), answer = framing_.unwrap(reply);
    return answer.size() > 1 && asked.size() > 1 && (answer[1] & ~exception_bit) == asked[1];
  }

  Result<std::vector<Bytes>> requests_to_write(int station, std::string_view address,
                                               std::string_view hex) const override {
    return modbus_suite::write_requests(framing_, bases_, station, address, hex);
  }
  Result<std::vector<Bytes>> requests_to_read(int station, std::string_view address,
                                              std::size_t digits) const override {
    return modbus_suite::read_requests(framing_, bases_, station, address, digits);
  }
  Status acknowledged(ByteView reply) const override {
    return modbus_suite::write_reply(framing_, reply);
  }
  Result<std::string> digits_in(ByteView reply) const override {
    return modbus_suite::read_reply(framing_, reply);
  }
  bool answers(ByteView request, ByteView reply) const override {
    return modbus_suite::answers(framing_, request, reply);
  }
  bool is_checked(ByteView) const override { return framing_.has_check(); }
  std::vector<Written> written_by(ByteView request) const override {
    return modbus_suite::written_by(framing_, bases_, request);
  }

  Result<std::unique_ptr<Protocol>> configured(std::string_view model,
                                               const nlohmann::json& config) const override;
  nlohmann::json defaults(std::string_view model) const override {
    return default_base_config(model);
  }
  bool same_setting(std::string_view model, const std::string& key, const std::string& one,
                    const std::string& other) const override {
    return modbus_suite::same_setting(model, key, one, other);
  }
  Result<Placed> placed(std::string_view address, std::string_view hex,
                        const std::vector<Bytes>& requests) const override {
    return modbus_suite::placed(framing_, bases_, address, hex, requests);
  }
  std::string tied_to_default(const std::vector<Bytes>& requests) const override {
    return modbus_suite::tied_to_default(framing_, bases_, requests);
  }
  std::vector<Place> places(const Written& written) const override {
    return modbus_suite::places(bases_, written);
  }
  std::vector<AddressField> address_fields(ByteView frame, bool reply) const override {
    return modbus_suite::address_fields(framing_, bases_, frame, reply);
  }
  std::optional<Bytes> moved_field(ByteView frame, const AddressField& field,
                                   int words) const override {
    return modbus_suite::moved_field(framing_, bases_, frame, field, words);
  }

  std::vector<std::string_view> output_areas() const override { return {"P", "Q", "U"}; }

  /// What the default base of the holding registers reaches.
  std::vector<Area> areas() const override { return {{"M", plc::last_words_of('M')}}; }

  Status check_table(const nlohmann::json& facts) const override {
    return modbus_suite::check_fact(facts);
  }

 private:
  Status add_clients(plc::Plc& plc, const nlohmann::json& config) const {
    if (mode_ == modbus::ModbusMode::tcp) {
      const Status added = p2p::add_network_clients(plc, config, services::client_drivers(name()));
      return added ? email::add_email(plc, config) : added;
    }
    return p2p::add_p2p_clients(plc, config, [mode = mode_](const plc::PortConfig& port) {
      return modbus::make_modbus_p2p_driver(mode, port.gap());
    });
  }

  modbus::ModbusMode mode_;
  const Framing& framing_;
  Bases bases_;
};

/// Of a XINJE PLC: no base moves its objects, and writing some of them moves axes.
class XinjeModbus : public Modbus {
 public:
  XinjeModbus(modbus::ModbusMode mode, const Framing& framing, std::string_view model)
      : Modbus(mode, framing), objects_(framing, model) {}

  Result<std::vector<Bytes>> requests_to_write(int station, std::string_view address,
                                               std::string_view hex) const override {
    return objects_.write_requests(station, address, hex);
  }
  Result<std::vector<Bytes>> requests_to_read(int station, std::string_view address,
                                              std::size_t digits) const override {
    return objects_.read_requests(station, address, digits);
  }
  Result<std::string> digits_in(ByteView reply) const override { return objects_.digits_in(reply); }
  std::vector<Written> written_by(ByteView request) const override {
    return objects_.written_by(request);
  }
  std::optional<WordName> read_word(std::string_view text) const override {
    return read_xinje_word(text);
  }
  std::string spell(std::string_view area, std::uint32_t word) const override {
    return spell_xinje(area, word);
  }
  std::vector<Place> places(const Written& written) const override {
    return objects_.places(written);
  }
  std::optional<Written> named(std::string_view address, std::size_t digits) const override {
    return objects_.named(address, digits);
  }
  /// No case of it is moved to other objects.
  std::optional<std::string> moved(std::string_view, int) const override { return std::nullopt; }
  std::vector<AddressField> address_fields(ByteView, bool) const override { return {}; }
  std::optional<Bytes> moved_field(ByteView, const AddressField&, int) const override {
    return std::nullopt;
  }
  Result<Placed> placed(std::string_view address, std::string_view hex,
                        const std::vector<Bytes>&) const override {
    return Placed{std::string(address), std::string(hex)};
  }
  std::string tied_to_default(const std::vector<Bytes>&) const override { return {}; }
  std::vector<std::string_view> output_areas() const override { return xinje_outputs(); }
  std::vector<Area> areas() const override { return {}; }
  std::uint32_t words_of(std::string_view area) const override { return objects_.words_of(area); }

  unsigned last_axis() const override { return xnet::last_axis; }
  std::string moved_by(std::string_view address) const override {
    const auto object = xnet::find_component(address, objects_.series());
    return object ? xinje_axis(*object) : "";
  }

 private:
  XinjeObjects objects_;
};

Result<std::unique_ptr<Protocol>> Modbus::configured(std::string_view model,
                                                     const nlohmann::json& config) const {
  if (is_xinje_model(model))
    return std::unique_ptr<Protocol>(std::make_unique<XinjeModbus>(mode_, framing_, model));
  if (!model.empty() && !plc::find_plc_model(model)) return unknown_model(model, mode_);
  Result<Bases> bases = declared_bases(model, config);
  if (!bases) return bases.error();
  return std::unique_ptr<Protocol>(std::make_unique<Modbus>(mode_, framing_, std::move(*bases)));
}

}  // namespace

const Protocol& rtu() {
  static const Modbus protocol(modbus::ModbusMode::rtu, rtu_framing());
  return protocol;
}

const Protocol& ascii() {
  static const Modbus protocol(modbus::ModbusMode::ascii, ascii_framing());
  return protocol;
}

const Protocol& tcp() {
  static const Modbus protocol(modbus::ModbusMode::tcp, tcp_framing());
  return protocol;
}

}  // namespace fieldproof::modbus_suite
