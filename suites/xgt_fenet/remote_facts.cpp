#include "suites/xgt_fenet/remote_facts.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "src/plc/config_reader.hpp"
#include "src/xgt_fenet/remote.hpp"

namespace fieldproof::xgt_fenet_suite {

namespace {

constexpr const char* whose = "facts of the remote service";

Status check_service(const nlohmann::json& facts) {
  constexpr std::array<std::string_view, 4> keys{"channels", "port", "service", "transport"};
  if (const Status known = plc::known_keys(facts, whose, keys); !known) return known;
  const std::string service = facts.value("service", "");
  if (service != "remote server" && service != "remote client")
    return fail("there is no service '" + service + "'; use remote server or remote client");
  if (facts.value("transport", "") != "tcp") return fail("it is over tcp");
  if (facts.value("port", 0) != xgt_fenet::remote_port)
    return fail("its port is " + std::to_string(xgt_fenet::remote_port));
  if (facts.value("channels", 0u) != xgt_fenet::remote_channels)
    return fail("it has " + std::to_string(xgt_fenet::remote_channels) + " channel");
  return ok();
}

}  // namespace

bool is_remote_fact(const nlohmann::json& facts) {
  return facts.contains("remote") || facts.contains("service");
}

Status check_remote_fact(const nlohmann::json& facts) {
  if (facts.contains("service")) return check_service(facts);
  constexpr std::array<std::string_view, 3> keys{"accepted", "remote", "says"};
  if (const Status known = plc::known_keys(facts, whose, keys); !known) return known;
  const auto read = xgt_fenet::read_remote(facts["remote"]);
  if (bool(read) != facts.value("accepted", true))
    return fail(read ? "it is accepted" : "it is refused: " + read.error().message);
  const std::string says = facts.value("says", "");
  if (!read && read.error().message.find(says) == std::string::npos)
    return fail("it does not say '" + says + "': " + read.error().message);
  return ok();
}

}  // namespace fieldproof::xgt_fenet_suite
