// Status by service of one channel (000 11.1.4).
#pragma once

#include <cstdint>

namespace fieldproof {

/// Status codes of the dedicated service. A request that no code fits (unknown command or type) counts as `head`.
namespace service_status {
constexpr std::uint16_t normal = 0, head = 1, tail = 2, bcc = 3, station = 9;
}

/// `status` is that of the last frame. A request that is answered, be it with NAK, is a service; one that draws silence
/// is an error.
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

}  // namespace fieldproof
