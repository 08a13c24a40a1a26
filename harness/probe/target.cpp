#include "harness/probe/target.hpp"

namespace fieldproof::probe {

using endpoints::EndpointName;

bool is_emulator(const EndpointName& name) { return name.kind == "emulator" || name.kind == "pty"; }

bool has_line_settings(const EndpointName& name) {
  return name.kind == "emulator" || name.kind == "serial" || name.kind == "rfc2217";
}

EndpointName with_settings(EndpointName name, const line::LineSettings& line) {
  if (!has_line_settings(name)) return name;
  const std::string text = line::to_string(line);
  if (is_emulator(name)) {
    name.options["bench_line"] = text;
    return name;
  }
  const std::size_t dash = text.find('-');
  name.options["baud"] = text.substr(0, dash);
  name.options["frame"] = text.substr(dash + 1);
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
