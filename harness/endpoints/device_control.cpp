#include "harness/endpoints/device_control.hpp"

#include <nlohmann/json.hpp>

namespace fieldproof::endpoints {

namespace {

using nlohmann::json;

std::string text_of(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

json done(const Status& status) {
  if (status) return {{"ok", true}};
  return {{"error", status.error().message}};
}

json ask(plc::EmulatedDevice& device, const std::string& verb, const json& what) {
  if (verb == "act" && what.is_string()) return done(device.act(what.get<std::string>()));
  if (verb == "set" && what.is_object())
    return done(device.set(text_of(what, "address"), text_of(what, "hex")));
  if (verb == "get" && what.is_object()) {
    const auto digits = what.find("digits");
    const bool given = digits != what.end() && digits->is_number_unsigned();
    const Result<std::string> value =
        device.get(text_of(what, "address"), given ? digits->get<std::size_t>() : 0);
    if (!value) return {{"error", value.error().message}};
    return {{"ok", true}, {"value", *value}};
  }
  return {{"error", "cannot do '" + verb +
                        "': write {\"begin\":{}}, {\"set\":{}}, {\"get\":{}} or {\"act\":\"\"}"}};
}

json answer(std::string_view line, const std::function<Status(const json&)>& begin,
            const std::function<plc::EmulatedDevice*()>& device) {
  const json request = json::parse(line, nullptr, false);
  if (!request.is_object() || request.size() != 1) {
    return {{"error", "cannot read the control line: write one JSON object with one key"}};
  }
  const std::string verb = request.begin().key();
  const json& what = request.begin().value();
  if (verb == "begin" && what.is_object()) return done(begin(what));
  plc::EmulatedDevice* const present = device();
  if (!present) return {{"error", "cannot do '" + verb + "': there is no device yet; begin first"}};
  return ask(*present, verb, what);
}

}  // namespace

std::string control_line(const json& request) {
  return request.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
}

std::string answer_control(std::string_view line,
                           const std::function<Status(const json& config)>& begin,
                           const std::function<plc::EmulatedDevice*()>& device) {
  return control_line(answer(line, begin, device));
}

Result<std::string> read_control_answer(std::string_view line) {
  const json object = json::parse(line, nullptr, false);
  if (!object.is_object())
    return fail("cannot read the emulator's answer '" + std::string(line) +
                "': it is no JSON object");
  if (const auto error = object.find("error"); error != object.end())
    return fail(text_of(object, "error"));
  return text_of(object, "value");
}

}  // namespace fieldproof::endpoints
