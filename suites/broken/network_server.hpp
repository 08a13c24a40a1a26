// What stands around a good server on a network and spoils one thing: for the tables of faults.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "src/base/burst.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::broken {

using Bursts = std::vector<Burst>;

/// What a fault may look at.
struct Server {
  plc::EmulatedDevice& plc;     // the good one's memory
  std::vector<LinkId> links{};  // that the good one has, the oldest first
};

/// One fault at work. Each function may be empty: then the device does the right thing there.
template <typename Settings>
struct NetworkBehaviour {
  std::function<void(Settings&)> settings{};
  /// What has arrived, and what the good server hears of it.
  std::function<Bursts(Burst heard, Server& server)> hear{};
  /// The request that the good server understands instead of a whole frame; empty: none.
  std::function<Bytes(Bytes request)> misread{};
  /// Spoils the reply to a request: a frame each.
  std::function<void(Bytes& reply, const Bytes& request)> edit{};
  /// What goes out at one moment.
  std::function<void(Bursts& does, Server& server)> act{};
  /// The counter ("@sent") that the back door shows instead of the one that it is asked for.
  std::function<std::string(std::string name)> show{};
};

/// Makers for the tables of faults: one function of a behaviour each.
template <typename Settings>
struct Makes {
  using Behaviour = NetworkBehaviour<Settings>;
  using Make = std::function<Behaviour()>;

  static Make edits(std::function<void(Bytes& reply, const Bytes& request)> edit) {
    return [=] { return Behaviour{.edit = edit}; };
  }
  static Make misreads(std::function<Bytes(Bytes request)> misread) {
    return [=] { return Behaviour{.misread = misread}; };
  }
  static Make hears(std::function<Bursts(Burst heard, Server& server)> hear) {
    return [=] { return Behaviour{.hear = hear}; };
  }
  static Make acts(std::function<void(Bursts& does, Server& server)> act) {
    return [=] { return Behaviour{.act = act}; };
  }
  static Make shows(const std::string& instead_of, const std::string& other) {
    return [=] {
      return Behaviour{.show = [=](std::string name) { return name == instead_of ? other : name; }};
    };
  }
  static Make set_up(std::function<void(Settings&)> settings) {
    return [=] { return Behaviour{.settings = settings}; };
  }
};

/// How many bytes of a stream are its first frame (or cannot be followed); nothing: not all of it
/// has come.
using FirstFrame = std::optional<std::size_t> (*)(ByteView stream);

/// Puts streams together for the good server, which hears whole frames alone, each answered at
/// once: so each reply is known to belong to its request. A datagram is a frame.
class NetworkServer : public plc::EmulatedDevice, public net::Host {
 public:
  template <typename Settings>
  NetworkServer(const NetworkBehaviour<Settings>& behaviour,
                std::unique_ptr<plc::EmulatedDevice> good, FirstFrame first_frame)
      : behaviour_{{},
                   behaviour.hear,
                   behaviour.misread,
                   behaviour.edit,
                   behaviour.act,
                   behaviour.show},
        good_(std::move(good)),
        server_{*good_},
        first_frame_(first_frame) {}

  net::Host* network() override { return this; }
  line::Device* line(unsigned channel = 0) override { return good_->line(channel); }
  Status set(std::string_view address, std::string_view hex) override {
    return good_->set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    const bool other = behaviour_.show && address.starts_with('@');
    return good_->get(other ? behaviour_.show(std::string(address)) : address, digits);
  }
  Status act(std::string_view action) override { return good_->act(action); }

  bool listens(Transport transport, std::uint16_t port) const override {
    return good_->network()->listens(transport, port);
  }
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  std::vector<Burst> advance(Time now) override;

 private:
  struct Any {};

  void take(const Burst& heard);
  void take_bytes(const Burst& heard);
  std::optional<Bytes> next_request(LinkId link);
  void ask(const Burst& heard, const Bytes& request);
  void collect();

  NetworkBehaviour<Any> behaviour_;
  std::unique_ptr<plc::EmulatedDevice> good_;
  Server server_;
  FirstFrame first_frame_;
  std::map<LinkId, Bytes> streams_;
  Bursts does_;
  Time now_{};
};

}  // namespace fieldproof::broken
