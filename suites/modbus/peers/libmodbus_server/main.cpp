// libmodbus_server TTY: an RTU server made of libmodbus, as a device under test that nobody here
// has written. Station 1. Its memory is laid out as that of an XBC-DxxxH with all four bases at M0:
// coils and inputs are the bits of the words, input registers are the holding registers.
#include <modbus/modbus.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>

namespace {

constexpr int station = 1;
constexpr int words = 1024;  // M of an XBC-DxxxH
constexpr int bits = 9999;   // data addresses

struct Deleter {
  void operator()(modbus_t* context) const { modbus_free(context); }
  void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
};

void words_from_bits(modbus_mapping_t& memory) {
  for (int i = 0; i < bits; ++i) {
    const auto bit = static_cast<std::uint16_t>(1u << (i % 16));
    std::uint16_t& word = memory.tab_registers[i / 16];
    word = static_cast<std::uint16_t>(memory.tab_bits[i] ? word | bit : word & ~bit);
  }
}

void bits_from_words(modbus_mapping_t& memory) {
  for (int i = 0; i < bits; ++i) memory.tab_bits[i] = memory.tab_registers[i / 16] >> (i % 16) & 1;
}

int complain(const char* what) {
  std::fprintf(stderr, "libmodbus_server: cannot %s: %s\n", what, modbus_strerror(errno));
  return 3;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: libmodbus_server TTY\n");
    return 2;
  }
  const std::unique_ptr<modbus_t, Deleter> line(modbus_new_rtu(arguments[1], 9600, 'N', 8, 1));
  if (!line || modbus_set_slave(line.get(), station) != 0 || modbus_connect(line.get()) != 0)
    return complain("open the terminal");
  // Its server sleeps for the response time before some exceptions, and waits for the rest of a
  // frame for the byte time.
  modbus_set_response_timeout(line.get(), 0, 20'000);
  modbus_set_byte_timeout(line.get(), 0, 50'000);
  const std::unique_ptr<modbus_mapping_t, Deleter> memory(modbus_mapping_new(bits, 0, words, 0));
  if (!memory) return complain("make the memory");
  modbus_mapping_t view = *memory;
  view.nb_input_bits = bits;
  view.tab_input_bits = view.tab_bits;
  view.nb_input_registers = words;
  view.tab_input_registers = view.tab_registers;

  for (std::uint8_t request[MODBUS_RTU_MAX_ADU_LENGTH];;) {
    const int length = modbus_receive(line.get(), request);
    if (length < 0 && (errno == EIO || errno == EBADF || errno == ECONNRESET))
      return 0;                 // the line is gone
    if (length <= 0) continue;  // a wrong CRC, another station
    if (modbus_reply(line.get(), request, length, &view) < 0) continue;
    const int function = request[1];
    if (function == MODBUS_FC_WRITE_SINGLE_COIL || function == MODBUS_FC_WRITE_MULTIPLE_COILS)
      words_from_bits(view);
    else
      bits_from_words(view);
  }
}
