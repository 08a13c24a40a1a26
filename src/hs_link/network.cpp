#include "src/hs_link/network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

#include "src/plc/config_reader.hpp"

namespace fieldproof::hs_link {

using nlohmann::json;

HsNetwork::HsNetwork(std::vector<std::unique_ptr<Station>> stations)
    : stations_(std::move(stations)) {
  show_flags();
}

std::optional<Time> HsNetwork::wake_at() const {
  std::optional<Time> first;
  for (const auto& station : stations_)
    if (const std::optional<Time> own = station->wake_at())
      first = std::min(first.value_or(Time::max()), *own);
  return first;
}

Bytes HsNetwork::advance(Time now) {
  now_ = now;
  exchange();
  return {};
}

/// What is sent at one moment is heard by all before anybody says how its own blocks fare.
void HsNetwork::exchange() {
  std::vector<std::pair<Station*, Broadcast>> sent;
  for (const auto& station : stations_)
    for (Broadcast& block : station->advance(now_))
      sent.emplace_back(station.get(), std::move(block));
  deliver(sent);
  for (const auto& [sender, block] : sent)
    for (const auto& other : stations_)
      if (other.get() != sender) other->count(block);
  for (auto& [sender, block] : sent) block.communicates = sender->communicates();
  deliver(sent);
  show_flags();
}

void HsNetwork::deliver(const std::vector<std::pair<Station*, Broadcast>>& sent) {
  for (const auto& [sender, block] : sent)
    for (const auto& other : stations_)
      if (other.get() != sender) other->hear(block, now_);
}

void HsNetwork::show_flags() {
  for (const auto& station : stations_) station->show_flags();
}

Station* HsNetwork::named(std::string_view& text, std::string_view head, char tail) const {
  if (!text.starts_with(head)) return stations_.front().get();
  unsigned number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + head.size(), end, number);
  if (error != std::errc() || stop == end || *stop != tail) return stations_.front().get();
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()) + 1);
  const auto found = std::ranges::find_if(
      stations_, [&](const auto& one) { return one->parameter().station == number; });
  return found == stations_.end() ? nullptr : found->get();
}

Status HsNetwork::set(std::string_view address, std::string_view hex) {
  std::string_view own = address;
  Station* const station = named(own, "", ':');
  if (!station) return fail(fmt::format("cannot set {}: there is no such station", address));
  return plc::set_by_name(station->memory(), own, hex);
}

Result<std::string> HsNetwork::get(std::string_view address, std::size_t digits) const {
  std::string_view own = address;
  const Station* const station = named(own, "", ':');
  if (!station) return fail(fmt::format("cannot read {}: there is no such station", address));
  return station->get(own, digits);
}

Status HsNetwork::act(std::string_view action) {
  std::string_view what = action;
  Station* const station = named(what, "station ", ' ');
  if (!station) return fail(fmt::format("cannot do '{}': there is no such station", action));
  if (what == "run" || what == "stop")
    station->set_run(what == "run");
  else if (what == "error on" || what == "error off")
    station->set_error(what == "error on");
  else if (what == "link on" || what == "link off")
    station->enable(what == "link on");
  else if (what == "on" || what == "off")
    station->power(what == "on");
  else if (what == "power_cycle")
    station->power(true);
  else
    return fail(fmt::format(
        "cannot do '{}': a station can run, stop, power_cycle, on, off, error on, error off, "
        "link on, link off; 'station 2 stop' is of another",
        action));
  show_flags();
  return ok();
}

namespace {

constexpr std::array<std::string_view, 4> station_keys{"hs_link", "mode", "station", "stations"};

Result<std::unique_ptr<Station>> make_station(const plc::PlcModel& model, const json& config) {
  constexpr const char* what = "a station of the high-speed link";
  if (const Status known = plc::known_keys(config, what, station_keys); !known)
    return known.error();
  unsigned number = 1;
  bool run = true;
  plc::ConfigReader reader(config, what);
  reader.whole("station", 255, number);
  reader.either("mode", "run", "stop", run);
  if (reader.error()) return *reader.error();
  const Result<Parameter> parameter =
      read_parameter(config.value("hs_link", json::object()), number, model);
  if (!parameter) return parameter.error();
  return std::make_unique<Station>(model, *parameter, run);
}

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_hs_network(std::string_view model,
                                                             const json& config) {
  const plc::PlcModel* const known = plc::find_plc_model(model);
  if (!known)
    return fail(fmt::format("there is no model '{}' with a high-speed link; models are {}", model,
                            plc::plc_model_names()));
  std::vector<json> all{config};
  for (const json& other : config.value("stations", json::array())) all.push_back(other);
  std::vector<std::unique_ptr<Station>> stations;
  for (const json& one : all) {
    Result<std::unique_ptr<Station>> station = make_station(*known, one);
    if (!station) return station.error();
    stations.push_back(std::move(*station));
  }
  return std::unique_ptr<plc::EmulatedDevice>(std::make_unique<HsNetwork>(std::move(stations)));
}

}  // namespace fieldproof::hs_link
