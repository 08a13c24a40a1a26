// emulator:MODEL: an emulated device in process, on simulated lines and a simulated network and in
// simulated time.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "harness/endpoints/endpoint.hpp"
#include "harness/endpoints/simulated_ways.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::endpoints {

/// Makes a device in its power-on state; `config` is `given.config` without what belongs to the
/// line and the endpoint (model, protocol, bench_line, neighbours).
using DeviceFactory = std::function<Result<std::unique_ptr<plc::EmulatedDevice>>(
    std::string_view model, const nlohmann::json& config)>;
/// Puts something between the line and the device, as FaultyDevice (src/line/faults.hpp). `device`
/// outlives it.
using Decorator = std::function<std::unique_ptr<line::Device>(line::Device& device,
                                                              const line::LineSettings& line)>;

class EmulatorEndpoint : public Endpoint {
 public:
  /// The target of `name` is the model; without one it is the key "model" of each case, or empty.
  /// Options are defaults for the keys of `given.config` and are overridden by it; "[...]" and
  /// "{...}" are read as JSON. `port`: which a link is opened to that names none.
  EmulatorEndpoint(const EndpointName& name, DeviceFactory factory, Decorator decorate = {},
                   std::uint16_t port = 0);

  const Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override;
  Time now() const override { return ways_.now(); }
  Duration character_time() const override {
    return ways_.line().bench_settings().character_time();
  }

  /// New devices on a new line and a new network; simulated time goes on. `line` is the device's
  /// setting, `bench_line` the bench's (the same when absent); `rs485` makes the line half duplex.
  /// `neighbours`: stations, or objects of config keys, of further devices of the same model on the
  /// same line. Errors name the key.
  Status begin(const nlohmann::json& config) override;
  Result<LinkId> open(Transport transport, std::uint16_t port) override;
  bool was_refused() const override { return refused_; }
  Result<LinkId> open_line(unsigned channel) override;
  Status close(LinkId link, Closing how) override;
  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId link) override;
  Result<Burst> receive(Time deadline) override;

  Status set(std::string_view address, std::string_view hex) override;
  Result<std::string> get(std::string_view address, std::size_t digits) override;
  Status act(std::string_view action) override;
  Trace trace() const override;
  /// "2 parity errors, 1 framing error" that the bench's receiver has counted.
  std::string line_errors() override;

 private:
  Status attach(std::string_view model, const nlohmann::json& config);
  void attach_to_line(line::Device& device, const line::LineSettings& settings);
  Status attach_neighbours(std::string_view model, const nlohmann::json& neighbours,
                           const nlohmann::json& config);

  std::string model_;        // empty: of each case
  nlohmann::json defaults_;  // the endpoint's options
  DeviceFactory factory_;
  Decorator decorate_;
  Capabilities capabilities_;
  std::uint16_t port_;
  bool refused_ = false;  // the last link that was opened
  SimulatedWays ways_;
  // The device under test, then its neighbours.
  std::vector<std::unique_ptr<plc::EmulatedDevice>> devices_;
  std::unique_ptr<line::Device> decorated_;
};

/// The protocol of option `protocol`, else the first that has the model, makes the devices. Opens
/// with a device of the options alone, so that a wrong model or option is reported at once.
Result<std::unique_ptr<Endpoint>> open_emulator(const EndpointName& name,
                                                const harness::Protocol& protocol);

}  // namespace fieldproof::endpoints
