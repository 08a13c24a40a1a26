#include "harness/cli/p2p_file.hpp"

#include <fmt/format.h>

#include "reports/results/whole_file.hpp"

namespace fieldproof::cli {

Result<nlohmann::json> read_p2p_file(const std::string& path) {
  const Result<std::string> text = results::read_whole_file(path);
  if (!text) return text.error();
  nlohmann::json config;
  try {
    config = nlohmann::json::parse(*text);
  } catch (const nlohmann::json::parse_error& error) {
    return fail(fmt::format("cannot read {}: it is no JSON: {}", path, error.what()));
  }
  if (!config.is_object() || !config.contains("p2p"))
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
