#include "harness/endpoints/serial.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "harness/endpoints/test_endpoint_name.hpp"
#include "harness/system/fd_link.hpp"
#include "harness/system/kernel_termios.hpp"
#include "harness/system/pty_pair.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::endpoints {
namespace {

using endpoints::test::endpoint_name;
using os::test::receive_text;
using testing::ElementsAre;
using testing::HasSubstr;

/// A driver of a real adapter, whose bytes go through a pty.
struct FakeDriver {
  os::KernelTermios termios{};
  serial_rs485 rs485{};
  serial_icounter_struct counters{};
  std::uint32_t refused_flags = 0;  // format flags that the chip does not have
  std::uint32_t only_speed = 0;     // the chip knows no other
  bool has_rs485 = true;
  bool has_counters = true;
  bool has_modem_lines = true;
  std::vector<std::string> calls;

  int answer(int fd, unsigned long request, void* argument) {
    switch (request) {
      case os::get_kernel_termios: *static_cast<os::KernelTermios*>(argument) = termios; return 0;
      case os::set_kernel_termios:
        termios = *static_cast<const os::KernelTermios*>(argument);
        termios.control_flags &= ~refused_flags;
        if (only_speed) termios.output_speed = only_speed;
        return 0;
      case TIOCSRS485:
        return has_rs485 ? (rs485 = *static_cast<const serial_rs485*>(argument), 0) : refuse();
      case TIOCMBIS:
      case TIOCMBIC:
        return has_modem_lines ? switch_line(request, *static_cast<const int*>(argument))
                               : refuse();
      case TIOCGICOUNT:
        return has_counters ? (*static_cast<serial_icounter_struct*>(argument) = counters, 0)
                            : refuse();
      case TCSBRK: calls.push_back("drain"); return 0;
      default: return os::real_system_calls().ioctl(fd, request, argument);
    }
  }
  int switch_line(unsigned long request, int line) {
    EXPECT_EQ(line, TIOCM_RTS);
    calls.push_back(request == TIOCMBIS ? "RTS on" : "RTS off");
    return 0;
  }
  static int refuse() {
    errno = ENOTTY;
    return -1;
  }
  os::SystemCalls system_calls() {
    os::SystemCalls fake = os::real_system_calls();
    fake.device_major = [](int) { return 188; };  // ttyUSB
    fake.ioctl = [this](int fd, unsigned long request, void* argument) {
      return answer(fd, request, argument);
    };
    return fake;
  }
};

class Serial : public testing::Test {
 protected:
  void SetUp() override {
    Result<os::PtyPair> pty = os::open_pty_pair();
    ASSERT_TRUE(pty) << pty.error().message;
    path = pty->path;
    slave = std::move(pty->slave);
    far.emplace(std::move(pty->master), "far end");
  }
  Result<std::unique_ptr<Endpoint>> open(std::map<std::string, std::string> options = {}) {
    return open_serial(endpoint_name("serial", path, options));
  }
  Result<std::unique_ptr<Endpoint>> open_fake(std::map<std::string, std::string> options = {}) {
    return open_serial(endpoint_name("serial", path, options), driver.system_calls());
  }
  std::string path;
  os::UniqueFd slave;
  std::optional<os::FdLink> far;
  FakeDriver driver;
};

TEST_F(Serial, CarriesBytesOverAPty) {
  auto port = open({{"baud", "38400"}, {"frame", "7E1"}});
  ASSERT_TRUE(port) << port.error().message;
  EXPECT_EQ((*port)->describe(), "serial:" + path + " 38400-7E1");
  EXPECT_FALSE((*port)->capabilities().wire) << "a pty has no parity and no character times";
  EXPECT_TRUE((*port)->capabilities().real_device);
  EXPECT_EQ((*port)->capabilities().timing_floor, 20ms);
  ASSERT_TRUE((*port)->send({{0x05, 0x00, 0x8A, 0x04}}));
  EXPECT_EQ(to_hex(to_bytes(receive_text(*far, "\x04"))), "05 00 8A 04");
  ASSERT_TRUE(far->send({{0x06, 0x0D, 0x11, 0xFF}}));
  EXPECT_EQ(to_hex(to_bytes(receive_text(**port, "\xFF"))), "06 0D 11 FF");
  EXPECT_EQ((*port)->line_errors(), "");
}

TEST_F(Serial, SetsSpeedAndStopBitsOfAPty) {
  const auto port = open({{"baud", "57600"}, {"frame", "8N2"}});
  ASSERT_TRUE(port);
  termios settings{};
  ASSERT_EQ(::tcgetattr(slave.get(), &settings), 0);
  EXPECT_EQ(::cfgetospeed(&settings), static_cast<speed_t>(B57600));
  EXPECT_TRUE(settings.c_cflag & CSTOPB);
  EXPECT_EQ(settings.c_lflag & (ECHO | ICANON | ISIG), 0u);
}

TEST_F(Serial, FlushesItsInputOnceAtOpening) {
  ASSERT_TRUE(far->send(to_bytes("stale")));
  pollfd there{slave.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&there, 1, 5000), 1);
  auto port = open();
  ASSERT_TRUE(port);
  ASSERT_TRUE(far->send(to_bytes("fresh")));
  EXPECT_EQ(receive_text(**port, "fresh"), "fresh");
}

