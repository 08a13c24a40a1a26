// An emulated XGB PLC: one model's memory, and the services that share it.
//
// A protocol makes its device so, and adds what it adds to it:
//
//   Result<std::unique_ptr<plc::Plc>> plc = plc::make_plc(model, config);
//   Status added = add_server(**plc, 1, config);  // a channel of the Cnet, or the Ethernet module
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "src/plc/controller.hpp"
#include "src/plc/memory.hpp"

namespace fieldproof::plc {

class Plc : public Controller {
 public:
  explicit Plc(const PlcModel& model, bool run = true) : Controller(run), memory_(model) {
    memory_.watch([this] { scan(); });
  }

  /// For services, which the PLC outlives.
  PlcMemory& memory() { return memory_; }

  Status set(std::string_view address, std::string_view hex) override {
    return set_by_name(memory_, address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    if (address.starts_with('@')) return get_of_service(address, digits);
    return get_by_name(memory_, address, digits);
  }

 private:
  PlcMemory memory_;
};

/// Without services yet. `config` says its mode ("run", the default, or "stop"), and the host table
/// of its Ethernet module ("host_table": at most 16 IPv4 addresses; absent: off). Errors name the
/// model or the key.
Result<std::unique_ptr<Plc>> make_plc(std::string_view model, const nlohmann::json& config);

}  // namespace fieldproof::plc
