#include "suites/modbus/broken/good_modbus.hpp"

#include <algorithm>

namespace fieldproof::modbus_broken {

Bytes GoodModbus::message(ByteView frame) const {
  const modbus::ModbusFrame decoded = modbus::decode_modbus_frame(mode_, frame);
  if (decoded.fault != 0) return {};
  Bytes message{decoded.station};
  message.insert(message.end(), decoded.pdu.begin(), decoded.pdu.end());
  return message;
}

Bytes GoodModbus::ask(ByteView request) {
  const Bytes reply = answer(frame(request));
  return reply.empty() ? Bytes{} : message(reply);
}

Bytes GoodModbus::ask_as_own(Bytes request) {
  request[0] = station_;
  return ask(request);
}

unsigned word_at(const Bytes& message, std::size_t at) {
  return at + 1 < message.size() ? message[at] * 256u + message[at + 1] : 0;
}

void put_word(Bytes& message, std::size_t at, unsigned value) {
  message[at] = static_cast<Byte>(value >> 8);
  message[at + 1] = static_cast<Byte>(value);
}

bool is_read(Byte function) { return function >= 0x01 && function <= 0x04; }
bool is_bits(Byte function) {
  return function == 0x01 || function == 0x02 || function == 0x05 || function == 0x0F;
}

Byte exception_of(const Bytes& reply) {
  return reply.size() > 2 && (reply[1] & 0x80) ? reply[2] : Byte{};
}

Bytes exception_to(const Bytes& request, Byte code) {
  return {request[0], static_cast<Byte>(request[1] | 0x80), code};
}

Bytes data_of_read(const Bytes& reply) {
  return reply.size() < 3 ? Bytes{} : Bytes(reply.begin() + 3, reply.end());
}

Bytes data_of_write(const Bytes& request) {
  return request.size() < 7 ? Bytes{} : Bytes(request.begin() + 7, request.end());
}

Bytes read_reply(const Bytes& request, const Bytes& data) {
  Bytes reply{request[0], request[1], static_cast<Byte>(data.size())};
  reply.insert(reply.end(), data.begin(), data.end());
  return reply;
}

Bytes write_many(const Bytes& request, unsigned address, unsigned count, const Bytes& data) {
  Bytes message{request[0], request[1], 0, 0, 0, 0, static_cast<Byte>(data.size())};
  put_word(message, address_at, address);
  put_word(message, count_at, count);
  message.insert(message.end(), data.begin(), data.end());
  return message;
}

}  // namespace fieldproof::modbus_broken
