#include "suites/user_frames/protocol.hpp"
#include "suites/services/clients.hpp"

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "harness/device_names.hpp"
#include "src/base/spelling.hpp"
#include "src/email/email_plc.hpp"
#include "src/p2p/p2p_plc.hpp"
#include "src/p2p/parameters.hpp"
#include "src/plc/config_reader.hpp"
#include "src/user_frames/codec.hpp"
#include "src/user_frames/network_server.hpp"
#include "src/user_frames/p2p_driver.hpp"
#include "src/user_frames/port.hpp"
#include "suites/checks/checks.hpp"
#include "suites/user_frames/definition_files.hpp"
#include "suites/user_frames/facts.hpp"
#include "suites/user_frames/frame_parts.hpp"

namespace fieldproof::user_frames_suite {

using harness::Protocol;

namespace {

class UserFrames : public Protocol, public harness::Probing, public harness::Tables {
 public:
  UserFrames(Way way, std::vector<NamedDefinition> all) : way_(way), definitions_(std::move(all)) {}
  UserFrames(Way way, NamedDefinition one) : way_(way), definitions_{std::move(one)}, own_(true) {}

  std::string_view name() const override {
    return way_ == Way::line ? "user-frames" : "user-frames-net";
  }
  std::uint16_t default_port() const override {
    return way_ == Way::line ? 0 : user_frames::first_network_port;
  }
  std::vector<std::string> models() const override {
    return definition_names(definitions_folder());
  }
  /// A PLC, where the key `definition` of its configuration names its frames.
  bool has_model(std::string_view model) const override {
    return is_definition_path(model) || Protocol::has_model(model) || plc::find_plc_model(model);
  }
  const Protocol& of_model(std::string_view model) const override {
    return model.empty() ? *this : protocol_of(model, way_);
  }

  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(
      std::string_view model, const nlohmann::json& config) const override;

  /// Stations are constants of the frames; this is how XGT writes them.
  notation::Checks checks() const override {
    static const std::array all{checks::bcc, checks::sum, checks::crc, checks::lrc};
    return all;
  }
  Bytes station_bytes(int station) const override {
    return to_bytes(hex_number(static_cast<unsigned>(station), 2));
  }
  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    return user_frames_suite::frame_length(definitions_, bytes);
  }
  std::vector<harness::Field> explain(ByteView frame) const override {
    return user_frames_suite::explain(definitions_, frame);
  }

  const harness::Probing* probing() const override { return this; }
  const harness::Tables* tables() const override { return this; }

  /// None after a frame that has the probe's own reply.
  Bytes probing_request(int, ByteView tested) const override {
    const user_frames::FrameDefinition* one = own();
    if (!one || one->probe.empty()) return {};
    for (const user_frames::UserFrame& frame : one->frames)
      if (!frame.sent && frame.answer == one->probe_reply &&
          user_frames::match_frame(frame, tested, true).state ==
              user_frames::FrameMatch::State::complete)
        return {};
    const Result<Bytes> bytes =
        user_frames::build_frame(*one->find(one->probe), plc::PlcMemory(*one->plc));
    return bytes ? *bytes : Bytes{};
  }

  bool answers_probe(ByteView, ByteView reply) const override {
    const user_frames::FrameDefinition* one = own();
    if (!one || one->probe.empty()) return false;
    const user_frames::FrameMatch match =
        user_frames::match_frame(*one->find(one->probe_reply), reply, true);
    return match.state == user_frames::FrameMatch::State::complete &&
           match.length() == reply.size();
  }

  /// Without the device's definition nobody can tell what a frame does there.
  std::vector<Written> written_by(ByteView request) const override {
    if (!own()) return {{"?", 0, 0, "what its definition says"}};
    return user_frames_suite::written_by(definitions_.front(), request);
  }
  std::vector<std::string_view> output_areas() const override { return {"P", "Q", "U"}; }
  std::optional<WordName> read_word(std::string_view text) const override {
    return harness::read_word_name(text);
  }
  Status check_table(const nlohmann::json& facts) const override {
    return user_frames_suite::check_fact(facts);
  }

 private:
  Result<std::unique_ptr<plc::EmulatedDevice>> make_client(
      const user_frames::FrameDefinition& definition, const plc::PlcModel& plc,
      const nlohmann::json& config) const;
  /// Where this is the protocol of one model.
  const user_frames::FrameDefinition* own() const {
    return own_ ? &definitions_.front().definition : nullptr;
  }

