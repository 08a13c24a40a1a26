#include "suites/modbus/broken/faults.hpp"

namespace fieldproof::modbus_broken {

const std::vector<Fault>& faults() {
  static const std::vector<Fault> table = broken::gather<Fault>(
      {frame_faults, exception_faults, limit_faults, data_faults, line_faults, narrow_faults});
  return table;
}

const Fault* find_fault(std::string_view name) { return broken::find_by_name(faults(), name); }

MakeBehaviour answer_frame(std::function<Bytes(const Bytes& frame, GoodModbus& plc)> answer) {
  return [answer = std::move(answer)] {
    Behaviour behaviour;
    behaviour.answer = [answer](const Bytes& frame, GoodModbus& plc) {
      return broken::Sendings{{answer(frame, plc)}};
    };
    return behaviour;
  };
}

MakeBehaviour answer_with(std::function<Bytes(const Bytes& request, GoodModbus& plc)> answer) {
  return answer_frame([answer = std::move(answer)](const Bytes& frame, GoodModbus& plc) {
    const Bytes request = plc.message(frame);
    const Bytes reply = request.empty() ? Bytes{} : answer(request, plc);
    return reply.empty() ? Bytes{} : plc.frame(reply);
  });
}

MakeBehaviour edit_reply(std::function<void(Bytes& reply, const Bytes& request)> edit) {
  return answer_with([edit = std::move(edit)](const Bytes& request, GoodModbus& plc) {
    Bytes reply = plc.ask(request);
    if (!reply.empty()) edit(reply, request);
    return reply;
  });
}

MakeBehaviour spoil_frame(std::function<void(Bytes& frame)> spoil) {
  return answer_frame([spoil = std::move(spoil)](const Bytes& frame, GoodModbus& plc) {
    Bytes reply = plc.answer(frame);
    if (!reply.empty()) spoil(reply);
    return reply;
  });
}

MakeBehaviour misread(std::function<Bytes(Bytes request)> read) {
  return answer_with([read = std::move(read)](const Bytes& request, GoodModbus& plc) {
    return plc.ask(read(request));
  });
}

MakeBehaviour send_with(std::function<broken::Sendings(const Bytes& frame, Bytes reply)> send) {
  return [send = std::move(send)] {
    Behaviour behaviour;
    behaviour.answer = [send](const Bytes& frame, GoodModbus& plc) {
      Bytes reply = plc.answer(frame);
      return reply.empty() ? broken::Sendings{} : send(frame, std::move(reply));
    };
    return behaviour;
  };
}

}  // namespace fieldproof::modbus_broken
