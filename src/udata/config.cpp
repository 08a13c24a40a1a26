#include "src/udata/config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

#include "src/base/spelling.hpp"
#include "src/udata/instruction_reader.hpp"

namespace fieldproof::udata {

namespace {

using nlohmann::json;

constexpr std::string_view config_name = "the UDATA port's configuration";
constexpr double least_version = 1.4;  // of an external Cnet: status 7

struct ModuleKind {
  std::string_view name;
  bool built_in = false;
  bool cnet = true;
};
constexpr std::array module_kinds{ModuleKind{"built-in", true}, ModuleKind{"xbl-c21a"},
                                  ModuleKind{"xbl-c41a"}, ModuleKind{"xbl-emta", false, false}};
constexpr std::array<std::string_view, 8> drivers{
    "user-frames", "xgt-server",        "modbus-rtu-server",   "modbus-ascii-server",
    "xgt-client",  "modbus-rtu-client", "modbus-ascii-client", "ls-bus-client"};

template <std::size_t N>
Error not_one_of(const char* key, const std::string& given,
                 const std::array<std::string_view, N>& names) {
  return fail(fmt::format("cannot read {}: {} is '{}', which is none of {}{}", config_name, key,
                          given, fmt::join(names, ", "), suggestion(given, names)));
}

Result<ModuleKind> module_kind(const std::string& name) {
  std::array<std::string_view, module_kinds.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i] = module_kinds[i].name;
    if (name == names[i]) return module_kinds[i];
  }
  return not_one_of("module", name, names);
}

/// "1.4", "V1.40": both are 1.4.
Result<double> version_number(std::string text) {
  const std::string digits = text.starts_with('V') ? text.substr(1) : text;
  double number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error == std::errc{} && end == digits.data() + digits.size() && number >= 0) return number;
  return fail(fmt::format("cannot read {}: version is '{}', which is not a version such as \"1.4\"",
                          config_name, text));
}

Result<UdataModule> read_module(plc::ConfigReader& reader) {
  UdataModule module;
  std::string kind = "xbl-c21a", driver = "user-frames", version = "1.4";
  reader.text("module", kind);
  const Result<ModuleKind> known = module_kind(kind);
  if (!known) return known.error();
  module.cnet = known->cnet;
  module.slot = known->built_in ? 0 : 1;
  module.channel = known->built_in ? 1 : 2;  // RS-232C of each (Cnet KO table 4.3.1)
  reader.whole("slot", 11, module.slot);
  reader.whole("channel", 2, module.channel);
  reader.text("driver", driver);
  reader.text("version", version);
  reader.boolean("link", module.link);
  reader.boolean("module_hangs", module.hangs);
  if (reader.error()) return *reader.error();
  if (known->built_in != (module.slot == 0))
    return fail(fmt::format(
        "cannot read {}: slot is {}; the built-in channels are slot 0, and nothing else is",
        config_name, module.slot));
  if (module.channel == 0)
    return fail(fmt::format("cannot read {}: channel is 0; it is 1 or 2", config_name));
  if (std::ranges::find(drivers, driver) == drivers.end())
    return not_one_of("driver", driver, drivers);
  module.user_frames = driver == "user-frames";
  const Result<double> number = version_number(version);
  if (!number) return number.error();
  module.new_enough = known->built_in || *number >= least_version;
  return module;
}

}  // namespace

Result<UdataConfig> parse_udata_config(std::string_view model, const json& config) {
  const auto keys = plc::port_keys(
      {"channel", "driver", "instructions", "link", "module", "module_hangs", "slot", "version"});
  if (const Status known = plc::known_keys(config, config_name, keys); !known) return known.error();
  UdataConfig parsed;
  parsed.port.model = model;
  plc::ConfigReader reader(config, std::string(config_name));
  plc::read_port_config(reader, parsed.port);
  if (reader.error()) return *reader.error();
  const Result<const plc::PlcModel*> plc = plc::check_port_config(parsed.port);
  if (!plc) return plc.error();
  parsed.plc = *plc;
  if (parsed.plc->name == "xbm-s")
    return fail(
        "cannot make a UDATA port of xbm-s: Cnet KO 2.2 lists no version of XBM for UDATA; use "
        "xbc-h "
        "or xec-h");
  const Result<UdataModule> module = read_module(reader);
  if (!module) return module.error();
  parsed.module = *module;
  const json instructions = config.value("instructions", json::array());
  if (!instructions.is_array())
    return fail(fmt::format("cannot read {}: instructions is no array", config_name));
  for (std::size_t i = 0; i < instructions.size(); ++i) {
    Result<UdataInstruction> one = read_udata_instruction(instructions[i], i, *parsed.plc);
    if (!one) return one.error();
    parsed.instructions.push_back(std::move(*one));
  }
  return parsed;
}

}  // namespace fieldproof::udata
