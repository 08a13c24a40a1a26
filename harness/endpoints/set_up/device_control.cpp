#include "harness/endpoints/set_up/device_control.hpp"

#include <nlohmann/json.hpp>

#include "src/base/nesting.hpp"

namespace fieldproof::endpoints {

namespace {

using nlohmann::json;

json done(const Status& status) {
  if (status) return {{"ok", true}};
  return {{"error", status.error().message}};
}

/// Of an address; 0: as many as it has.
std::size_t digits_of(const json& what, const std::string& address) {
  const auto given = what.is_object() ? what.find(address) : what.end();
  return given != what.end() && given->is_number_unsigned() ? given->get<std::size_t>() : 0;
}

json get(plc::EmulatedDevice& device, const json& what) {
  json values = json::object();
  for (const auto& [key, entry] : what.items()) {
    const std::string address = what.is_object()    ? key
                                : entry.is_string() ? std::string(entry)
                                                    : "";
    const Result<std::string> value = device.get(address, digits_of(what, address));
    if (!value) return {{"error", value.error().message}};
    values[address] = *value;
  }
  return {{"values", values}};
}

json set(plc::EmulatedDevice& device, const json& what) {
  for (const auto& [address, hex] : what.items()) {
    const Status status = device.set(address, hex.is_string() ? std::string(hex) : std::string());
    if (!status) return done(status);
  }
  return done(ok());
}

json ask(plc::EmulatedDevice& device, const std::string& verb, const json& what) {
  if (verb == "do" && what.is_string()) return done(device.act(what.get<std::string>()));
  if (verb == "set" && what.is_object()) return set(device, what);
  if (verb == "get" && (what.is_array() || what.is_object())) return get(device, what);
  return {{"error", "cannot do '" + verb +
                        "': write {\"config\":{}}, {\"set\":{}}, {\"get\":[]} or {\"do\":\"\"}"}};
}

json answer(std::string_view line, const ControlledDevice& controlled) {
  const json request = json::parse(not_too_deep(line), nullptr, false);
  if (!request.is_object() || request.size() != 1) {
    return {{"error", "cannot read the control line: write one JSON object with one key"}};
  }
  const std::string verb = request.begin().key();
  const json& what = request.begin().value();
  if (verb == "begin" && what.is_object()) return done(controlled.begin(what));
  if (verb == "config" && what.is_object()) return done(controlled.config(what));
  plc::EmulatedDevice* const present = controlled.device();
  if (!present) return {{"error", "cannot do '" + verb + "': there is no device yet; begin first"}};
  return ask(*present, verb, what);
}

}  // namespace

std::string control_line(const json& request) {
  return request.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
}

std::string answer_control(std::string_view line, const ControlledDevice& device) {
  return control_line(answer(line, device));
}

Result<json> read_control_answer(std::string_view line) {
  const json object = json::parse(not_too_deep(line), nullptr, false);
  if (!object.is_object())
    return fail("cannot read the emulator's answer '" + std::string(line) +
                "': it is no JSON object");
  if (const auto error = object.find("error"); error != object.end())
    return fail(error->is_string() ? error->get<std::string>() : error->dump());
  return object.value("values", json::object());
}

}  // namespace fieldproof::endpoints
