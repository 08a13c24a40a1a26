#include "harness/cli/config_file.hpp"

#include <fmt/format.h>

#include "reports/results/whole_file.hpp"
#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"

namespace fieldproof::cli {

Result<nlohmann::json> read_config_file(const std::string& path) {
  const Result<std::string> text = results::read_whole_file(path);
  if (!text) return text.error();
  try {
    nlohmann::json config = nlohmann::json::parse(not_too_deep(*text));
    if (config.is_object()) return config;
  } catch (const nlohmann::json::parse_error& error) {
    return fail(fmt::format("cannot read {}: it is no JSON: {}", path, json_trouble(error)));
  }
  return fail(
      fmt::format("cannot read {}: it is no object; write the keys of given.config "
                  "(vectors/README.md)",
                  path));
}

Result<nlohmann::json> read_p2p_file(const std::string& path) {
  Result<nlohmann::json> read = read_config_file(path);
  if (!read) return read.error();
  nlohmann::json& config = *read;
  if (!config.contains("p2p"))
    return fail(
        fmt::format("cannot read {}: there is no \"p2p\"; give {{\"p2p\": {{\"blocks\": [...]}}}} "
                    "as vectors/README.md says",
                    path));
  if (config.emplace("role", "client").first.value() != "client")
    return fail(fmt::format("cannot use {}: role is {}; P2P is of role client, remove the key",
                            path, config["role"].dump()));
  return config;
}

hosting::HostedFactory naming_file(hosting::HostedFactory make_device, std::string path) {
  return [make_device = std::move(make_device), path = std::move(path)](
             const nlohmann::json& config) -> Result<std::unique_ptr<plc::EmulatedDevice>> {
    Result<std::unique_ptr<plc::EmulatedDevice>> device = make_device(config);
    if (!device) return fail(path + ": " + device.error().message);
    return device;
  };
}

}  // namespace fieldproof::cli
