// ESEND as a P2P driver (FEnet EN 7.4.3): what P2pClient does for any block, its flag, its turn and
// its results, it does for a mail, too. The request of a block is its mail, made when the block's
// turn has come; the reply is how it ended: email_status, two bytes, low byte first, which the
// service says when the server has had its say.
#pragma once

#include <optional>
#include <utility>

#include "src/email/mail.hpp"
#include "src/p2p/driver.hpp"

namespace fieldproof::email {

class EsendDriver : public p2p::P2pDriver {
 public:
  /// `settings` outlive the driver.
  explicit EsendDriver(const EmailSettings& settings) : settings_(settings) {}

  std::string_view name() const override { return "e-mail"; }
  /// Message, address, and an area for each part of the form MB, which is long enough.
  Status check(const p2p::P2pBlock& block, const plc::PlcModel& model) const override;
  Result<Bytes> request(const p2p::P2pBlock& block, const plc::PlcMemory& memory) override;
  bool awaits_reply(const p2p::P2pBlock&) const override { return true; }
  std::optional<std::uint16_t> take(const p2p::P2pBlock& block, ByteView frame,
                                    plc::PlcMemory& memory) const override;

  void receive(const Burst& burst, plc::FrameSink& sink) override;
  std::optional<Time> wake_at() const override { return std::nullopt; }
  void advance(Time, plc::FrameSink&) override {}
  void reset() override {}

  /// That of the last request.
  Mail take_mail() { return std::exchange(mail_, {}); }

 private:
  const EmailSettings& settings_;
  Mail mail_;
};

/// The reply of a mail that ended so.
Bytes ended_with(std::uint16_t status);

}  // namespace fieldproof::email
