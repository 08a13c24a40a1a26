#include "suites/fuzz/set_up_targets.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "harness/endpoints/set_up/device_control.hpp"
#include "suites/fuzz/chosen.hpp"
#include "suites/fuzz/fed_device.hpp"
#include "suites/fuzz/rule.hpp"

namespace fieldproof::fuzz {

namespace {

using harness::Protocol;
using nlohmann::json;
using Made = Result<std::unique_ptr<plc::EmulatedDevice>>;

struct Client {
  const Protocol* protocol = nullptr;
  std::string model;
  json config;
  std::set<Bytes> answers;  // of its partner, in the vectors
};

std::string model_of(const vectors::Case& one, const Protocol& protocol) {
  return one.models.empty() ? protocol.models().front() : one.models.front();
}

/// A flag that the vectors would set is a clock.
void let_it_ask(json& config, const std::string& model) {
  const auto p2p = config.find("p2p");
  if (p2p == config.end() || !p2p->contains("blocks")) return;
  for (json& block : (*p2p)["blocks"])
    if (block.is_object()) block["flag"] = model == "xec-h" ? "_T200MS" : "F92";
}

std::vector<Client> clients_of_vectors() {
  std::vector<Client> all;
  for (const vectors::Case& one : cases_of_vectors()) {
    const Protocol* const protocol = suites::protocols().find(one.protocol);
    if (!protocol || !protocol->has_frames() || !vectors::is_client_case(one)) continue;
    Client client{protocol, model_of(one, *protocol), one.config, {}};
    let_it_ask(client.config, client.model);
    const auto same = std::ranges::find_if(all, [&](const Client& other) {
      return other.protocol == protocol && other.model == client.model &&
             other.config == client.config;
    });
    if (same == all.end() && !protocol->make_device(client.model, client.config)) continue;
    Client& kept = same == all.end() ? all.emplace_back(std::move(client)) : *same;
    for (const vectors::Step& step : one.steps)
      if (step.kind == vectors::Step::Kind::send)
        for (const Bytes& frame : wires_of(step)) kept.answers.insert(frame);
  }
  return all;
}

const std::vector<Client>& clients() {
  static const std::vector<Client> all = clients_of_vectors();
  return all;
}

}  // namespace

void feed_client(ByteView input) {
  if (input.size() < 2) return;
  const Client& client = clients()[(input[0] * 256u + input[1]) % clients().size()];
  Made made = client.protocol->make_device(client.model, client.config);
  rule(bool(made), "it was made before");
  FedDevice device(*client.protocol, std::move(*made));
  device.pause(500ms);
  const bool asks = device.has_sent();
  device.feed_pieces(input.subspan(2));
  device.pause(quiet);
  rule(device.has_sent() || !asks, "a client asks on, whatever was answered");
}

std::vector<Bytes> good_partners() {
  std::vector<Bytes> all;
  for (std::size_t i = 0; i < clients().size(); ++i)
    for (const Bytes& answer : clients()[i].answers) {
      if (answer.size() > 256) continue;
      Bytes one{static_cast<Byte>(i / 256), static_cast<Byte>(i % 256),
                static_cast<Byte>(answer.size() - 1), 100};
      one.insert(one.end(), answer.begin(), answer.end());
      all.push_back(std::move(one));
    }
  return all;
}

void feed_control(ByteView input) {
  if (input.empty()) return;
  const Protocol& protocol = protocol_of(input.front());
  std::optional<FedDevice> present;
  json now = json::object();
  const auto begin = [&](const json& config) -> Status {
    Made made = protocol.make_device(protocol.models().front(), config);
    if (!made) return made.error();
    now = config;
    present.emplace(protocol, std::move(*made));
    return ok();
  };
  const endpoints::ControlledDevice controlled{
      begin,
      [&](const json& change) {
        json changed = now;
        changed.update(change);
        return begin(changed);
      },
      [&] { return present ? &present->device() : nullptr; }};
  std::istringstream lines(to_text(input.subspan(1)));
  for (std::string line; std::getline(lines, line);) {
    const std::string answer = endpoints::answer_control(line, controlled);
    rule(answer.find('\n') + 1 == answer.size(), "an answer is one line");
    [[maybe_unused]] const auto read = endpoints::read_control_answer(answer);
    [[maybe_unused]] const auto other = endpoints::read_control_answer(line);
    if (present && protocol.has_frames()) present->pause(300ms);
  }
}

std::vector<Bytes> good_controls() {
  std::set<Bytes> all;
  for (const vectors::Case& one : cases_of_vectors()) {
    const std::optional<Byte> number = number_of(one.protocol);
    if (!number) continue;
    json memory = json::object(), addresses = json::array();
    for (const auto& [address, hex] : one.memory) {
      memory[address] = hex;
      addresses.push_back(address);
    }
    std::string lines = endpoints::control_line({{"begin", one.config}});
    if (!memory.empty())
      lines += endpoints::control_line({{"set", memory}}) +
               endpoints::control_line({{"get", addresses}});
    for (const vectors::Step& step : one.steps)
      if (!step.action.empty()) lines += endpoints::control_line({{"do", step.action}});
    if (lines.size() < 4000) all.insert(behind(*number, to_bytes(lines)));
  }
  return {all.begin(), all.end()};
}

}  // namespace fieldproof::fuzz
