#include "suites/xgt_cnet/broken/faults.hpp"

#include <algorithm>

namespace fieldproof::xgt_cnet_broken {

const std::vector<Fault>& faults() {
  static const std::vector<Fault> table =
      broken::gather<Fault>({check_faults, reply_faults, data_faults, limit_faults, monitor_faults,
                             line_faults, narrow_faults});
  return table;
}

const Fault* find_fault(std::string_view name) { return broken::find_by_name(faults(), name); }

MakeBehaviour answer_with(std::function<Bytes(const Bytes& request, GoodPlc& plc)> answer) {
  return [answer = std::move(answer)](Storage&) {
    Behaviour behaviour;
    behaviour.answer = [answer](const Bytes& request, bool, GoodPlc& plc) {
      return broken::Sendings{{answer(request, plc)}};
    };
    return behaviour;
  };
}

MakeBehaviour misread(std::function<Bytes(const Bytes& request, GoodPlc& plc)> read) {
  return answer_with([read = std::move(read)](const Bytes& request, GoodPlc& plc) {
    return plc.answer(read(request, plc));
  });
}

MakeBehaviour spoil_frame(std::function<void(FrameText& reply, const FrameText& request)> edit) {
  return answer_with([edit = std::move(edit)](const Bytes& request, GoodPlc& plc) {
    const Bytes reply = plc.answer(request);
    if (reply.empty()) return reply;
    FrameText text = take_apart(reply);
    edit(text, take_apart(request));
    return text.bytes();
  });
}

MakeBehaviour edit_reply(std::function<void(FrameText& reply, const FrameText& request)> edit) {
  return spoil_frame([edit = std::move(edit)](FrameText& reply, const FrameText& request) {
    edit(reply, request);
    reply.seal();
  });
}

MakeBehaviour send_with(std::function<broken::Sendings(const Bytes& request, Bytes reply)> send) {
  return [send = std::move(send)](Storage&) {
    Behaviour behaviour;
    behaviour.answer = [send](const Bytes& request, bool, GoodPlc& plc) {
      Bytes reply = plc.answer(request);
      return reply.empty() ? broken::Sendings{} : send(request, std::move(reply));
    };
    return behaviour;
  };
}

}  // namespace fieldproof::xgt_cnet_broken
