#include "suites/modbus/facts.hpp"

#include <fmt/format.h>
#include <array>
#include <nlohmann/json.hpp>

#include "src/modbus/bases.hpp"
#include "src/modbus/pdu.hpp"
#include "src/xnet/areas.hpp"
#include "suites/modbus/functions.hpp"

namespace fieldproof::modbus_suite {

namespace {

using nlohmann::json;

/// What a fact states must stand in the row of the table.
Status compare(const json& facts, const json& row) {
  for (const auto& [key, due] : facts.items()) {
    if (key == "table") continue;
    if (!row.contains(key))
      return fail(fmt::format("the table {} has no column '{}'", facts["table"].dump(), key));
    if (row[key] != due)
      return fail(
          fmt::format("the table has {} = {}, the manual {}", key, row[key].dump(), due.dump()));
  }
  return ok();
}

/// The emulator's table, and the one that explains frames.
Status check_function(const json& facts) {
  const std::optional<Bytes> code = from_hex(facts.value("code", ""));
  const FunctionCode* known = code && code->size() == 1 ? find_function(code->front()) : nullptr;
  const modbus::ModbusFunction* emulated =
      known ? modbus::find_modbus_function(known->code) : nullptr;
  if (!emulated)
    return fail(
        fmt::format("no function code '{}'; a code is two hex digits", facts.value("code", "")));
  const json common{{"code", hex_number(known->code, 2)}, {"address", known->address}};
  json row{{"name", emulated->name},
           {"limit", emulated->limit},
           {"base", modbus::modbus_base_names[static_cast<std::size_t>(emulated->base)]}};
  row.update(common);
  if (const Status agrees = compare(facts, row); !agrees) return agrees;
  json explained{{"name", known->name}, {"limit", known->limit}, {"base", known->base}};
  explained.update(common);
  return compare(facts, explained);
}

/// 9.2.2 and Appendix 3.2 name the first three codes differently.
constexpr std::array<std::string_view, 4> names_of_9_2_2{"", "Function code error", "Address error",
                                                         "Data setting error"};

Status check_exception(const json& facts) {
  const std::optional<Bytes> code = from_hex(facts.value("code", ""));
  const std::string_view meaning =
      code && code->size() == 1 ? exception_meaning(code->front()) : std::string_view();
  if (meaning.empty()) return fail(fmt::format("no exception code '{}'", facts.value("code", "")));
  const Byte number = code->front();
  const bool of_9_2_2 =
      number < names_of_9_2_2.size() && facts.value("name", "") == names_of_9_2_2[number];
  return compare(facts, {{"code", hex_number(number, 2)},
                         {"name", of_9_2_2 ? names_of_9_2_2[number] : meaning}});
}

Status check_default_bases(const json& facts) {
  const plc::PlcModel* model = plc::find_plc_model(facts.value("model", ""));
  if (!model)
    return fail(fmt::format("no model '{}'; there are {}", facts.value("model", ""),
                            plc::plc_model_names()));
  json row{{"model", model->name}};
  const modbus::ModbusBases bases = modbus::default_modbus_bases(*model);
  for (std::size_t i = 0; i < bases.size(); ++i)
    row[std::string(modbus::modbus_base_names[i])] = bases[i];
  return compare(facts, row);
}

/// A soft component and the address at which Modbus shows it.
Status check_xinje(const json& facts) {
  const std::string name = facts.value("object", "");
  const std::optional<xnet::Component> component = xnet::find_component(name);
  if (!component) return fail(fmt::format("no soft component '{}'", name));
  const xnet::Area& area = *component->area;
  return compare(facts, {{"object", xnet::to_string(*component)},
                         {"kind", area.bits ? "coil" : "register"},
                         {"address", hex_number(area.modbus + component->number, 4)}});
}

Status check_data_address(const json& facts) {
  return compare(facts, {{"first", hex_number(0, 4)}, {"last", hex_number(last_data_address, 4)}});
}

}  // namespace

Status check_fact(const json& facts) {
  const std::string table = facts.value("table", "");
  if (table == "function_code") return check_function(facts);
  if (table == "exception_code") return check_exception(facts);
  if (table == "default_bases") return check_default_bases(facts);
  if (table == "data_address") return check_data_address(facts);
  if (table == "xinje") return check_xinje(facts);
  return fail(fmt::format(
      "no table '{}'; there are function_code, exception_code, default_bases, data_address and "
      "xinje",
      table));
}

}  // namespace fieldproof::modbus_suite
