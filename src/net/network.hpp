// The bench and one host on a network, in simulated time. Time costs nothing in it: a silence of an
// hour is one step. Connections are set up, carry bytes both ways in segments that are cut and
// joined, and end by FIN (each way for itself) or RST; a client may vanish; datagrams may be lost,
// doubled and overtaken.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "src/base/burst.hpp"
#include "src/base/medium.hpp"
#include "src/base/result.hpp"
#include "src/net/conditions.hpp"
#include "src/net/host.hpp"

namespace fieldproof::net {

class SimulatedNetwork : public Medium {
 public:
  /// The bench's links are numbered from `first_link` on.
  explicit SimulatedNetwork(const Conditions& conditions = {}, Time now = {},
                            LinkId first_link = line_link + 1);

  /// Switches the host on: it is advanced to `now()`. One host a network, which must outlive it.
  void attach(Host& host);

  Time now() const override { return now_; }

  /// A connection to `port` of the host, or a datagram port of the bench that talks to it. Refused:
  /// `reset` is all that ever comes on the link.
  LinkId open(Transport transport, std::uint16_t port);
  /// A number for a link that is somewhere else.
  LinkId new_link() { return next_link_++; }
  /// FIN and RST go out behind what was sent. After RST and `vanish` the bench hears nothing more
  /// on the link, and the host nothing after `vanish`. Errors: the link is not open.
  Status close(LinkId link, Closing how);
  /// One segment, or one datagram. What the host no longer wants is lost. Errors: the link is not
  /// open on the bench's side.
  Result<Sent> send(LinkId link, ByteView bytes);

  /// Does the bench take connections of the host (the default), or refuse them?
  void take_connections(bool take) { takes_connections_ = take; }

  /// What the bench hears next: `opened` by the host, `data`, `datagram`, `closed` or `reset`.
  /// `now()` then stands at its arrival. Nothing heard: an empty burst of event `data`, and `now()`
  /// stands at `until`. Time never goes back: with `until` in the past it takes what has come.
  Burst receive(Time until);

  std::optional<Time> next_event() const override;
  void run(Time until) override { run(until, true, host_wake()); }
  std::optional<Burst> take() override;

 private:
  struct Link {
    Transport transport = Transport::tcp;
    std::uint16_t port = 0;      // of the side that listens
    std::string peer{};          // the bench's address
    bool bench_sends = true;     // it has not closed, reset or vanished
    bool bench_hears = true;     // it has not reset or vanished
    bool host_sends = true;      // it has not closed
    bool stands = true;          // at the host: neither refused nor reset
    Time to_host{}, to_bench{};  // arrival of the last thing that was sent: a stream keeps order
  };
  struct Flight {
    bool to_host = false;
    Burst burst{};
  };
  using Flights = std::multimap<Time, Flight>;  // by arrival

  /// When the host wakes next; where it ended because the bench heard something, as of before that.
  std::optional<Time> run(Time until, bool until_heard, std::optional<Time> wake);
  void run_now() { run(now_, false, host_wake()); }
  std::optional<Time> host_wake() const { return host_ ? host_->wake_at() : std::nullopt; }
  std::optional<Time> next_event(std::optional<Time> wake) const;  // the host wakes then
  bool deliver_due();                                              // something to the host?
  void deliver_to_host(const Burst& burst);
  void deliver_to_bench(Burst&& burst);
  void join_following(Flight& flight);
  std::optional<Time> wake_host();  // when it wakes next
  void host_does(Burst&& burst);
  void host_connects(Burst&& burst);

  void dispatch(bool to_host, Link& link, Burst&& burst);
  void fly(bool to_host, Link& link, Burst&& burst);
  void send_datagram(bool to_host, const Burst& burst);
  Duration travel() { return conditions_.delay + chance_.up_to(conditions_.jitter); }

  Conditions conditions_;
  Chance chance_;
  Time now_;
  LinkId next_link_;
  Host* host_ = nullptr;
  bool takes_connections_ = true;
  std::map<LinkId, Link> links_;
  Flights flights_;
  std::deque<Burst> inbox_;  // heard by the bench, oldest first
};

}  // namespace fieldproof::net
