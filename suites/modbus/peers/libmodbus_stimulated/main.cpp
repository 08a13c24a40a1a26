// libmodbus_stimulated TTY | tcp PORT: a master made of libmodbus, as a device under test in the
// client role. What it asks comes as lines of JSON on standard input (README 'The module as
// client'): at once, or at the pace of a clock until "over". Ends with its input; what failed is
// told on standard error.
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "suites/modbus/peers/libmodbus_way.hpp"

namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::milliseconds;

struct Job {
  json line;
  Milliseconds period{};
  Clock::time_point next{};
};

/// A key may hold one text, or a list of one.
std::string text_at(const json& block, const char* key) {
  const json& value = block.at(key);
  return (value.is_array() ? value.at(0) : value).get<std::string>();
}

Milliseconds period_of(const json& block) {
  const std::string flag = block.value("flag", "");
  for (const auto& [name, period] : {std::pair{"F90", 20},
                                     {"F92", 200},
                                     {"F93", 1000},
                                     {"_T20MS", 20},
                                     {"_T200MS", 200},
                                     {"_T1S", 1000}})
    if (flag == name) return Milliseconds(period);
  return Milliseconds::zero();
}

/// The elements of hex digits: four a word, two a bit.
template <typename T>
std::vector<T> values_of(const std::string& hex, std::size_t digits, std::size_t count) {
  std::vector<T> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(static_cast<T>(std::stoul(hex.substr(i * digits, digits), nullptr, 16)));
  return values;
}

int write(modbus_t* line, const json& block, const std::string& hex, char table, int address,
          int count) {
  const bool single = block.value("command", "single") == "single";
  if (table == '0') {
    const auto bits = values_of<std::uint8_t>(hex, 2, static_cast<std::size_t>(count));
    return single ? modbus_write_bit(line, address, bits.front())
                  : modbus_write_bits(line, address, count, bits.data());
  }
  const auto words = values_of<std::uint16_t>(hex, 4, static_cast<std::size_t>(count));
  return single ? modbus_write_register(line, address, words.front())
                : modbus_write_registers(line, address, count, words.data());
}

int read(modbus_t* line, char table, int address, int count) {
  std::vector<std::uint8_t> bits(2000);
  std::vector<std::uint16_t> words(125);
  switch (table) {
    case '0': return modbus_read_bits(line, address, count, bits.data());
    case '1': return modbus_read_input_bits(line, address, count, bits.data());
    case '3': return modbus_read_input_registers(line, address, count, words.data());
    default: return modbus_read_registers(line, address, count, words.data());
  }
}

/// A connection that the partner has closed between two requests is made anew; a terminal is not
/// closed.
void connect_again_if_closed(modbus_t* line) {
  char byte = 0;
  if (::recv(modbus_get_socket(line), &byte, 1, MSG_PEEK | MSG_DONTWAIT) > 0 || errno == EAGAIN ||
      errno == ENOTSOCK)
    return;
  modbus_close(line);
  modbus_connect(line);
}

void ask(modbus_t* line, const json& request) {
  errno = 0;
  connect_again_if_closed(line);
  const json& block = request.at("block");
  const bool writes = block.value("function", "read") == "write";
  const std::string partner = text_at(block, writes ? "save" : "read");  // "0x40001"
  const int address = std::stoi(partner.substr(3), nullptr, 16), count = block.value("size", 1);
  modbus_set_slave(line, block.value("station", 1));
  const int done = writes ? write(line, block, request.at("values").at(text_at(block, "read")),
                                  partner.at(2), address, count)
                          : read(line, partner.at(2), address, count);
  if (done >= 0) return;
  std::fprintf(stderr, "libmodbus_stimulated: %s: %s\n", partner.c_str(), modbus_strerror(errno));
  modbus_flush(line);
}

void take(modbus_t* line, const std::string& text, std::vector<Job>& jobs) {
  try {
    const json request = json::parse(text);
    if (request.value("over", false)) return jobs.clear();
    const Milliseconds period = period_of(request.at("block"));
    if (period == Milliseconds::zero()) return ask(line, request);
    jobs.push_back({request, period, Clock::now() + period});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "libmodbus_stimulated: cannot take the line %s: %s\n", text.c_str(),
                 error.what());
  }
}

/// What is due, and how long to wait for the next; -1: nothing is.
int run_due(modbus_t* line, std::vector<Job>& jobs) {
  for (Job& job : jobs) {
    if (Clock::now() < job.next) continue;
    job.next += job.period;
    ask(line, job.line);
  }
  const auto next = std::ranges::min_element(jobs, {}, &Job::next);
  if (next == jobs.end()) return -1;
  return static_cast<int>(
      std::max<long long>(0, std::chrono::ceil<Milliseconds>(next->next - Clock::now()).count()));
}

}  // namespace

int main(int count, char** arguments) {
  const Modbus line = make_modbus("libmodbus_stimulated", count, arguments);
  if (!line) return 2;
  if (modbus_connect(line.get()) != 0) {
    std::fprintf(stderr, "libmodbus_stimulated: cannot open %s: %s\n", arguments[count - 1],
                 modbus_strerror(errno));
    return 3;
  }
  modbus_set_response_timeout(line.get(), 0, 500'000);
  std::vector<Job> jobs;
  std::string heard;
  for (int wait = -1;;) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (::poll(&input, 1, wait) > 0) {
      char buffer[4096];
      const ssize_t size = ::read(STDIN_FILENO, buffer, sizeof buffer);
      if (size <= 0) return 0;
      heard.append(buffer, static_cast<std::size_t>(size));
    }
    for (std::size_t end = 0; (end = heard.find('\n')) != std::string::npos;
         heard.erase(0, end + 1))
      take(line.get(), heard.substr(0, end), jobs);
    wait = run_due(line.get(), jobs);
  }
}
