#include "suites/xgt_fenet/broken/broken_server.hpp"

#include <nlohmann/json.hpp>

#include "src/xgt_fenet/plc.hpp"

namespace fieldproof::xgt_fenet_broken {

namespace {

std::optional<std::size_t> first_frame(ByteView stream) {
  if (stream.size() < body_at) return std::nullopt;
  const std::size_t size = body_at + (stream[length_at] | stream[length_at + 1] << 8u);
  return stream.size() < size ? std::nullopt : std::optional(size);
}

}  // namespace

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_server(const Behaviour& behaviour,
                                                                std::string_view model,
                                                                const nlohmann::json& config) {
  Result<std::unique_ptr<plc::Plc>> good = plc::make_plc(model, config);
  if (!good) return good.error();
  Result<xgt_fenet::ServerConfig> settings = xgt_fenet::read_server_config(config);
  if (!settings) return settings.error();
  if (behaviour.settings) behaviour.settings(*settings);
  const Status added =
      (*good)->add(std::make_unique<xgt_fenet::FenetServer>((*good)->memory(), *settings));
  if (!added) return added.error();
  return std::unique_ptr<plc::EmulatedDevice>(
      std::make_unique<broken::NetworkServer>(behaviour, std::move(*good), first_frame));
}

}  // namespace fieldproof::xgt_fenet_broken
