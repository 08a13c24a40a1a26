// For tests: an emulated P2P client and an emulated partner on one simulated line.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "harness/protocol.hpp"
#include "src/line/line.hpp"

namespace fieldproof::suites::test {

class P2pPair {
 public:
  struct Station {
    std::string model;
    nlohmann::json config;
  };

  P2pPair(const harness::Protocol& protocol, const Station& client, const Station& partner)
      : client_(make(protocol, client)),
        partner_(make(protocol, partner)),
        line_(line::LineSettings{}) {
    line_.attach(*partner_->line(), {});
    line_.attach(*client_->line(), {});
  }

  /// Lets time pass; what is said meanwhile, a burst a line in hex.
  std::vector<std::string> run(Duration time) {
    std::vector<std::string> said;
    for (const Time end = line_.now() + time; line_.now() < end;)
      if (const Burst burst = line_.receive(end); !burst.bytes.empty())
        said.push_back(to_hex(burst.bytes));
    return said;
  }

  plc::EmulatedDevice& client() { return *client_; }
  plc::EmulatedDevice& partner() { return *partner_; }

 private:
  static std::unique_ptr<plc::EmulatedDevice> make(const harness::Protocol& protocol,
                                                   const Station& station) {
    Result<std::unique_ptr<plc::EmulatedDevice>> device =
        protocol.make_device(station.model, station.config);
    if (!device) throw std::runtime_error(device.error().message);
    return std::move(*device);
  }

  std::unique_ptr<plc::EmulatedDevice> client_, partner_;
  line::SimulatedLine line_;
};

inline void set(plc::EmulatedDevice& device, const std::string& address, const std::string& hex) {
  const Status status = device.set(address, hex);
  EXPECT_TRUE(status) << status.error().message;
}
/// What the device holds, or why it cannot be told.
inline std::string get(const plc::EmulatedDevice& device, const std::string& address,
                       std::size_t digits = 0) {
  const Result<std::string> value = device.get(address, digits);
  return value ? *value : value.error().message;
}

/// NDR and ERR, STATUS, count and error count of a block of P2P parameter 1: "0001 0000 00000002
/// 00000000".
inline std::string result_of(const plc::EmulatedDevice& client, unsigned block) {
  const unsigned word = 512 + 6 * block;
  const auto at = [&](char type, unsigned index) {
    return get(client, std::string("%L") + type + std::to_string(index));
  };
  return at('W', word) + ' ' + at('W', word + 1) + ' ' + at('D', (word + 2) / 2) + ' ' +
         at('D', (word + 4) / 2);
}

}  // namespace fieldproof::suites::test
