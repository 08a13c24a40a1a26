// --control: a program beside the protocol sets the device under test up, and looks at it. One JSON
// object a line asks, one answers (README, "A device that can be set up"):
//
//   {"config": {"station": 5, "delay_ms": 10}}   from now on; null: as it was at the start
//   {"set": {"%FW0": "1234"}}
//   {"get": ["%PW0"]}                            -> {"values": {"%PW0": "1234"}}
//   {"do": "stop"}
//   -> {"ok": true}, {"unsupported": ["delay_ms"]}, {"unsupported": true} or {"error": "why"}
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>

#include "harness/endpoints/forwarding.hpp"
#include "harness/protocol.hpp"

namespace fieldproof::endpoints {

/// How the program is reached.
struct ControlProgram {
  std::function<Status(const std::string& line)> tell;     // empty: there is none
  std::function<std::string(Duration patience)> answer{};  // its next answer; empty: none came

  explicit operator bool() const { return static_cast<bool>(tell); }
};

/// A real device with such a program. What the program does not support, refuses, or answers in no
/// form that is known, is an error that is `refused`; one that has ended is trouble. One that does
/// not answer is asked no more until the device is started anew.
class Controlled final : public Forwarding {
 public:
  /// Without a `program` the one that `device` has started itself (--control -).
  Controlled(std::unique_ptr<Endpoint> device, const harness::Protocol& protocol,
             ControlProgram program);

  const Capabilities& capabilities() const override { return capabilities_; }
  /// The first configuration is taken to be what the device has; then what differs is told.
  Status begin(const nlohmann::json& config) override;
  /// All but what the program has said it does not support.
  bool configures(std::string_view key) const override;

  /// What was there is read before, for put_back().
  Status set(std::string_view address, std::string_view hex) override;
  Result<std::string> get(std::string_view address, std::size_t digits) override;
  Status act(std::string_view action) override;
  /// What it was told to be, it is still; a program beside the device cannot say when that is up.
  Status renew() override;
  Status put_back() override;

 private:
  using Values = std::vector<std::pair<std::string, std::string>>;  // address and hex digits

  Result<nlohmann::json> ask(const nlohmann::json& wish);
  /// It has been started anew: what it was told is gone.
  void note_starts();
  void note_action(std::string_view action);
  Status tell_config();
  Status write(std::string_view address, std::string_view hex);
  std::vector<std::string> elements(std::string_view address, std::size_t digits) const;

  std::unique_ptr<Endpoint> device_;
  const harness::Protocol& protocol_;
  ControlProgram program_;
  Capabilities capabilities_;
  nlohmann::json declared_, wanted_, told_;  // configurations: at the start, of the case, present
  std::set<std::string, std::less<>> unsupported_;
  unsigned starts_ = 0;
  std::string mute_;  // why it is asked no more
  bool beside_;       // it is not the device itself: its end is not that of the device
  Values before_;     // what set() has changed, the latest last
};

}  // namespace fieldproof::endpoints
