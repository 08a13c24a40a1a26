#include "src/email/esend_driver.hpp"

#include <fmt/format.h>

#include "src/email/smtp_dialogue.hpp"

namespace fieldproof::email {

// A request that cannot be made ends its block with this code.
static_assert(p2p::p2p_error::send == email_status::off);

Status EsendDriver::check(const p2p::P2pBlock& block, const plc::PlcModel& model) const {
  if (block.function != p2p::P2pBlock::Function::esend) return ok();
  if (const Status numbers = check_numbers(settings_, block.message, block.address); !numbers)
    return numbers;
  const Message& message = settings_.messages.at(block.message);
  if (block.variables.size() != message.memory_parts())
    return fail(
        fmt::format("data has {} addresses, and message {} has {} parts of the form mb; "
                    "give an address for each",
                    block.variables.size(), block.message, message.memory_parts()));
  auto area = block.variables.begin();
  for (const MessagePart& part : message.parts) {
    if (part.memory_bytes == 0) continue;
    if (!plc::fits(model, (area++)->own, part.memory_bytes))
      return fail(fmt::format("data: the area ends before the last of {} bytes of message {}",
                              part.memory_bytes, block.message));
  }
  return ok();
}

Result<Bytes> EsendDriver::request(const p2p::P2pBlock& block, const plc::PlcMemory& memory) {
  if (!settings_.use) return fail("e-mail is switched off; set 'use' in p2p.email");
  std::vector<Bytes> data;
  for (const MessagePart& part : settings_.messages.at(block.message).parts) {
    if (part.memory_bytes == 0) continue;
    const plc::DeviceAddress& first = block.variables.at(data.size()).own;
    Bytes& bytes = data.emplace_back();
    for (unsigned i = 0; i < part.memory_bytes; ++i)
      bytes.push_back(static_cast<Byte>(memory.read(first + i)));
  }
  mail_ = make_mail(settings_, {block.message, block.address}, data);
  return to_bytes(mail_.content);
}

std::optional<std::uint16_t> EsendDriver::take(const p2p::P2pBlock&, ByteView frame,
                                               plc::PlcMemory&) const {
  return frame[0];
}

void EsendDriver::receive(const Burst& burst, plc::FrameSink& sink) {
  sink.on_frame(burst.bytes, burst.end());
}

Bytes ended_with(std::uint16_t status) {
  return {static_cast<Byte>(status)};  // none has a high byte
}

}  // namespace fieldproof::email
