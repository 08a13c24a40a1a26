#include "suites/faults/kits.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "src/xgt_cnet/plc_config.hpp"
#include "suites/broken/run_in_process.hpp"
#include "suites/email/broken/faults.hpp"
#include "suites/hs_link/broken/broken_network.hpp"
#include "suites/ls_bus/broken/broken_inverter.hpp"
#include "suites/ls_bus/broken/faults.hpp"
#include "suites/modbus/broken/broken_server.hpp"
#include "suites/modbus/broken/faults.hpp"
#include "suites/modbus/tcp_broken/broken_server.hpp"
#include "suites/p2p/broken/faults.hpp"
#include "suites/protocols.hpp"
#include "suites/services/broken/faults.hpp"
#include "suites/user_frames/broken/faults.hpp"
#include "suites/xgt_cnet/broken/broken_server.hpp"
#include "suites/xgt_fenet/broken/broken_server.hpp"
#include "suites/xgt_fenet/broken/faults.hpp"
#include "suites/xnet/broken/broken_xnet.hpp"

namespace fieldproof::faults {

namespace {

using nlohmann::json;
using vectors::Case;
using Device = Result<std::unique_ptr<plc::EmulatedDevice>>;

constexpr const char* healthy = "none";

/// A server of the protocol alone: no client, no other service of the PLC, no frame monitor.
bool is_server_case(const Case& one) {
  return !vectors::is_client_case(one) && !one.config.contains("services") &&
         !one.config.value("monitor", false);
}

/// The model that most cases run on, where the case allows it.
std::string model_of(const Case& one, const std::string& usual) {
  const bool any = one.models.empty() || std::ranges::find(one.models, usual) != one.models.end();
  return any ? usual : one.models.front();
}

results::CaseResult run(const Case& source, const std::string& model,
                        endpoints::DeviceFactory make) {
  return broken::run_in_process(source, model, std::move(make), broken::bare_profile(source));
}

/// What sends without end, so that simulated time never gets past it: `floods` is met over a port
/// (suites/xgt_cnet/broken), `send_on_level` by its own case alone (suites/p2p/broken).
bool ends(std::string_view fault) { return fault != "floods" && fault != "send_on_level"; }

template <typename Table>
std::vector<KnownFault> names(const Table& table, const std::string& prefix = "",
                              const std::string& only = "") {
  std::vector<KnownFault> result;
  for (const auto& one : table)
    if (one.caught_by.starts_with(only) && ends(one.name))
      result.push_back({std::string(one.name), prefix + std::string(one.caught_by)});
  return result;
}

std::string name_of(const std::vector<KnownFault>& table, std::optional<std::size_t> fault) {
  return fault ? table[*fault].name : healthy;
}

/// A device that is made by the name of its fault.
Kit by_name(
    std::string name, std::string folder, std::string usual, std::vector<KnownFault> table,
    std::function<Device(const std::string& fault, std::string_view model, const json&)> make) {
  const auto run_one = [=](std::optional<std::size_t> fault, const Case& source) {
    return run(source, model_of(source, usual), [=](std::string_view model, const json& config) {
      return make(name_of(table, fault), model, config);
    });
  };
  return {std::move(name), std::move(folder), table, is_server_case, run_one};
}

Kit xgt_server() {
  const auto make = [](const std::string& fault, std::string_view model,
                       const json& config) -> Device {
    static std::vector<std::unique_ptr<xgt_cnet_broken::Storage>> kept;
    kept.clear();  // one device lives at a time
    kept.push_back(std::make_unique<xgt_cnet_broken::Storage>());
    const Result<plc::PortConfig> parsed = xgt_cnet::parse_plc_config(std::string(model), config);
    if (!parsed) return parsed.error();
    return xgt_cnet_broken::make_broken_plc(fault, *parsed, *kept.back());
  };
  return by_name("xgt-cnet", "xgt_cnet", "xbc-h", names(xgt_cnet_broken::faults(), "xgt_cnet/"),
                 make);
}

Kit modbus_server(const std::string& mode) {
  const std::string folder = "modbus_" + mode;
  const auto make = [=](const std::string& fault, std::string_view model, json config) {
    config["model"] = model;
    return modbus_broken::make_broken_server(mode, fault, config);
  };
  return by_name("modbus-" + mode, folder, "xbc-h", names(modbus_broken::faults(), "", folder),
                 make);
}

Kit inverter() {
  std::vector<KnownFault> table = names(ls_bus_broken::faults(), "ls_bus/");
  std::ranges::move(names(ls_bus_broken::back_door_faults(), "ls_bus/"), std::back_inserter(table));
  return by_name("ls-bus", "ls_bus", "inverter", std::move(table),
                 [](const std::string& fault, std::string_view, const json& config) {
                   return ls_bus_broken::make_broken_inverter(fault, config);
                 });
}

/// A device that is made by the behaviour of its fault; without one it does the right thing.
template <typename Fault, typename Behaviour>
Kit by_behaviour(std::string name, std::string folder, const std::vector<Fault>& table,
                 Device (*make)(const Behaviour&, std::string_view model, const json&),
                 const std::string& usual = "xbc-h") {
  const auto run_one = [&table, make, usual](std::optional<std::size_t> fault, const Case& source) {
    const Behaviour behaviour = fault ? table[*fault].make() : Behaviour{};
    return run(source, model_of(source, usual), [=](std::string_view model, const json& config) {
      return make(behaviour, model, config);
    });
  };
  return {std::move(name), std::move(folder), names(table), is_server_case, run_one};
}

Kit user_frames_port() {
  const auto run_one = [](std::optional<std::size_t> fault, const Case& source) {
    const auto behaviour =
        fault ? user_frames_broken::faults()[*fault].make : user_frames_broken::Behaviour{};
    return run(source, "", [=](std::string_view model, const json& config) {
      return user_frames_broken::make_broken_port(behaviour, model, config);
    });
  };
  const auto concerns = [](const Case& one) { return !one.config.contains("p2p"); };
  return {"user-frames", "user_frames", names(user_frames_broken::faults()), concerns, run_one};
}

Kit user_frames_server() {
  const auto run_one = [](std::optional<std::size_t> fault, const Case& source) {
    const auto behaviour =
        fault ? user_frames_broken::server_faults()[*fault].make : user_frames_broken::Behaviour{};
    return run(source, "", [=](std::string_view model, const json& config) {
      return user_frames_broken::make_broken_server(behaviour, model, config);
    });
  };
  return {"user-frames-net", "user_frames_net", names(user_frames_broken::server_faults()),
          is_server_case, run_one};
}

/// A PLC around its services, of any protocol.
Kit whole_plc() {
  const std::vector<services_broken::Fault>& table = services_broken::faults();
  const auto run_one = [&table](std::optional<std::size_t> fault, const Case& source) {
    const auto behaviour = fault ? table[*fault].make() : services_broken::Behaviour{};
    const harness::Protocol& protocol = *suites::protocols().find(source.protocol);
    return run(services_broken::set_up(behaviour, source), "",
               [&](std::string_view model, const json& config) {
                 return services_broken::make_broken_plc(behaviour, protocol, model, config);
               });
  };
  return {"plc", "*", names(table), services_broken::concerns, run_one};
}

/// A module that mails: each of its cases is one of a client.
Kit mailing_module() {
  const std::vector<email_broken::Fault>& table = email_broken::faults();
  const auto run_one = [&table](std::optional<std::size_t> fault, const Case& source) {
    const auto behaviour = fault ? table[*fault].make() : email_broken::Behaviour{};
    return run(source, model_of(source, "xbc-h"), [=](std::string_view model, const json& config) {
      return email_broken::make_broken_module(behaviour, model, config);
    });
  };
  return {"email", "email", names(table), [](const Case&) { return true; }, run_one};
}

/// Clients, and the port with UDATA instructions.
Kit client(const std::string& name, const std::string& folder) {
  std::vector<const p2p_broken::Fault*> own;
  for (const p2p_broken::Fault& one : p2p_broken::faults())
    if (one.caught_by.starts_with(folder + "/") && ends(one.name)) own.push_back(&one);
  const bool any_model = folder.starts_with("user_frames");
  const auto run_one = [=](std::optional<std::size_t> fault, const Case& source) {
    const auto behaviour = fault ? own[*fault]->make() : p2p_broken::Behaviour{};
    return run(source, any_model ? "" : model_of(source, "xbc-h"),
               [=, &source](std::string_view model, const json& config) {
                 return p2p_broken::make_broken_client(behaviour, source.protocol, model, config);
               });
  };
  const auto concerns = [](const Case& one) {
    if (one.config.value("monitor", false)) return false;
    return one.protocol == "udata"
               ? one.config.contains("instructions")
               : vectors::is_client_case(one) && !one.config.contains("services");
  };
  return {name, folder, names(p2p_broken::faults(), "", folder + "/"), concerns, run_one};
}

}  // namespace

std::vector<Kit> kits() {
  return {xgt_server(),
          modbus_server("rtu"),
          modbus_server("ascii"),
          by_behaviour("modbus-tcp", "modbus_tcp", modbus_tcp_broken::faults(),
                       modbus_tcp_broken::make_broken_server),
          by_behaviour("xgt-fenet", "xgt_fenet", xgt_fenet_broken::faults(),
                       xgt_fenet_broken::make_broken_server),
          by_behaviour("xnet", "xnet", xnet_broken::faults(), xnet_broken::make_broken_xnet, "xd3"),
          by_behaviour("hs-link", "hs_link", hs_link_broken::faults(),
                       hs_link_broken::make_broken_network),
          inverter(),
          user_frames_port(),
          user_frames_server(),
          client("xgt-cnet client", "xgt_cnet"),
          client("modbus-rtu client", "modbus_rtu"),
          client("modbus-ascii client", "modbus_ascii"),
          client("ls-bus client", "ls_bus"),
          client("xgt-fenet client", "xgt_fenet"),
          client("modbus-tcp client", "modbus_tcp"),
          client("user-frames client", "user_frames"),
          client("user-frames-net client", "user_frames_net"),
          client("udata", "udata"),
          mailing_module(),
          whole_plc()};
}

}  // namespace fieldproof::faults
