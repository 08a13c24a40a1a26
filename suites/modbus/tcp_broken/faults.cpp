#include "suites/modbus/tcp_broken/faults.hpp"

namespace fieldproof::modbus_tcp_broken {

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all =
      broken::gather<Fault>({header_faults, stream_faults, connection_faults, data_faults});
  return all;
}

MakeBehaviour edits(std::function<void(Bytes&, const Bytes&)> edit) {
  return [=] { return Behaviour{.edit = edit}; };
}
MakeBehaviour misreads(std::function<Bytes(Bytes)> misread) {
  return [=] { return Behaviour{.misread = misread}; };
}
MakeBehaviour hears(std::function<Bursts(Burst, Server&)> hear) {
  return [=] { return Behaviour{.hear = hear}; };
}
MakeBehaviour acts(std::function<void(Bursts&, Server&)> act) {
  return [=] { return Behaviour{.act = act}; };
}
MakeBehaviour set_up(std::function<void(modbus::TcpServerConfig&)> settings) {
  return [=] { return Behaviour{.settings = settings}; };
}

Bytes exception_to(const Bytes& request, Byte code) {
  Bytes reply(request.begin(), request.begin() + pdu_at);
  reply.insert(reply.end(), {static_cast<Byte>(function_of(request) | 0x80), code});
  set_length(reply);
  return reply;
}

}  // namespace fieldproof::modbus_tcp_broken
