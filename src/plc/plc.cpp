#include "src/plc/plc.hpp"

#include <nlohmann/json.hpp>

#include "src/plc/port_config.hpp"

namespace fieldproof::plc {

Result<std::unique_ptr<Plc>> make_plc(std::string_view model, const nlohmann::json& config) {
  const Result<const PlcModel*> known = known_plc_model(model);
  if (!known) return known.error();
  bool run = true;
  ConfigReader reader(config, "the PLC's configuration");
  reader.either("mode", "run", "stop", run);
  if (reader.error()) return *reader.error();
  return std::make_unique<Plc>(**known, run);
}

}  // namespace fieldproof::plc
