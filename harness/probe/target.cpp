#include "harness/probe/target.hpp"

#include "harness/endpoints/kinds.hpp"

namespace fieldproof::probe {

using endpoints::EndpointName;

bool is_emulator(const EndpointName& name) { return endpoints::kind_of(name).emulated; }

bool has_line_settings(const EndpointName& name) {
  const endpoints::KindOf& kind = endpoints::kind_of(name);
  return kind.simulated || kind.line == endpoints::LineOption::port;
}

EndpointName with_settings(EndpointName name, const line::LineSettings& line) {
  if (!has_line_settings(name)) return name;
  if (!is_emulator(name)) return endpoints::with_line(std::move(name), line);
  name.options["bench_line"] = to_string(line);
  return name;
}

LineOpener line_opener(const EndpointName& name, const harness::Protocol& protocol) {
  return [name, &protocol](const line::LineSettings& line) {
    return endpoints::open_endpoint(with_settings(name, line), protocol);
  };
}

EndpointName name_of_found(const EndpointName& name, const Trial& found, bool settable) {
  if (is_emulator(name)) return name;
  EndpointName result = settable ? with_settings(name, found.line) : name;
  result.options["station"] = std::to_string(found.station);
  result.options["protocol"] = found.protocol->name();
  return result;
}

std::string to_string(const EndpointName& name) {
  std::string text = name.kind + ':' + name.target;
  char mark = '?';
  for (const auto& [key, value] : name.options) {
    text += mark + key + '=' + value;
    mark = '&';
  }
  return text;
}

}  // namespace fieldproof::probe