TEST_F(Serial, APortInUseIsSaidWithItsUser) {
  const auto first = open();
  ASSERT_TRUE(first);
  const auto second = open();
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message,
              HasSubstr("cannot open " + path + ": the port is in use by process " +
                        std::to_string(::getpid()) + " ("));
}

TEST_F(Serial, AClosedPortIsFreeAgain) {
  { ASSERT_TRUE(open()); }
  EXPECT_TRUE(open());
}

TEST_F(Serial, AnAbsentPortIsSaid) {
  const auto port = open_serial(endpoint_name("serial", "/dev/no_such_port"));
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().message,
              HasSubstr("cannot open /dev/no_such_port: there is no such port; "));
}

TEST_F(Serial, AFileIsNoPort) {
  const std::string file = testing::TempDir() + "/not_a_port";
  std::ofstream(file) << "text";
  const auto port = open_serial(endpoint_name("serial", file));
  std::filesystem::remove(file);
  ASSERT_FALSE(port);
  EXPECT_THAT(
      port.error().message,
      HasSubstr("as a serial port: inappropriate ioctl for device; name a terminal device"));
}

TEST_F(Serial, APortWithoutPermissionSaysWhichGroup) {
  os::SystemCalls calls = os::real_system_calls();
  calls.open = [](const char*, int) {
    errno = EACCES;
    return -1;
  };
  const auto port = open_serial(endpoint_name("serial", "/dev/no_such_port"), calls);
  ASSERT_FALSE(port);
  EXPECT_EQ(port.error().message,
            "cannot open /dev/no_such_port: permission denied; add yourself to the group dialout");
}

TEST_F(Serial, APortThatDisappearsIsSaid) {
  auto port = open();
  ASSERT_TRUE(port);
  far.reset();
  EXPECT_THAT(os::test::receive_error(**port).message,
              HasSubstr("the far end is gone; see that the adapter is still plugged in"));
}

TEST_F(Serial, RefusesValuesThatAreNone) {
  EXPECT_THAT(open({{"baud", "12345"}}).error().message,
              HasSubstr("the speed is not one of the eight"));
  EXPECT_THAT(open({{"frame", "9N1"}}).error().message, HasSubstr("the data bits are not 7 or 8"));
  EXPECT_THAT(open({{"rs485", "yes"}}).error().message, HasSubstr("rs485 is 'yes'"));
}

TEST_F(Serial, ARealPortGetsSpeedAndFormatRaw) {
  driver.termios.control_flags = CRTSCTS | B9600 | CS8;
  driver.termios.local_flags = ECHO | ICANON;
  const auto port = open_fake({{"baud", "115200"}, {"frame", "7O2"}});
  ASSERT_TRUE(port) << port.error().message;
  EXPECT_EQ(driver.termios.input_speed, 115200u);
  EXPECT_EQ(driver.termios.output_speed, 115200u);
  EXPECT_EQ(driver.termios.control_flags & os::speed_mask, static_cast<unsigned>(B115200));
  EXPECT_EQ(driver.termios.control_flags & (CSIZE | PARENB | PARODD | CSTOPB),
            static_cast<unsigned>(CS7 | PARENB | PARODD | CSTOPB));
  EXPECT_EQ(driver.termios.control_flags & (CRTSCTS | CLOCAL | CREAD),
            static_cast<unsigned>(CLOCAL | CREAD));
  EXPECT_EQ(driver.termios.local_flags, 0u);
  EXPECT_EQ(driver.termios.output_flags, 0u);
  EXPECT_EQ(driver.termios.input_flags & (IXON | ICRNL | ISTRIP), 0u);
  EXPECT_EQ(driver.termios.input_flags & (INPCK | IGNPAR), static_cast<unsigned>(INPCK | IGNPAR));
  EXPECT_EQ(driver.termios.control_characters[VMIN], 1);
}

