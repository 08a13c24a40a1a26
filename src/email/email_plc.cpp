#include "src/email/email_plc.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "src/email/email_service.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof::email {

namespace {

Status add_service(plc::Plc& plc, const nlohmann::json& p2p, const p2p::P2pParameters& parameters) {
  Result<EmailSettings> settings = parse_email_settings(p2p.at("email"));
  if (!settings) return settings.error();
  const Status checked =
      p2p::check_p2p_driver(parameters, 0, EsendDriver(*settings), plc.memory().model());
  if (!checked) return checked;
  return plc.add(std::make_unique<EmailService>(std::move(*settings), plc.memory(), parameters,
                                                plc.own_links()));
}

/// Nothing else asks here.
Status check_alone(const p2p::P2pParameters& parameters) {
  if (!parameters.email)
    return fail(
        "cannot read p2p: there are no e-mail settings; give 'email', or take the protocol of the "
        "channels, such as xgt-fenet");
  for (const p2p::P2pBlock& block : parameters.blocks)
    if (!block.is_mail())
      return fail(
          fmt::format("cannot set up P2P block {}: it asks over a channel; set function "
                      "esend, or take the protocol of the channels, such as xgt-fenet",
                      block.number));
  return ok();
}

}  // namespace

Status add_email(plc::Plc& plc, const nlohmann::json& config) {
  if (!config.contains("p2p") || !config["p2p"].contains("email")) return ok();
  const Result<p2p::P2pParameters> parameters =
      p2p::parse_p2p_parameters(config["p2p"], plc.memory().model(), p2p::network_p2p_rules());
  return parameters ? add_service(plc, config["p2p"], *parameters) : Status(parameters.error());
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_email_plc(std::string_view model,
                                                            const nlohmann::json& config) {
  constexpr std::string_view whose = "the configuration of e-mail";
  const auto keys = plc::network_keys({"p2p"});
  if (const Status status = plc::known_keys(config, whose, keys); !status) return status.error();
  Result<std::unique_ptr<plc::Plc>> plc = plc::make_plc(model, config);
  if (!plc) return plc.error();
  if (config.contains("p2p")) {
    const Result<p2p::P2pParameters> parameters = p2p::parse_p2p_parameters(
        config["p2p"], (*plc)->memory().model(), p2p::network_p2p_rules());
    if (!parameters) return parameters.error();
    if (const Status alone = check_alone(*parameters); !alone) return alone.error();
    p2p::write_p2p_registers((*plc)->memory(), *parameters);
    if (const Status added = add_service(**plc, config["p2p"], *parameters); !added)
      return added.error();
  }
  return std::unique_ptr<plc::EmulatedDevice>(std::move(*plc));
}

}  // namespace fieldproof::email
