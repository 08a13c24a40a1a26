// What hangs on a PLC and talks: the server or client of a Cnet channel, or a service of the
// Ethernet module. It shares memory, mode and power with the others (controller.hpp).
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"
#include "src/line/device.hpp"
#include "src/net/host.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::plc {

class Service {
 public:
  virtual ~Service() = default;

  /// Status by service (Cnet EN 11.1.4).
  virtual const ServiceCounters& counters() const = 0;
  /// What the back door calls "@status" and the like (emulated_device.hpp).
  virtual Result<std::string> get(std::string_view name, std::size_t digits) const {
    return get_counter(counters(), name, digits);
  }

  /// What a loss of power loses. Memory stays, and so does the mode.
  virtual void power_cycle() = 0;
  /// RUN, or STOP. Servers answer in both.
  virtual void set_run([[maybe_unused]] bool run) {}
  /// Memory may have changed, by whomever.
  virtual void scan() {}

  /// Actions of its own: their names for messages, and one of them done; nothing: it is none.
  virtual std::vector<std::string> actions() const { return {}; }
  virtual std::optional<Status> act([[maybe_unused]] std::string_view action) {
    return std::nullopt;
  }
};

class LineService : public Service, public line::Device {};

class NetworkService : public Service, public net::Host {
 public:
  struct Port {
    Transport transport = Transport::tcp;
    std::uint16_t number = 0;
    bool operator==(const Port&) const = default;
  };
  /// Where it listens, the same all its life; none: it only opens links of its own.
  virtual std::vector<Port> ports() const = 0;
  /// Is it the server driver, of which a module has one (FEnet EN 6.2.2 (2))?
  virtual bool is_driver() const { return false; }

  bool listens(Transport transport, std::uint16_t port) const final {
    const std::vector<Port> all = ports();
    return std::ranges::find(all, Port{transport, port}) != all.end();
  }
};

}  // namespace fieldproof::plc
