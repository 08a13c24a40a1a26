#include "suites/xnet/over_modbus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "src/xnet/areas.hpp"
#include "suites/modbus/framing.hpp"
#include "suites/modbus/protocol.hpp"
#include "suites/modbus/xinje_objects.hpp"
#include "suites/xnet/axes.hpp"
#include "suites/xnet/ladder.hpp"
#include "suites/xnet/protocol.hpp"

namespace fieldproof::xnet_suite {

namespace {

using harness::Protocol;
using modbus_suite::Framing;
using xnet::Component;
using xnet::Series;

class OverModbus : public Protocol, public harness::Probing, public harness::MemoryRequests {
 public:
  OverModbus(const Protocol& carrier, const Framing& framing, Series series, Ladder ladder)
      : carrier_(carrier),
        framing_(framing),
        objects_(framing, series),
        ladder_(std::move(ladder)) {}

  std::string_view name() const override { return "xnet"; }
  std::vector<std::string> models() const override { return protocol().models(); }
  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const override {
    return carrier_.make_device(model, config);
  }
  std::uint16_t default_port() const override { return carrier_.default_port(); }
  Bytes station_bytes(int station) const override { return carrier_.station_bytes(station); }
  bool is_text() const override { return carrier_.is_text(); }
  notation::Checks checks() const override { return carrier_.checks(); }
  std::size_t longest_frame() const override { return carrier_.longest_frame(); }
  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    return carrier_.frame_length(bytes);
  }
  std::vector<harness::Field> explain(ByteView frame) const override {
    return carrier_.explain(frame);
  }
  Duration frame_gap(Duration character_time) const override {
    return carrier_.frame_gap(character_time);
  }

  const harness::Probing* probing() const override { return this; }
  const harness::MemoryRequests* memory() const override { return this; }
  const harness::Tables* tables() const override { return protocol().tables(); }
  Bytes probing_request(int station, ByteView tested) const override {
    return carrier_.probe(station, tested);
  }
  bool answers_probe(ByteView probe, ByteView reply) const override {
    return carrier_.is_reply_to_probe(probe, reply);
  }

  Result<std::unique_ptr<Protocol>> configured(std::string_view model,
                                               const nlohmann::json& config) const override {
    Result<Ladder> ladder = Ladder::read(config);
    if (!ladder) return ladder.error();
    const modbus_suite::XinjeObjects declared(framing_, model);
    return std::unique_ptr<Protocol>(
        std::make_unique<OverModbus>(carrier_, framing_, declared.series(), std::move(*ladder)));
  }

  Result<std::vector<Bytes>> requests_to_write(int station, std::string_view address,
                                               std::string_view hex) const override {
    return objects_.write_requests(station, address, hex);
  }
  Result<std::vector<Bytes>> requests_to_read(int station, std::string_view address,
                                              std::size_t digits) const override {
    return objects_.read_requests(station, address, digits);
  }
  Status acknowledged(ByteView reply) const override { return carrier_.write_reply(reply); }
  Result<std::string> digits_in(ByteView reply) const override { return objects_.digits_in(reply); }
  bool answers(ByteView request, ByteView reply) const override {
    return bool(carrier_.sound_reply(request, reply));
  }

  std::vector<Written> written_by(ByteView request) const override {
    return objects_.written_by(request);
  }
  std::optional<WordName> read_word(std::string_view text) const override {
    return protocol().read_word(text);
  }
  std::string spell(std::string_view area, std::uint32_t word) const override {
    return modbus_suite::spell_xinje(area, word);
  }
  std::vector<Place> places(const Written& written) const override {
    return objects_.places(written);
  }
  std::optional<Written> named(std::string_view address, std::size_t digits) const override {
    return objects_.named(address, digits);
  }
  std::vector<std::string_view> output_areas() const override { return protocol().output_areas(); }

  Result<std::vector<Setting>> set_off_by(std::string_view action) const override {
    return ladder_.set_off(action);
  }
  std::vector<Setting> written_by_action(std::string_view action) const override {
    return ladder_.written_by(action, objects_.series());
  }
  std::vector<Setting> premises(std::string_view axis) const override { return at_rest(axis); }
  std::vector<bool> of_a_moment(const std::vector<Look>& looks) const override {
    return looks_under_way(looks, objects_.series());
  }
  unsigned last_axis() const override { return protocol().last_axis(); }
  std::string moves(std::string_view action) const override { return axis_of_action(action); }
  std::string moved_by(std::string_view address) const override {
    const std::optional<Component> one = xnet::find_component(address, objects_.series());
    if (!one) return {};
    const std::string axis = modbus_suite::xinje_axis(*one);
    return axis.empty() ? ladder_.axis_behind(to_string(*one)) : axis;
  }

 private:
  const Protocol& carrier_;
  const Framing& framing_;
  modbus_suite::XinjeObjects objects_;
  Ladder ladder_;
};

}  // namespace

const Protocol& over_modbus_rtu() {
  static const OverModbus protocol(modbus_suite::rtu(), modbus_suite::rtu_framing(), Series::xd5,
                                   {});
  return protocol;
}

const Protocol& over_modbus_tcp() {
  static const OverModbus protocol(modbus_suite::tcp(), modbus_suite::tcp_framing(), Series::xd5,
                                   {});
  return protocol;
}

}  // namespace fieldproof::xnet_suite
