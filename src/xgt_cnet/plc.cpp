#include "src/xgt_cnet/plc.hpp"

#include "src/xgt_cnet/server.hpp"

namespace fieldproof::xgt_cnet {

Status add_server(plc::Plc& plc, unsigned channel, const plc::PortConfig& config) {
  if (const Result<const plc::PlcModel*> right = plc::check_port_config(config); !right)
    return right.error();
  return plc.add(channel, std::make_unique<XgtServer>(plc.memory(), config.station, config.gap(),
                                                      config.reply_delay()));
}

Result<std::unique_ptr<plc::Plc>> make_plc(const plc::PortConfig& config) {
  const Result<const plc::PlcModel*> model = plc::check_port_config(config);
  if (!model) return model.error();
  auto plc = std::make_unique<plc::Plc>(**model, config.run);
  if (const Status added = add_server(*plc, 1, config); !added) return added.error();
  return plc;
}

}  // namespace fieldproof::xgt_cnet
