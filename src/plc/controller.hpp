// A PLC as far as it does not depend on its memory: one mode, one power supply, and the services
// that hang on it: on Cnet channels, and on the Ethernet module.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "src/plc/emulated_device.hpp"
#include "src/plc/ethernet.hpp"
#include "src/plc/service.hpp"

namespace fieldproof::plc {

class Controller : public EmulatedDevice {
 public:
  explicit Controller(bool run) : run_(run) {}
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  /// The first service is the main one: `line()` leads to its channel where it has one, and the '@'
  /// names of the back door are its. Services are told the mode when they are added.
  /// Errors: the channel has a service already, or a port of the network.
  Status add(unsigned channel, std::unique_ptr<LineService> service);
  Status add(std::unique_ptr<NetworkService> service);
  /// Ethernet::allow_only.
  void allow_only(std::vector<std::string> addresses) {
    ethernet_.allow_only(std::move(addresses));
  }
  /// For services that open links.
  net::OwnLinks& own_links() { return ethernet_.own_links(); }

  line::Device* line(unsigned channel = 0) override;
  net::Host* network() override { return ethernet_.empty() ? nullptr : &ethernet_; }

  /// "run", "stop", "power_cycle", and the actions of the services.
  Status act(std::string_view action) override;

 protected:
  /// '@' names: of the Ethernet module, else of the main service.
  Result<std::string> get_of_service(std::string_view name, std::size_t digits) const;
  /// Memory has changed.
  void scan();

 private:
  void take(std::unique_ptr<Service> service);
  Error no_such_action(std::string_view action) const;

  bool run_;
  std::vector<std::unique_ptr<Service>> services_;  // the main one first
  std::map<unsigned, LineService*> lines_;          // by channel
  unsigned main_channel_ = 0;
  Ethernet ethernet_;
};

}  // namespace fieldproof::plc
