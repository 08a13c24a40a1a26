#include "suites/xgt_fenet/broken/faults.hpp"

#include <numeric>

namespace fieldproof::xgt_fenet_broken {

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all =
      broken::gather<Fault>({header_faults, check_faults, code_faults, data_faults, limit_faults,
                             stream_faults, connection_faults, datagram_faults, counter_faults});
  return all;
}

MakeBehaviour edits_if(bool (*of)(const Bytes&, const Bytes&), std::function<void(Bytes&)> edit) {
  return edits([of, edit](Bytes& reply, const Bytes& request) {
    if (!of(reply, request)) return;
    edit(reply);
    mend(reply);
  });
}

Byte sum_of_header(const Bytes& frame) {
  return static_cast<Byte>(std::accumulate(frame.begin(), frame.begin() + check_at, 0u));
}

void mend(Bytes& frame) {
  if (frame.size() > check_at) frame[check_at] = sum_of_header(frame);
}

Bytes refusal_of(const Bytes& request, unsigned code) {
  Bytes reply(request.begin(), request.begin() + body_at);
  put_word(reply, plc_info_at, 0x0107);
  reply[cpu_at] = 0xB0;
  reply[source_at] = 0x11;
  put_word(reply, length_at, 10);
  reply[position_at] = 1;
  for (const unsigned word :
       {word_at(request, command_at) + 1, word_at(request, type_at), 0u, 0xFFFFu, code}) {
    reply.push_back(static_cast<Byte>(word));
    reply.push_back(static_cast<Byte>(word >> 8));
  }
  mend(reply);
  return reply;
}

std::vector<Name> names_of(const Bytes& request) {
  std::vector<Name> names;
  std::size_t at = name_length_at;
  for (unsigned left = word_at(request, count_at); left > 0 && at + 2 <= request.size(); --left) {
    const std::size_t size = word_at(request, at);
    if (at + 2 + size > request.size()) break;
    names.push_back({at + 2, size});
    at += 2 + size;
  }
  return names;
}

std::vector<Name> data_of(const Bytes& frame) {
  std::vector<Name> data;
  std::size_t at = data_size_at;
  unsigned left = word_at(frame, reply_blocks_at);
  if (frame.size() > command_at && (frame[command_at] & 1) == 0) {
    const std::vector<Name> names = names_of(frame);
    left = static_cast<unsigned>(names.size());
    at = names.empty() ? frame.size() : names.back().at + names.back().size;
  }
  for (; left > 0 && at + 2 <= frame.size(); --left) {
    const std::size_t size = word_at(frame, at);
    if (at + 2 + size > frame.size()) break;
    data.push_back({at + 2, size});
    at += 2 + size;
  }
  return data;
}

}  // namespace fieldproof::xgt_fenet_broken
