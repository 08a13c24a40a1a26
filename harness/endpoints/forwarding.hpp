// An endpoint that hands everything on to another: the base of those that change one thing.
#pragma once

#include <nlohmann/json.hpp>

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::endpoints {

class Forwarding : public Endpoint {
 public:
  /// `to` outlives it.
  explicit Forwarding(Endpoint& to) : to_(to) {}

  const Capabilities& capabilities() const override { return to_.capabilities(); }
  std::string describe() const override { return to_.describe(); }
  Time now() const override { return to_.now(); }
  Duration character_time() const override { return to_.character_time(); }
  void has_no_wire() override { to_.has_no_wire(); }
  Status begin(const nlohmann::json& config) override { return to_.begin(config); }
  bool configures(std::string_view key) const override { return to_.configures(key); }
  unsigned starts() const override { return to_.starts(); }
  Bytes last_sent() const override { return to_.last_sent(); }
  std::string started_with(const nlohmann::json& config) const override {
    return to_.started_with(config);
  }

  Result<LinkId> open(Transport transport, std::uint16_t port) override {
    return to_.open(transport, port);
  }
  Result<LinkId> open_line(unsigned channel) override { return to_.open_line(channel); }
  Status close(LinkId link, Closing how) override { return to_.close(link, how); }
  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId link) override { return to_.send(bytes, link); }
  Result<Burst> receive(Time deadline) override { return to_.receive(deadline); }

  Status set(std::string_view address, std::string_view hex) override {
    return to_.set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) override {
    return to_.get(address, digits);
  }
  Status act(std::string_view action) override { return to_.act(action); }
  Status renew() override { return to_.renew(); }
  void lose_links() override { to_.lose_links(); }
  Status put_back() override { return to_.put_back(); }
  Trace trace() const override { return to_.trace(); }
  Status tell(std::string_view line) override { return to_.tell(line); }
  std::string answer(Duration patience) override { return to_.answer(patience); }
  bool lets_others_in() override { return to_.lets_others_in(); }
  std::string line_errors() override { return to_.line_errors(); }

 protected:
  Endpoint& to_;
};

}  // namespace fieldproof::endpoints
