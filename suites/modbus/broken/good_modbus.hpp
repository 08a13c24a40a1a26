// The good Modbus server behind a fault, asked one message at a time: station and PDU, whatever the
// mode.
#pragma once

#include "src/modbus/frame.hpp"
#include "suites/broken/good_device.hpp"

namespace fieldproof::modbus_broken {

class GoodModbus : public broken::GoodDevice {
 public:
  GoodModbus(modbus::ModbusMode mode, std::unique_ptr<plc::EmulatedDevice> device, Byte station)
      : broken::GoodDevice(std::move(device)), mode_(mode), station_(station) {}

  modbus::ModbusMode mode() const { return mode_; }
  Byte station() const { return station_; }

  /// A message with its right check, and in ASCII with head and tail.
  Bytes frame(ByteView message) const {
    return modbus::encode_modbus_frame(mode_, message[0], message.subspan(1));
  }
  /// The message of a frame; empty where the frame is damaged.
  Bytes message(ByteView frame) const;

  /// The reply to a message, as a message; empty: silence.
  Bytes ask(ByteView message);
  /// The same for the own station, whichever `message` names.
  Bytes ask_as_own(Bytes message);

 private:
  modbus::ModbusMode mode_;
  Byte station_;
};

// Parts of a message. A fault looks at them only where the good server has understood the request.
inline Byte function_of(const Bytes& message) { return message.size() > 1 ? message[1] : Byte{}; }
unsigned word_at(const Bytes& message, std::size_t at);  // 0 where there is none
void put_word(Bytes& message, std::size_t at, unsigned value);
constexpr std::size_t address_at = 2, count_at = 4, value_at = 4;

bool is_read(Byte function);
bool is_bits(Byte function);
constexpr Byte function_error = 1, address_error = 2, value_error = 3;
/// 0: no exception.
Byte exception_of(const Bytes& reply);
Bytes exception_to(const Bytes& request, Byte code);

/// The data of the reply to a read; of a request 0F or 10.
Bytes data_of_read(const Bytes& reply);
Bytes data_of_write(const Bytes& request);
Bytes read_reply(const Bytes& request, const Bytes& data);
Bytes write_many(const Bytes& request, unsigned address, unsigned count, const Bytes& data);

}  // namespace fieldproof::modbus_broken
