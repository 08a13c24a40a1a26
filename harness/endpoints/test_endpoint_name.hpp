// What tests of the endpoints share: a name made of parts, a protocol of a network, and
// test_link.hpp.
#pragma once

#include "harness/endpoints/endpoint.hpp"
#include "harness/system/test_link.hpp"
#include "harness/test_protocol.hpp"

namespace fieldproof::endpoints::test {

inline EndpointName endpoint_name(std::string kind, std::string target,
                                  std::map<std::string, std::string> options = {}) {
  return {std::move(kind), std::move(target), std::move(options)};
}

/// One that runs on a port.
struct NetworkProtocol : harness::TestProtocol {
  explicit NetworkProtocol(std::uint16_t port = 502) : port_(port) {}
  std::uint16_t default_port() const override { return port_; }

 private:
  std::uint16_t port_;
};

/// "1 data 'abc'", "1 closed", "-" for nothing within `patience`, or the error; links of the device
/// are counted from first_own_link: "own 0 opened".
inline std::string next_event(Endpoint& endpoint, Duration patience = 30s) {
  const Result<Burst> burst = endpoint.receive(endpoint.now() + patience);
  if (!burst) return burst.error().message;
  if (burst->event == LinkEvent::data && burst->bytes.empty()) return "-";
  const char* events[] = {"data", "datagram", "opened", "closed", "reset"};
  std::string text = burst->link < first_own_link ? "" : "own ";
  text += std::to_string(burst->link % first_own_link) + ' ' +
          events[static_cast<std::size_t>(burst->event)];
  return burst->bytes.empty() ? text : text + " '" + to_text(burst->bytes) + '\'';
}

}  // namespace fieldproof::endpoints::test
