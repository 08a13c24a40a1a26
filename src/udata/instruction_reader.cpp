#include "src/udata/instruction_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "src/base/spelling.hpp"
#include "src/plc/config_reader.hpp"

namespace fieldproof::udata {

using plc::DeviceAddress;

namespace {

using nlohmann::json;
using Operation = UdataInstruction::Operation;

struct Form {
  std::string_view name;
  Operation operation;
  bool iec;
};
constexpr std::array forms{
    Form{"SNDUDATA", Operation::send, false},  Form{"RCVUDATA", Operation::receive, false},
    Form{"SENDDTR", Operation::dtr, false},    Form{"SENDRTS", Operation::rts, false},
    Form{"SEND_UDATA", Operation::send, true}, Form{"RCV_UDATA", Operation::receive, true},
    Form{"SEND_DTR", Operation::dtr, true},    Form{"SEND_RTS", Operation::rts, true},
};
constexpr std::uint32_t info_words = 4;  // D: the status and three reserved words

enum class Access { read, write };

class OperandReader {
 public:
  OperandReader(const json& object, std::string what, const plc::PlcModel& model, bool iec)
      : object_(object), what_(std::move(what)), model_(model), iec_(iec) {}

  const std::optional<Error>& error() const { return error_; }

  /// Of one of `types`, with `count` elements.
  DeviceAddress address(const char* key, std::string_view types, Access access,
                        std::uint32_t count = 1) {
    const auto found = object_.find(key);
    if (found == object_.end()) return wrong(key, "is missing", types);
    if (!found->is_string()) return wrong(key, "is " + found->dump(), types);
    const std::string& name = found->get_ref<const std::string&>();
    const plc::ParsedAddress parsed = plc::parse_address(model_, name);
    if (!parsed)
      return wrong(key, fmt::format("is '{}': {}", name, plc::describe(parsed.fault)), types);
    const DeviceAddress at = parsed.address;
    const plc::DeviceArea& area = model_.areas[at.area];
    if (types.find(at.type) == std::string_view::npos)
      return wrong(key, fmt::format("is '{}'", name), types);
    if (access == Access::write && !area.write)
      return wrong(key, fmt::format("is '{}': {} is read only", name, area.letter), types);
    if (!iec_ && at.type != 'X' &&
        std::string_view("PMKLUDR").find(area.letter) == std::string_view::npos)
      return wrong(key, fmt::format("is '{}': operands lie in P M K L U D or R", name), types);
    if (!plc::fits(model_, at, count))
      return wrong(key,
                   fmt::format("is '{}': {} elements from there on do not fit into {}", name, count,
                               area.letter),
                   types);
    return at;
  }
  std::optional<DeviceAddress> output(const char* key, std::string_view types) {
    if (!object_.contains(key)) return std::nullopt;
    return address(key, types, Access::write);
  }
  /// The first byte of data. A word is its low byte.
  DeviceAddress bytes(const char* key, Access access, std::uint32_t count) {
    DeviceAddress at = address(key, iec_ ? "BW" : "W", access);
    if (error_) return at;
    if (at.type == 'W') at = {at.area, 'B', false, at.index * 2};
    if (!plc::fits(model_, at, count))
      wrong(key, fmt::format("leaves less than {} bytes to the end of its area", count), "W");
    return at;
  }
  UdataOperand operand(const char* key) {
    const auto found = object_.find(key);
    if (found != object_.end() && found->is_string()) return {0, address(key, "W", Access::read)};
    return {number(key, 0xFFFF, std::nullopt), std::nullopt};
  }
  std::uint16_t number(const char* key, unsigned most, std::optional<std::uint16_t> otherwise) {
    const auto found = object_.find(key);
    if (found == object_.end() && otherwise) return *otherwise;
    const auto right = [most](const json& value) {
      return value.is_number_integer() && value >= 0 && value <= most;
    };
    if (found != object_.end() && right(*found)) return found->get<std::uint16_t>();
    const std::string given = found == object_.end() ? "is missing" : "is " + found->dump();
    say(fmt::format("{} {}; give a number from 0 to {}{}", key, given, most,
                    otherwise ? "" : " or the address of a word"));
    return 0;
  }

 private:
  DeviceAddress wrong(const char* key, const std::string& why, std::string_view types) {
    const char* example = types.starts_with('X') ? "a bit (\"%MX00100\")"
                          : types == "BW"        ? "a byte or word (\"%MB200\")"
                                                 : "a word (\"%MW100\")";
    say(fmt::format("{} {}; give the address of {}", key, why, example));
    return {};
  }
  void say(const std::string& why) {
    if (!error_) error_ = fail(fmt::format("cannot read {}: {}", what_, why));
  }

  const json& object_;
  std::string what_;
  const plc::PlcModel& model_;
  bool iec_;
  std::optional<Error> error_;
};

Result<Form> form_of(const json& object, const std::string& what, const plc::PlcModel& model) {
  const std::string name =
      object.is_object() && object.contains("instruction") && object["instruction"].is_string()
          ? object["instruction"].get<std::string>()
          : "";
  std::vector<std::string_view> names;
  for (const Form& form : forms) {
    if (form.iec != model.iec) continue;
    if (form.name == name) return form;
    names.push_back(form.name);
  }
  return fail(fmt::format("cannot read {}: '{}' is no UDATA instruction of {}; use one of {}{}",
                          what, name, model.name, fmt::join(names, ", "), suggestion(name, names)));
}

std::vector<std::string_view> keys_of(const Form& form) {
  std::vector<std::string_view> keys{"instruction", "request", "slot", "channel"};
  if (form.operation == Operation::dtr || form.operation == Operation::rts)
    keys.push_back("value");
  else
    keys.insert(keys.end(), {"data", "size"});
  if (form.iec)
    keys.insert(keys.end(), {"base", "done", "status"});
  else
    keys.push_back("info");
  return keys;
}

}  // namespace

Result<UdataInstruction> read_udata_instruction(const json& object, std::size_t number,
                                                const plc::PlcModel& model) {
  std::string what = fmt::format("instruction {}", number);
  const Result<Form> form = form_of(object, what, model);
  if (!form) return form.error();
  what += fmt::format(" ({})", form->name);
  if (const Status known = plc::known_keys(object, what, keys_of(*form)); !known)
    return known.error();

  OperandReader reader(object, what, model, form->iec);
  UdataInstruction one;
  one.name = form->name;
  one.operation = form->operation;
  one.iec = form->iec;
  one.request = reader.address("request", "X", Access::read);
  one.base = reader.number("base", 0xFF, 0);
  one.slot = reader.number("slot", 0xFFFF, std::nullopt);
  one.channel = reader.operand("channel");
  switch (one.operation) {
    case Operation::send:
      one.data = reader.bytes("data", Access::read, 1);
      one.value = reader.operand("size");
      break;
    case Operation::receive:
      one.data = reader.bytes("data", Access::write, udata_max);  // the caution of 6.6.6
      one.size = one.iec ? reader.output("size", "W") : reader.address("size", "W", Access::write);
      break;
    default: one.value = reader.operand("value");
  }
  one.status = one.iec ? reader.output("status", "W")
                       : reader.address("info", "W", Access::write, info_words);
  if (one.iec) one.done = reader.output("done", "X");
  if (reader.error()) return *reader.error();
  return one;
}

}  // namespace fieldproof::udata
