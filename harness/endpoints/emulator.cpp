#include "harness/endpoints/emulator.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

#include "harness/monitored_device.hpp"
#include "harness/protocols.hpp"
#include "src/base/nesting.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::endpoints {

using line::LineSettings;

using nlohmann::json;

namespace {

Capabilities emulator_capabilities() {
  Capabilities capabilities;
  capabilities.simulated = capabilities.wire = capabilities.back_door =
      capabilities.can_power_cycle = capabilities.connections = capabilities.datagrams = true;
  return capabilities;
}

json option_value(const std::string& text) {
  if (!text.starts_with('[') && !text.starts_with('{')) return text;
  json value = json::parse(not_too_deep(text), nullptr, false);
  return value.is_discarded() ? json(text) : value;
}

json defaults_of(const EndpointName& name) {
  json defaults{{"station", 1}};
  for (const auto& [key, value] : name.options) {
    if (key != "protocol") defaults[key] = option_value(value);
  }
  return defaults;
}

/// Removes a key; null when it was not there.
json take(json& config, const char* key) {
  const auto found = config.find(key);
  if (found == config.end()) return nullptr;
  json value = std::move(*found);
  config.erase(found);
  return value;
}

Result<LineSettings> settings_of(const json& value, const char* key) {
  if (value.is_null()) return LineSettings{};
  if (!value.is_string())
    return fail(fmt::format("cannot set up the line: '{}' is {}; write text such as \"9600-8N1\"",
                            key, value.dump()));
  return line::parse_line_settings(value.get_ref<const std::string&>());
}

Result<LineSettings> line_of(const json& config) {
  const auto found = config.find("line");
  return settings_of(found == config.end() ? json() : *found, "line");
}

/// Configuration values may be booleans, numbers or text, as options are.
bool is_on(const json& config, const char* key) {
  const auto found = config.find(key);
  if (found == config.end()) return false;
  return *found == true || *found == 1 || *found == "true" || *found == "1";
}

std::string counted(int n, const char* what) {
  return fmt::format("{} {} error{}", n, what, n == 1 ? "" : "s");
}

Error before_begin(std::string_view what) {
  return fail(fmt::format("cannot {}: there is no device before a case begins", what));
}

}  // namespace

EmulatorEndpoint::EmulatorEndpoint(const EndpointName& name, DeviceFactory factory,
                                   Decorator decorate, std::uint16_t port)
    : model_(name.target),
      defaults_(defaults_of(name)),
      factory_(std::move(factory)),
      decorate_(std::move(decorate)),
      capabilities_(emulator_capabilities()),
      port_(port) {}

std::string EmulatorEndpoint::describe() const {
  return model_.empty() ? "emulator of the model of each case" : "emulator " + model_;
}

Status EmulatorEndpoint::begin(const json& given) {
  decorated_.reset();
  devices_.clear();
  json config = defaults_;
  if (given.is_object()) config.update(given);
  (void)take(config, "protocol");
  const json bench_line = take(config, "bench_line");
  const json neighbours = take(config, "neighbours");
  const json named = take(config, "model");
  const std::string model = !model_.empty()     ? model_
                            : named.is_string() ? named.get<std::string>()
                                                : std::string();

  const Result<LineSettings> bench =
      bench_line.is_null() ? line_of(config) : settings_of(bench_line, "bench_line");
  if (!bench) return bench.error();
  ways_.renew(*bench, is_on(config, "rs485") ? line::Duplex::half : line::Duplex::full);
  if (Status attached = attach(model, config); !attached) return attached;
  if (Status attached = attach_neighbours(model, neighbours, config); !attached) {
    devices_.clear();
    return attached;
  }
  return ok();
}

Status EmulatorEndpoint::attach(std::string_view model, const json& config) {
  const Result<LineSettings> settings = line_of(config);
  if (!settings) return settings.error();
  Result<std::unique_ptr<plc::EmulatedDevice>> device = factory_(model, config);
  if (!device) return device.error();
  const bool under_test = devices_.empty();
  line::Device* const line = (*device)->line();
  if (!line && !under_test)
    return fail("a device without a serial line has no place on the one of another");
  devices_.push_back(std::move(*device));
  if (net::Host* const host = under_test ? devices_.back()->network() : nullptr)
    ways_.attach(*host);
  if (line) attach_to_line(*line, *settings);
  return ok();
}

