#include "src/xnet_network/served_plc.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "src/xnet/plc.hpp"
#include "src/xnet_network/network.hpp"

namespace fieldproof::xnet {

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 6> keys_of_nets{"ip",     "ports",  "program",
                                                       "routes", "servos", "stations"};

std::optional<Time> earlier(std::optional<Time> a, std::optional<Time> b) {
  return a && b ? std::min(*a, *b) : (a ? a : b);
}

/// The nets run on the time of its server.
class ServedLine : public line::Device {
 public:
  ServedLine(line::Device& server, XnetNetwork& nets) : server_(server), nets_(nets) {}

  void receive(const Burst& burst) override { server_.receive(burst); }
  std::optional<Time> wake_at() const override {
    return earlier(server_.wake_at(), nets_.wake_at());
  }
  Bytes advance(Time now) override {
    nets_.advance(now);
    return server_.advance(now);
  }

 private:
  line::Device& server_;
  XnetNetwork& nets_;
};

class ServedHost : public net::Host {
 public:
  ServedHost(net::Host& server, XnetNetwork& nets) : server_(server), nets_(nets) {}

  bool listens(Transport transport, std::uint16_t port) const override {
    return server_.listens(transport, port);
  }
  void receive(const Burst& burst) override { server_.receive(burst); }
  std::optional<Time> wake_at() const override {
    return earlier(server_.wake_at(), nets_.wake_at());
  }
  std::vector<Burst> advance(Time now) override {
    nets_.advance(now);
    return server_.advance(now);
  }

 private:
  net::Host& server_;
  XnetNetwork& nets_;
};

class ServedPlc : public plc::Controller {
 public:
  ServedPlc(std::unique_ptr<XnetNetwork> nets, bool run)
      : Controller(run), nets_(std::move(nets)) {}

  Status serve(modbus::ModbusMode mode, const json& config) {
    const auto written = [this] { nets_->memory().touch(); };
    if (const Status added = add_modbus_server(*this, nets_->memory(), written, mode, 1, config);
        !added)
      return added;
    if (line::Device* const own = Controller::line()) line_.emplace(*own, *nets_);
    if (net::Host* const own = Controller::network()) host_.emplace(*own, *nets_);
    return ok();
  }

  line::Device* line(unsigned channel) override {
    return channel <= 1 && line_ ? &*line_ : nullptr;
  }
  net::Host* network() override { return host_ ? &*host_ : nullptr; }
  plc::BusEnd* bus_end() override { return nets_->bus_end(); }

  Status set(std::string_view address, std::string_view hex) override {
    return nets_->set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return nets_->get(address, digits);
  }
  /// Those of X-NET; its server is told what it knows of them.
  Status act(std::string_view action) override {
    const bool both = action == "run" || action == "stop" || action == "power_cycle";
    if (both)
      if (const Status done = Controller::act(action); !done) return done;
    return nets_->act(action);
  }

 private:
  std::unique_ptr<XnetNetwork> nets_;
  std::optional<ServedLine> line_;
  std::optional<ServedHost> host_;
};

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_served_plc(modbus::ModbusMode mode,
                                                             std::string_view model,
                                                             const json& config) {
  json nets = json::object(), server = json::object();
  for (const auto& [key, value] : config.items()) {
    const bool of_nets = std::ranges::count(keys_of_nets, key) > 0;
    (of_nets ? nets : server)[key] = value;
  }
  if (config.contains("mode")) nets["mode"] = config["mode"];
  Result<std::unique_ptr<XnetNetwork>> made = make_network(model, nets);
  if (!made) return made.error();
  auto plc = std::make_unique<ServedPlc>(std::move(*made), nets.value("mode", "run") != "stop");
  if (const Status served = plc->serve(mode, server); !served) return served.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::move(plc));
}

}  // namespace fieldproof::xnet
