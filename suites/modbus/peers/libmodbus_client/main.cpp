// libmodbus_client TTY | tcp PORT: a master made of libmodbus. What it writes one way it reads
// another. 0: all as it should be.
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>

#include "suites/modbus/peers/libmodbus_way.hpp"

namespace {

int failures = 0;

void check(bool right, const char* what) {
  if (right) return;
  ++failures;
  std::fprintf(stderr, "%s: %s\n", what, modbus_strerror(errno));
}

void words_then_bits(modbus_t* line) {
  const std::array<std::uint16_t, 2> words{0x9ABC, 0x1234};
  check(modbus_write_registers(line, 100, 2, words.data()) == 2, "10 writes two registers");
  std::array<std::uint8_t, 32> bits{};
  check(modbus_read_bits(line, 1600, 32, bits.data()) == 32, "01 reads 32 coils");
  for (unsigned i = 0; i < bits.size(); ++i)
    check(bits[i] == (words[i / 16] >> (i % 16) & 1), "01 reads what 10 wrote");
}

void bits_then_words(modbus_t* line) {
  const std::array<std::uint8_t, 10> bits{1, 0, 1, 1, 0, 0, 1, 1, 1, 0};
  check(modbus_write_bits(line, 3200, 10, bits.data()) == 10, "0F writes ten coils");
  std::uint16_t word = 0;
  check(modbus_read_registers(line, 200, 1, &word) == 1 && word == 0x01CD,
        "03 reads what 0F wrote");
  check(modbus_write_bit(line, 3215, 1) == 1, "05 writes a coil");
  check(modbus_read_registers(line, 200, 1, &word) == 1 && word == 0x81CD,
        "03 reads what 05 wrote");
  check(modbus_write_register(line, 201, 0x8001) == 1, "06 writes a register");
  std::array<std::uint8_t, 16> read{};
  check(modbus_read_bits(line, 3216, 16, read.data()) == 16 && read[0] == 1 && read[1] == 0 &&
            read[15] == 1,
        "01 reads what 06 wrote");
}

/// A serial line takes 120 registers at once (Cnet KO 6.4.2), TCP what the protocol carries.
void limits(modbus_t* line, bool tcp) {
  std::array<std::uint16_t, 125> words{};
  check(modbus_read_registers(line, 0, 125, words.data()) == 125, "03 reads 125 registers");
  check(modbus_read_input_registers(line, 0, 125, words.data()) == 125, "04 reads 125 registers");
  std::array<std::uint8_t, 2000> bits{};
  check(modbus_read_input_bits(line, 0, 2000, bits.data()) == 2000, "02 reads 2000 inputs");
  check(modbus_read_registers(line, 1024, 1, words.data()) == -1 && errno == EMBXILADD,
        "03 past the end is exception 02");
  if (tcp)
    check(modbus_write_registers(line, 0, 123, words.data()) == 123, "10 writes 123 registers");
  else
    check(modbus_write_registers(line, 0, 121, words.data()) == -1 && errno == EMBXILVAL,
          "10 with 121 registers is exception 03");
  check(modbus_read_registers(line, 1023, 1, words.data()) == 1,
        "03 reads the last register after that");
}

}  // namespace

int main(int count, char** arguments) {
  const Modbus line = make_modbus("libmodbus_client", count, arguments);
  if (!line) return 2;
  const bool open = modbus_set_slave(line.get(), 1) == 0 && modbus_connect(line.get()) == 0;
  check(open, "open the line");
  if (open) {
    words_then_bits(line.get());
    bits_then_words(line.get());
    limits(line.get(), is_tcp(count, arguments));
    modbus_close(line.get());
  }
  return failures == 0 ? 0 : 1;
}
