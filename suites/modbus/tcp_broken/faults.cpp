#include "suites/modbus/tcp_broken/faults.hpp"

namespace fieldproof::modbus_tcp_broken {

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = broken::gather<Fault>(
      {header_faults, stream_faults, connection_faults, data_faults, xinje_faults});
  return all;
}

Bytes exception_to(const Bytes& request, Byte code) {
  Bytes reply(request.begin(), request.begin() + pdu_at);
  reply.insert(reply.end(), {static_cast<Byte>(function_of(request) | 0x80), code});
  set_length(reply);
  return reply;
}

}  // namespace fieldproof::modbus_tcp_broken
