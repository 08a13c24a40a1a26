// Status by service of one channel (Cnet EN 11.1.4, Cnet KO 10.1.4).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "src/base/result.hpp"

namespace fieldproof::plc {

/// Status codes of the dedicated service. XGT: a request that no code fits (unknown command or
/// type) counts as `head`. Modbus: a wrong CRC or LRC, and what is no frame at all, as
/// `not_modbus`; odd or foreign hex digits as `not_hex`.
namespace service_status {
constexpr std::uint16_t normal = 0, head = 1, tail = 2, bcc = 3, station = 9, too_long = 0x0B,
                        not_modbus = 0x0C, not_hex = 0x0D;
}

/// `status` is that of the last frame. A request that is answered, be it with a refusal, is a
/// service; one that draws silence is an error.
struct ServiceCounters {
  std::uint16_t status = 0;
  std::uint32_t services = 0;
  std::uint32_t errors = 0;

  void count_service() {
    status = service_status::normal;
    ++services;
  }
  void count_error(std::uint16_t why) {
    status = why;
    ++errors;
  }
};

/// In hex with at least `digits` digits (0: `least`), and more where it needs more.
std::string counter_text(std::uint32_t value, std::size_t digits, std::size_t least = 4);

/// The back door (emulated_device.hpp): "@status", "@errors" or "@services" in hex with at least
/// `digits` digits (0: two of the status, four of the counts), and more where they need more. The
/// error lists the names.
Result<std::string> get_counter(const ServiceCounters& counters, std::string_view name,
                                std::size_t digits);

}  // namespace fieldproof::plc