void EmulatorEndpoint::attach_to_line(line::Device& plain, const LineSettings& settings) {
  const bool under_test = devices_.size() == 1;
  if (under_test && decorate_) decorated_ = decorate_(plain, settings);
  ways_.line().attach(under_test && decorated_ ? *decorated_ : plain, settings);
}

Status EmulatorEndpoint::attach_neighbours(std::string_view model, const json& neighbours,
                                           const json& config) {
  if (neighbours.is_null()) return ok();
  if (!neighbours.is_array())
    return fail("cannot set up the line: 'neighbours' is " + neighbours.dump() +
                "; write an array of stations");
  for (const json& neighbour : neighbours) {
    json own = neighbour.is_object() ? neighbour : json{{"station", neighbour}};
    for (const char* key : {"line", "rs485"}) {
      if (config.contains(key) && !own.contains(key)) own[key] = config[key];
    }
    if (Status attached = attach(model, own); !attached)
      return fail("neighbour " + neighbour.dump() + ": " + attached.error().message);
  }
  return ok();
}

Result<LinkId> EmulatorEndpoint::open(Transport transport, std::uint16_t port) {
  if (devices_.empty()) return before_begin("open a link");
  net::SimulatedNetwork* const network = ways_.network();
  if (!network)
    return fail(fmt::format("cannot open a link: {} is on no network; it runs on a serial line",
                            describe()));
  if (port == 0) port = port_;
  refused_ = !devices_.front()->network()->listens(transport, port);
  return network->open(transport, port);
}

Result<LinkId> EmulatorEndpoint::open_line(unsigned channel) {
  if (devices_.empty()) return before_begin("open a line");
  line::Device* const line = devices_.front()->line(channel);
  if (!line)
    return fail(
        fmt::format("cannot open a line: channel {} of {} has no service", channel, describe()));
  return ways_.add_line(*line, LineSettings{});
}

Status EmulatorEndpoint::close(LinkId link, Closing how) {
  if (devices_.empty()) return before_begin("close a link");
  if (net::SimulatedNetwork* const network = ways_.network()) return network->close(link, how);
  return Endpoint::close(link, how);
}

Result<Sent> EmulatorEndpoint::send(ByteView bytes, LinkId link) {
  if (devices_.empty()) return before_begin("send");
  return ways_.send(bytes, link);
}

Result<Burst> EmulatorEndpoint::receive(Time deadline) {
  if (devices_.empty()) return before_begin("receive");
  return ways_.receive(deadline);
}

Status EmulatorEndpoint::set(std::string_view address, std::string_view hex) {
  if (devices_.empty()) return before_begin(fmt::format("set {}", address));
  return devices_.front()->set(address, hex);
}

Result<std::string> EmulatorEndpoint::get(std::string_view address, std::size_t digits) {
  if (devices_.empty()) return before_begin(fmt::format("look at {}", address));
  return devices_.front()->get(address, digits);
}

Status EmulatorEndpoint::act(std::string_view action) {
  if (devices_.empty()) return before_begin(fmt::format("do {}", action));
  return devices_.front()->act(action);
}

Trace EmulatorEndpoint::trace() const {
  return devices_.empty() ? Trace() : devices_.front()->trace();
}

std::string EmulatorEndpoint::line_errors() {
  const line::LineErrors errors = ways_.line().take_errors();
  std::string text;
  if (errors.parity) text = counted(errors.parity, "parity");
  if (errors.framing) text += (text.empty() ? "" : ", ") + counted(errors.framing, "framing");
  return text;
}

Result<std::unique_ptr<Endpoint>> open_emulator(const EndpointName& name,
                                                const harness::Protocol& protocol) {
  auto endpoint = std::make_unique<EmulatorEndpoint>(
      name,
      [&protocol](std::string_view model, const json& config) {
        return harness::make_monitored_device(
            protocol, model.empty() ? protocol.models().front() : model, config);
      },
      Decorator{}, protocol.default_port());
  if (const Status begun = endpoint->begin(json::object()); !begun) {
    return fail(
        fmt::format("cannot open {}:{}: {}", name.kind, name.target, begun.error().message));
  }
  return Result<std::unique_ptr<Endpoint>>(std::move(endpoint));
}

}  // namespace fieldproof::endpoints
