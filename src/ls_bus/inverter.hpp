// An emulated LS inverter on an LS Bus: answers R and W, speaks when asked (Cnet EN and KO chapter
// 8). It waits for the end of a frame as long as it takes, answers station numbers other than its
// own with silence, and has no counters: those of Cnet EN 11.1.4 belong to the XGB, which is the
// client here.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "src/ls_bus/codec.hpp"
#include "src/ls_bus/parameters.hpp"
#include "src/plc/emulated_device.hpp"
#include "src/plc/reply_queue.hpp"

namespace fieldproof::ls_bus {

struct InverterConfig {
  unsigned station = 1;  // 0-255 (Cnet EN 4.3.1)
  LsWriteOrder write_order = LsWriteOrder::address_first;
  Duration delay{};  // of a reply
};

/// Keys: station, write_order ("address_first", "count_first"), line, delay_ms; those that are for
/// others (bench_line, inter_character_floor_ms, model, neighbours, protocol, rs485) are passed
/// over. The error for an unknown key lists those there are.
Result<InverterConfig> parse_inverter_config(const nlohmann::json& config);

class Inverter : public plc::SerialDevice {
 public:
  explicit Inverter(const InverterConfig& config) : config_(config) {}

  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override { return replies_.wake_at(std::nullopt); }
  Bytes advance(Time now) override { return replies_.take(now); }

  /// Addresses are four hex digits, "1230" or "h1230"; values four digits a word, more fill the
  /// following words.
  Status set(std::string_view address, std::string_view hex) override;
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  /// run and stop change nothing; power_cycle loses what is half received or not yet sent.
  /// Parameters stay.
  Status act(std::string_view action) override;

  /// The reply to one frame; empty: silence.
  Bytes answer(ByteView frame);

 private:
  /// Looks at what the frame alone cannot tell.
  LsFault check(const LsRequest& request) const;

  InverterConfig config_;
  InverterParameters parameters_;
  LsReceiver receiver_;
  plc::ReplyQueue replies_;
};

/// In its power-on state: all parameters zero. Errors name the key of `config`.
Result<std::unique_ptr<plc::EmulatedDevice>> make_inverter(const nlohmann::json& config);

}  // namespace fieldproof::ls_bus
