// libmodbus_server TTY | tcp PORT: a server made of libmodbus, as a device under test that nobody
// here has written. Station 1; by TCP whatever the unit, on any number of connections. Its memory
// is laid out as that of an XBC-DxxxH with all four bases at M0: coils and inputs are the bits of
// the words, input registers are the holding registers.
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "suites/modbus/peers/libmodbus_way.hpp"

namespace {

constexpr int station = 1;
constexpr int words = 1024;  // M of an XBC-DxxxH
constexpr int bits = 9999;   // data addresses

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

/// The mapping and the view of it: inputs are the same bits, input registers the same words.
class Memory {
 public:
  Memory() : mapping_(modbus_mapping_new(bits, 0, words, 0)) {
    if (!mapping_) return;
    view_ = *mapping_;
    view_.nb_input_bits = bits;
    view_.tab_input_bits = view_.tab_bits;
    view_.nb_input_registers = words;
    view_.tab_input_registers = view_.tab_registers;
  }
  explicit operator bool() const { return mapping_ != nullptr; }

  void answer(modbus_t* line, const std::uint8_t* request, int length) {
    if (modbus_reply(line, request, length, &view_) < 0) return;
    const int function = request[modbus_get_header_length(line)];
    if (function == MODBUS_FC_WRITE_SINGLE_COIL || function == MODBUS_FC_WRITE_MULTIPLE_COILS)
      words_from_bits(view_);
    else
      bits_from_words(view_);
  }

 private:
  std::unique_ptr<modbus_mapping_t, FreeModbus> mapping_;
  modbus_mapping_t view_{};
};

int serve_line(modbus_t* line, Memory& memory) {
  if (modbus_set_slave(line, station) != 0 || modbus_connect(line) != 0)
    return complain("open the terminal");
  for (std::uint8_t request[MODBUS_RTU_MAX_ADU_LENGTH];;) {
    const int length = modbus_receive(line, request);
    if (length < 0 && (errno == EIO || errno == EBADF || errno == ECONNRESET))
      return 0;                                            // the line is gone
    if (length > 0) memory.answer(line, request, length);  // else a wrong CRC, another station
  }
}

/// One request of one connection; false: the connection is over.
bool serve_once(modbus_t* line, int connection, Memory& memory) {
  modbus_set_socket(line, connection);
  std::uint8_t request[MODBUS_TCP_MAX_ADU_LENGTH];
  const int length = modbus_receive(line, request);
  if (length > 0) memory.answer(line, request, length);
  return length >= 0;
}

int serve_connections(modbus_t* line, Memory& memory) {
  int listening = modbus_tcp_listen(line, 16);
  if (listening < 0) return complain("listen");
  std::vector<pollfd> fds{pollfd{listening, POLLIN, 0}};
  while (::poll(fds.data(), fds.size(), -1) > 0) {
    for (std::size_t i = fds.size() - 1; i > 0; --i) {
      if (fds[i].revents == 0 || serve_once(line, fds[i].fd, memory)) continue;
      ::close(fds[i].fd);
      fds.erase(fds.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (fds[0].revents == 0) continue;
    if (const int connection = modbus_tcp_accept(line, &listening); connection >= 0)
      fds.push_back({connection, POLLIN, 0});
  }
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  const Modbus line = make_modbus("libmodbus_server", count, arguments);
  if (!line) return 2;
  // Its server sleeps for the response time before some exceptions, and waits for the rest of a
  // frame for the byte time, when nobody else is served: half a second by default, which is just
  // what the profile allows for an answer.
  modbus_set_response_timeout(line.get(), 0, 20'000);
  modbus_set_byte_timeout(line.get(), 0, is_tcp(count, arguments) ? 350'000 : 50'000);
  Memory memory;
  if (!memory) return complain("make the memory");
  return is_tcp(count, arguments) ? serve_connections(line.get(), memory)
                                  : serve_line(line.get(), memory);
}
