#include "src/p2p/p2p_plc.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "src/base/spelling.hpp"

namespace fieldproof::p2p {

namespace {
constexpr unsigned longest_time_out = 50;  // Cnet EN figure 4.3.1: (0-50)(*100ms)
}

P2pPlc::P2pPlc(const plc::PlcModel& model, const P2pParameters& parameters, bool run)
    : memory_(model), run_(run), link_(parameters.link) {
  write_p2p_registers(memory_, parameters);
}

Status P2pPlc::set(std::string_view address, std::string_view hex) {
  const Status status = plc::set_by_name(memory_, address, hex);
  if (status) scan();
  return status;
}

Result<std::string> P2pPlc::get(std::string_view address, std::size_t digits) const {
  if (address.starts_with('@')) return plc::get_counter(line_->counters(), address, digits);
  return plc::get_by_name(memory_, address, digits);
}

Status P2pPlc::act(std::string_view action) {
  if (action == "power_cycle") {
    for (const auto& channel : channels_) channel->power_cycle();
  } else if (action == "run" || action == "stop") {
    run_ = action == "run";
  } else if (action == "link on" || action == "link off") {
    link_ = action == "link on";
  } else {
    constexpr std::array<std::string_view, 5> names{"run", "stop", "power_cycle", "link on",
                                                    "link off"};
    return fail(fmt::format("cannot do '{}': there is no such action; use one of {}{}", action,
                            fmt::join(names, ", "), suggestion(action, names)));
  }
  update_mode();
  return ok();
}

void P2pPlc::update_mode() {
  for (const auto& channel : channels_) channel->set_active(run_ && link_);
}

void P2pPlc::scan() {
  for (const auto& channel : channels_) channel->scan();
}

bool is_p2p_client(const nlohmann::json& config) {
  return config.is_object() && config.contains("role") && config["role"] == "client";
}

Result<std::unique_ptr<P2pPlc>> make_p2p_plc(std::string_view model, const nlohmann::json& config,
                                             const P2pDriverFactory& driver,
                                             std::initializer_list<std::string_view> own_keys) {
  constexpr std::string_view what = "the P2P client's configuration";
  std::vector<std::string_view> keys = plc::port_keys(own_keys);
  keys.insert(keys.end(), {"p2p", "time_out"});
  if (const Status status = plc::known_keys(config, what, keys); !status) return status.error();
  plc::PortConfig port;
  port.model = model;
  unsigned time_out = 1;
  plc::ConfigReader reader(config, std::string(what));
  plc::read_port_config(reader, port);
  reader.whole("time_out", longest_time_out, time_out);
  if (reader.error()) return *reader.error();
  const Result<const plc::PlcModel*> known = plc::check_port_config(port);
  if (!known) return known.error();
  if (!config.contains("p2p"))
    return fail("cannot make a P2P client: there is no p2p; give its blocks, or role server");
  const Result<P2pParameters> parameters = parse_p2p_parameters(config["p2p"], **known);
  if (!parameters) return parameters.error();

  std::unique_ptr<P2pPlc> plc(new P2pPlc(**known, *parameters, port.run));
  const P2pClient::Timing timing{100ms * (time_out + 1), port.reply_delay(),
                                 port.line.character_time()};
  for (unsigned channel = 1; channel <= plc->channels_.size(); ++channel) {
    std::unique_ptr<P2pDriver> own = driver(port);
    if (const Status status = check_p2p_driver(*parameters, channel, *own, **known); !status)
      return status.error();
    plc->channels_[channel - 1] =
        std::make_unique<P2pClient>(plc->memory_, *parameters, channel, std::move(own), timing,
                                    [plc = plc.get()] { plc->scan(); });
  }
  plc->line_ = plc->channels_[parameters->channel - 1].get();
  plc->update_mode();
  return plc;
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_p2p_device(
    std::string_view model, const nlohmann::json& config, const P2pDriverFactory& driver,
    std::initializer_list<std::string_view> own_keys) {
  Result<std::unique_ptr<P2pPlc>> plc = make_p2p_plc(model, config, driver, own_keys);
  if (!plc) return plc.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::move(*plc));
}

}  // namespace fieldproof::p2p