TEST_F(Serial, ARealPortHasCharacterTimes) {
  auto port = open_fake({{"baud", "9600"}, {"frame", "8E1"}, {"floor_ms", "2"}});
  ASSERT_TRUE(port);
  EXPECT_TRUE((*port)->capabilities().wire);
  EXPECT_EQ((*port)->capabilities().timing_floor, 2ms);
  EXPECT_EQ((*port)->character_time(), (line::LineSettings{9600, 8, 'E', 1}.character_time()));
  const Result<Sent> sent = (*port)->send(to_bytes("0123456789"));
  ASSERT_TRUE(sent);
  EXPECT_EQ(sent->end - sent->start, 10 * (*port)->character_time());
}

TEST_F(Serial, AFormatThatTheChipLacksIsAnError) {
  driver.refused_flags = PARENB;
  const auto port = open_fake({{"frame", "8E1"}});
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().message,
              HasSubstr("cannot set " + path +
                        " to 9600-8E1: the adapter does not offer this character format"));
}

TEST_F(Serial, ASpeedThatTheChipLacksIsAnError) {
  driver.only_speed = 9600;
  const auto port = open_fake({{"baud", "19200"}});
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().message, HasSubstr("the adapter offers 9600 bit/s instead"));
  driver.only_speed = 19300;  // 0.5 % off, as dividers are
  EXPECT_TRUE(open_fake({{"baud", "19200"}}));
}

TEST_F(Serial, TheDriverSwitchesTheDirection) {
  ASSERT_TRUE(open_fake({{"rs485", "1"}}));
  EXPECT_EQ(driver.rs485.flags, static_cast<unsigned>(SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND));
  EXPECT_THAT(driver.calls, ElementsAre());
}

TEST_F(Serial, ADriverWithoutRs485IsSaid) {
  driver.has_rs485 = false;
  const auto port = open_fake({{"rs485", "1"}});
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().message,
              HasSubstr("cannot switch " + path +
                        " to RS-485: its driver has no RS-485 mode; use rs485=rts"));
}

TEST_F(Serial, TheBenchSwitchesTheDirectionByRts) {
  auto port = open_fake({{"rs485", "rts"}, {"baud", "115200"}});
  ASSERT_TRUE(port) << port.error().message;
  ASSERT_TRUE((*port)->send(to_bytes("x")));
  EXPECT_THAT(driver.calls, ElementsAre("RTS off", "RTS on", "drain", "RTS off"));
  EXPECT_EQ(receive_text(*far, "x"), "x");
  driver.has_modem_lines = false;
  const Result<Sent> sent = (*port)->send(to_bytes("y"));
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error().message,
              HasSubstr("cannot switch RTS of " + path + ": it has no such line"));
}

TEST_F(Serial, APtyHasNoRts) {
  const auto port = open({{"rs485", "rts"}});
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().message, HasSubstr("it has no such line"));
}

TEST_F(Serial, CountsLineErrorsSinceTheLastCall) {
  driver.counters.parity = 5;  // from before the opening
  auto port = open_fake();
  ASSERT_TRUE(port);
  EXPECT_EQ((*port)->line_errors(), "");
  driver.counters.parity += 3;
  driver.counters.brk += 1;
  driver.counters.frame += 2;
  driver.counters.overrun += 1;
  driver.counters.buf_overrun += 1;
  EXPECT_EQ((*port)->line_errors(), "3 parity errors, 2 framing errors, 1 break, 2 overruns");
  EXPECT_EQ((*port)->line_errors(), "");
}

TEST_F(Serial, ADriverWithoutCountersReportsNone) {
  driver.has_counters = false;
  auto port = open_fake();
  ASSERT_TRUE(port);
  EXPECT_EQ((*port)->line_errors(), "");
}

}  // namespace
}  // namespace fieldproof::endpoints