  Way way_;
  std::vector<NamedDefinition> definitions_;
  bool own_ = false;
};

/// The protocol of one model. A definition is read when it is first asked for: each case makes a
/// device of it.
Result<const UserFrames*> read_once(std::string_view model, Way way) {
  static std::mutex mutex;  // cases run in several threads
  static std::map<Way, std::map<std::string, UserFrames, std::less<>>> all;
  const std::lock_guard lock(mutex);
  std::map<std::string, UserFrames, std::less<>>& known = all[way];
  if (const auto found = known.find(model); found != known.end()) return &found->second;
  Result<NamedDefinition> loaded = load_definition(model, definitions_folder());
  if (!loaded) return loaded.error();
  return &known.try_emplace(std::string(model), way, std::move(*loaded)).first->second;
}

/// The blocks of role client, where they can be read; what is wrong with them make_p2p_device says.
std::vector<p2p::P2pBlock> blocks_of(const nlohmann::json& config, const plc::PlcModel& plc,
                                     const p2p::P2pRules& rules) {
  if (!config.contains("p2p")) return {};
  const Result<p2p::P2pParameters> parameters =
      p2p::parse_p2p_parameters(config["p2p"], plc, rules);
  return parameters ? parameters->blocks : std::vector<p2p::P2pBlock>{};
}

Result<std::unique_ptr<plc::EmulatedDevice>> UserFrames::make_device(
    std::string_view model, const nlohmann::json& config) const {
  std::string name(model);
  plc::ConfigReader reader(config, "the port's configuration");
  reader.text("definition", name);
  if (reader.error()) return *reader.error();
  if (plc::find_plc_model(name))
    return fail(fmt::format(
        "cannot make {} send or receive user frames: name them with definition, such as px7",
        name));
  const Result<const UserFrames*> one = read_once(name, way_);
  if (!one) return one.error();
  const user_frames::FrameDefinition& definition = *(*one)->own();
  if (!p2p::is_p2p_client(config)) {
    nlohmann::json of_port = config;
    of_port.erase("definition");
    return way_ == Way::line ? user_frames::make_user_frame_device(definition, of_port)
                             : user_frames::make_user_frame_server(definition, of_port);
  }
  const plc::PlcModel* plc = plc::find_plc_model(model);
  if (!plc) plc = definition.plc;
  return make_client(definition, *plc, config);
}

Result<std::unique_ptr<plc::EmulatedDevice>> UserFrames::make_client(
    const user_frames::FrameDefinition& definition, const plc::PlcModel& model,
    const nlohmann::json& config) const {
  if (way_ == Way::line)
    return p2p::make_p2p_device(model.name, config,
                                [&](const plc::PortConfig& port) {
                                  return user_frames::make_user_frame_p2p_driver(
                                      definition, blocks_of(config, model, {}), port.gap());
                                },
                                {"definition"});
  nlohmann::json own = config;
  own.erase("definition");
  Result<std::unique_ptr<plc::Plc>> plc = plc::make_plc(model.name, own);
  if (!plc) return plc.error();
  constexpr p2p::PartnerPorts ports{user_frames::first_network_port,
                                    user_frames::first_network_port};
  const Status added = p2p::add_network_clients(
      **plc, own, services::client_drivers({"user-frames-net", ports, [&] {
                                              return user_frames::make_user_frame_network_driver(
                                                  definition,
                                                  blocks_of(own, model, p2p::network_p2p_rules()),
                                                  user_frames::network_gap);
                                            }}));
  if (!added) return added.error();
  if (const Status mails = email::add_email(**plc, own); !mails) return mails.error();
  return std::unique_ptr<plc::EmulatedDevice>(std::move(*plc));
}

}  // namespace

const Protocol& protocol(Way way) {
  static const UserFrames line(Way::line, load_definitions(definitions_folder()));
  static const UserFrames network(Way::network, load_definitions(definitions_folder()));
  return way == Way::line ? line : network;
}

const Protocol& protocol_of(std::string_view model, Way way) {
  const Result<const UserFrames*> one = read_once(model, way);
  return one ? **one : protocol(way);
}

}  // namespace fieldproof::user_frames_suite
