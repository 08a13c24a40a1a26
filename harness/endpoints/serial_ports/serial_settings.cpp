#include "harness/endpoints/serial_ports/serial_settings.hpp"

#include <fmt/format.h>
#include <linux/serial.h>
#include <sys/ioctl.h>
#include <termios.h>

#include <cerrno>
#include <cstdlib>

#include "harness/system/kernel_termios.hpp"

namespace fieldproof::endpoints {

using os::SystemCalls;

namespace {

constexpr std::uint32_t format_mask = CSIZE | PARENB | PARODD | CSTOPB;

std::uint32_t format_flags(const line::LineSettings& settings) {
  std::uint32_t flags = settings.data_bits == 7 ? CS7 : CS8;
  if (settings.parity != 'N') flags |= PARENB;
  if (settings.parity == 'O') flags |= PARODD;
  if (settings.stop_bits == 2) flags |= CSTOPB;
  return flags;
}

/// The eight speeds of parse_line_settings by their codes, which a peer behind a pty reads back;
/// others by number.
std::uint32_t speed_flags(int baud) {
  switch (baud) {
    case 1200: return B1200;
    case 2400: return B2400;
    case 4800: return B4800;
    case 9600: return B9600;
    case 19200: return B19200;
    case 38400: return B38400;
    case 57600: return B57600;
    case 115200: return B115200;
    default: return os::any_speed;
  }
}

Error cannot_set(const std::string& port, const std::string& what, const std::string& why) {
  return fail(fmt::format("cannot set {} to {}: {}", port, what, why));
}

}  // namespace

bool is_pty(const SystemCalls& calls, int fd) {
  const int major = calls.device_major(fd);
  return major >= 136 && major <= 143;
}

Status apply_settings(const SystemCalls& calls, int fd, const std::string& port,
                      const line::LineSettings& settings) {
  os::KernelTermios wanted{};
  if (calls.ioctl(fd, os::get_kernel_termios, &wanted) != 0) {
    // /dev/ttyS4 to ttyS31 are there whether or not the machine has such UARTs.
    if (errno == EIO) {
      Error none =
          fail("cannot open " + port + ": there is no UART behind this name; choose another port");
      none.absent = true;
      return none;
    }
    return fail("cannot use " + port + " as a serial port: " + os::errno_text(errno) +
                "; name a terminal device such as /dev/ttyUSB0");
  }
  const bool pty = is_pty(calls, fd);
  // A byte with a parity or framing error and a break are dropped, as a serial module does it; the
  // driver counts them.
  wanted.input_flags = IGNBRK | IGNPAR | (settings.parity == 'N' ? 0 : INPCK);
  line::LineSettings on_line = settings;
  if (pty) on_line.data_bits = 8, on_line.parity = 'N';  // asked for, they may be refused
  wanted.output_flags = 0;
  wanted.local_flags = 0;
  wanted.control_flags &=
      ~(os::speed_mask | os::speed_mask << os::input_speed_shift | format_mask | CRTSCTS);
  wanted.control_flags &= ~static_cast<std::uint32_t>(CMSPAR);
  wanted.control_flags |= speed_flags(settings.baud) | CREAD | CLOCAL | format_flags(on_line);
  wanted.control_characters.fill(0);
  wanted.control_characters[VMIN] = 1;
  wanted.input_speed = wanted.output_speed = static_cast<std::uint32_t>(settings.baud);
  if (calls.ioctl(fd, os::set_kernel_termios, &wanted) != 0)
    return cannot_set(port, line::to_string(settings), os::errno_text(errno));
  if (pty) return ok();

  os::KernelTermios taken{};
  if (calls.ioctl(fd, os::get_kernel_termios, &taken) != 0)
    return cannot_set(port, line::to_string(settings), os::errno_text(errno));
  if ((taken.control_flags & format_mask) != format_flags(settings)) {
    return cannot_set(
        port, line::to_string(settings),
        "the adapter does not offer this character format; use another adapter or format");
  }
  // A UART is within 2 % of the other side's speed or it misreads the last bits.
  if (std::abs(static_cast<long>(taken.output_speed) - settings.baud) * 50 > settings.baud) {
    return cannot_set(
        port, line::to_string(settings),
        fmt::format("the adapter offers {} bit/s instead; use another adapter or speed",
                    taken.output_speed));
  }
  return ok();
}

Result<Direction> parse_direction(const std::string& text) {
  if (text.empty() || text == "0") return Direction::none;
  if (text == "1") return Direction::kernel;
  if (text == "rts") return Direction::rts;
  return fail("rs485 is '" + text +
              "'; write 1 (the driver switches), rts (the bench switches by RTS) or 0");
}

Status apply_direction(const SystemCalls& calls, int fd, const std::string& port,
                       Direction direction) {
  if (direction == Direction::none) return ok();
  if (direction == Direction::rts) return set_rts(calls, fd, port, false);
  serial_rs485 mode{};
  mode.flags = SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND;
  if (calls.ioctl(fd, TIOCSRS485, &mode) == 0) return ok();
  const std::string why =
      errno == ENOTTY || errno == EINVAL ? "its driver has no RS-485 mode" : os::errno_text(errno);
  return fail("cannot switch " + port + " to RS-485: " + why +
              "; use rs485=rts, or leave rs485 out where the adapter switches by itself");
}

Status set_rts(const SystemCalls& calls, int fd, const std::string& port, bool on) {
  int line = TIOCM_RTS;
  if (calls.ioctl(fd, on ? TIOCMBIS : TIOCMBIC, &line) == 0) return ok();
  const std::string why =
      errno == ENOTTY || errno == EINVAL ? "it has no such line" : os::errno_text(errno);
  return fail("cannot switch RTS of " + port + ": " + why +
              "; use rs485=1, or leave rs485 out where the adapter switches by itself");
}

bool read_line_errors(const SystemCalls& calls, int fd, LineErrorCounts& counts) {
  serial_icounter_struct raw{};
  if (calls.ioctl(fd, TIOCGICOUNT, &raw) != 0) return false;
  counts = {raw.parity, raw.frame, raw.brk, raw.overrun + raw.buf_overrun};
  return true;
}

std::string line_errors_between(const LineErrorCounts& before, const LineErrorCounts& after) {
  std::string text;
  const auto add = [&](int count, std::string_view what) {
    if (count == 0) return;
    text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", count, what, count == 1 ? "" : "s");
  };
  add(after.parity - before.parity, "parity error");
  add(after.framing - before.framing, "framing error");
  add(after.breaks - before.breaks, "break");
  add(after.overruns - before.overruns, "overrun");
  return text;
}

}  // namespace fieldproof::endpoints
