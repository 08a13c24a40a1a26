// Another client on the line of an emulated XGT PLC: fills its memory, and reads all of it back,
// without the bench. For tests.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <map>
#include <string>

#include "src/plc/model.hpp"

namespace fieldproof::tool_tests {

class PlcClient {
 public:
  /// The free end of the line; closed again with this object, so that the bench can have it.
  explicit PlcClient(const std::string& port)
      : fd_(::open(port.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    EXPECT_GE(fd_, 0) << port;
    termios raw{};
    ::tcgetattr(fd_, &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(fd_, TCSANOW, &raw);
    ::tcflush(fd_, TCIOFLUSH);
  }
  ~PlcClient() { ::close(fd_); }
  PlcClient(const PlcClient&) = delete;
  PlcClient& operator=(const PlcClient&) = delete;

  /// Every word that may be written gets a value of its own, and every second contact of T and C is
  /// on.
  void fill(const plc::PlcModel& model) {
    for_each_block(model, [this](const plc::DeviceArea& area, std::uint32_t first,
                                 std::uint32_t count) {
      std::string data;
      for (std::uint32_t word = first; word < first + count; ++word)
        data += fmt::format(
            "{:04X}", (word * 7919u + static_cast<unsigned>(area.letter) * 257u + 1) & 0xFFFF);
      EXPECT_EQ(ask(fmt::format("WSB{}{:02X}{}", name(area, 'W', first), count, data)).substr(0, 1),
                "\x06");
    });
    for_each_contact(model, [this](const plc::DeviceArea& area, std::uint32_t contact) {
      EXPECT_EQ(
          ask(fmt::format("WSS01{}{:02X}", name(area, 'X', contact), contact % 2)).substr(0, 1),
          "\x06");
    });
  }

  /// All that `fill` writes, as replies by name.
  std::map<std::string, std::string> read(const plc::PlcModel& model) {
    std::map<std::string, std::string> all;
    for_each_block(model, [&](const plc::DeviceArea& area, std::uint32_t first,
                              std::uint32_t count) {
      all[name(area, 'W', first)] = ask(fmt::format("RSB{}{:02X}", name(area, 'W', first), count));
    });
    for_each_contact(model, [&](const plc::DeviceArea& area, std::uint32_t contact) {
      all[name(area, 'X', contact)] = ask("RSS01" + name(area, 'X', contact));
    });
    return all;
  }

 private:
  static std::string name(const plc::DeviceArea& area, char type, std::uint32_t number) {
    const std::string text = fmt::format("%{}{}{}", area.letter, type, number);
    return fmt::format("{:02X}{}", text.size(), text);
  }
  static void for_each_block(const plc::PlcModel& model, const auto& visit) {
    constexpr std::uint32_t most = 60;
    for (const plc::DeviceArea& area : model.areas)
      for (std::uint32_t first = 0; area.write && first < area.words; first += most)
        visit(area, first, std::min(most, area.words - first));
  }
  static void for_each_contact(const plc::PlcModel& model, const auto& visit) {
    for (const plc::DeviceArea& area : model.areas)
      for (std::uint32_t contact = 0; contact < area.contacts; ++contact) visit(area, contact);
  }

  /// Upper-case commands need no BCC, and neither do their replies.
  std::string ask(const std::string& body) {
    const std::string request =
        "\x05"
        "01" +
        body + "\x04";
    EXPECT_EQ(::write(fd_, request.data(), request.size()), static_cast<ssize_t>(request.size()));
    std::string reply;
    pollfd ready{fd_, POLLIN, 0};
    while (reply.find('\x03') == std::string::npos && ::poll(&ready, 1, 20'000) == 1) {
      char buffer[1024];
      const ssize_t got = ::read(fd_, buffer, sizeof buffer);
      if (got <= 0) break;
      reply.append(buffer, static_cast<std::size_t>(got));
    }
    EXPECT_NE(reply, "") << "no answer to " << body;
    return reply;
  }

  int fd_;
};

}  // namespace fieldproof::tool_tests
