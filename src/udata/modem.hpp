// The CDMA modem of Cnet KO 11.5 as a scripted device: it answers what the manual prints, and
// nothing else.
//
//   to the modem                                    from the modem
//   AT CR                    (3 bytes)              OK: 'when an AT command has reached it, the
//                                                   modem sends OK'
//   AT+CRM=129 CR            (11 bytes)             OK
//   any other AT command, ending with CR            OK
//   ATDT01094714031 CR       (16 bytes), BSM-856R   CONNECT; from then on data passes in both
//                                                   directions
//   the SMS command, BSM-856R                       OK, later $006; without a network no $006
//   the SMS command, RCU-890                        *SKT*PRIMO:0 and OK, later *SKT*MOACK:0,1;
//                                                   without a network 0,0
//
// The SMS commands stand in figures of the manual that its text does not have, and in the modems'
// own manuals: `sms` of the configuration says how they begin. Nothing is printed of line ends in
// answers: there are none unless `reply_end` gives one.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "src/plc/counters.hpp"
#include "src/plc/emulated_device.hpp"
#include "src/plc/reply_queue.hpp"

namespace fieldproof::udata {

struct ModemConfig {
  bool rcu_890 = false;  // else BSM-856R
  std::string sms;       // how an SMS command begins: "AT+..."; empty: none is known
  bool network = true;
  Duration network_time = 1s;  // until the network has taken an SMS
  std::string reply_end;
  bool dtr = true,
       rts = true;  // set by the PLC ('SET(1)'); without them the modem is deaf and mute
};

class Modem : public plc::SerialDevice {
 public:
  explicit Modem(ModemConfig config)
      : config_(std::move(config)), dtr_(config_.dtr), rts_(config_.rts) {}

  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  /// "@dtr", "@rts" and "@network": 00 or 01.
  Status set(std::string_view address, std::string_view hex) override;
  /// Those, "@data" (what the other modem has received, in hex: all of it, however many `digits`
  /// are asked for) and counters.
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  /// "power_cycle", and "deliver TEXT": the other modem sends it.
  Status act(std::string_view action) override;

 private:
  void take(Byte b, Time now);
  void take_command(Time now);
  void take_sms(Time now);
  void reply(Time due, const std::string& text) { replies_.put(due, to_bytes(text)); }
  void report(Time now, const std::string& text) {
    reports_.put(now + config_.network_time, to_bytes(text));
  }
  const bool* switch_at(std::string_view address) const;

  ModemConfig config_;
  bool dtr_, rts_;
  bool connected_ = false;
  std::string command_;
  Bytes passed_on_;
  Time now_{};
  plc::ReplyQueue replies_, reports_;  // reports come from the network, whatever is asked meanwhile
  plc::ServiceCounters counters_;
};

/// `config`: modem (bsm-856r, rcu-890), sms, network, network_ms, reply_end, dtr, rts, and those of
/// port_config.hpp that the line needs. Errors name the key.
Result<std::unique_ptr<plc::EmulatedDevice>> make_modem(const nlohmann::json& config);

}  // namespace fieldproof::udata
