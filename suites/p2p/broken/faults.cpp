#include "suites/p2p/broken/faults.hpp"

#include <utility>

namespace fieldproof::p2p_broken {

using p2p::P2pBlock;
using p2p::P2pDriver;
using plc::PlcMemory;

const std::vector<Fault>& faults() {
  static const std::vector<Fault> table = broken::gather<Fault>(
      {trigger_faults, result_faults, xgt_request_faults, xgt_reply_faults, modbus_faults,
       ls_bus_faults, user_frame_faults, udata_faults, narrow_faults, fenet_request_faults,
       fenet_reply_faults, network_faults, modbus_tcp_request_faults, modbus_tcp_answer_faults,
       modbus_tcp_link_faults, user_frame_network_faults});
  return table;
}

MakeBehaviour trigger(Trigger trigger) {
  return [=] { return Behaviour{.trigger = trigger}; };
}

MakeBehaviour timing(std::function<void(p2p::P2pClient::Timing& timing)> edit) {
  return [=] { return Behaviour{.timing = edit}; };
}

MakeBehaviour deaf_to(std::string action) {
  return [=] { return Behaviour{.deaf_to = action}; };
}

MakeBehaviour works_with(std::function<void(p2p::P2pParameters& parameters)> edit) {
  return [=] { return Behaviour{.works_with = edit}; };
}

MakeBehaviour each_block(std::function<void(P2pBlock& block)> edit) {
  return works_with(
      [=](p2p::P2pParameters& parameters) { std::ranges::for_each(parameters.blocks, edit); });
}

MakeBehaviour shows(std::function<void(p2p::P2pParameters& parameters)> edit) {
  return [=] { return Behaviour{.shows = edit}; };
}

MakeBehaviour shows_blocks(std::function<void(P2pBlock& block)> edit) {
  return shows(
      [=](p2p::P2pParameters& parameters) { std::ranges::for_each(parameters.blocks, edit); });
}

MakeBehaviour ends(std::function<void(const Outcome& before, Outcome& now)> edit) {
  return [=] {
    return Behaviour{.ends = [=](const Outcome& before, Outcome& now) {
      edit(before, now);
      return false;
    }};
  };
}

MakeBehaviour hides(std::uint16_t status) {
  return ends([=](const Outcome& before, Outcome& now) {
    if (now.status == status) now = before;
  });
}

MakeBehaviour asks_for(std::function<void(P2pBlock& block)> edit) {
  return [=] {
    return Behaviour{.asks = [=](P2pDriver& good, P2pBlock block, const PlcMemory& memory) {
      edit(block);
      return good.request(block, memory);
    }};
  };
}

MakeBehaviour spoils(std::function<void(Bytes& request)> edit) {
  return [=] {
    return Behaviour{.asks = [=](P2pDriver& good, const P2pBlock& block, const PlcMemory& memory) {
      Result<Bytes> request = good.request(block, memory);
      if (request) edit(*request);
      return request;
    }};
  };
}

MakeBehaviour hears(std::function<void(Bytes& reply, const P2pBlock& block)> edit) {
  return takes([=](const P2pDriver& good, const P2pBlock& block, Bytes frame, PlcMemory& memory) {
    edit(frame, block);
    return good.take(block, frame, memory);
  });
}

MakeBehaviour takes(
    std::function<std::optional<std::uint16_t>(const P2pDriver& good, const P2pBlock& block,
                                               Bytes frame, PlcMemory& memory)>
        own) {
  return [=] { return Behaviour{.takes = own}; };
}

MakeBehaviour after_saving(std::function<void(const P2pBlock& block, PlcMemory& memory)> edit) {
  return takes(
      [=](const P2pDriver& good, const P2pBlock& block, const Bytes& frame, PlcMemory& memory) {
        const auto error = good.take(block, frame, memory);
        if (error == p2p::p2p_error::none && block.function != P2pBlock::Function::write)
          edit(block, memory);
        return error;
      });
}

Behaviour does_not_reconnect() {
  return {.does = [](std::vector<Burst>& doings) {
    std::erase_if(doings, [](const Burst& one) { return one.link > first_own_link; });
  }};
}

}  // namespace fieldproof::p2p_broken
