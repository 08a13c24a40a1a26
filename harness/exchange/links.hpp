// The links of one case: what was opened and closed on them, what came, and what no step has taken.
#pragma once

#include <list>
#include <optional>
#include <string>

#include "harness/exchange/channel.hpp"
#include "harness/exchange/pending.hpp"

namespace fieldproof::exchange {

/// Of a link that the device has yet to open.
constexpr LinkId not_there = ~LinkId{0};

/// A line, a connection, a datagram port.
struct Link {
  std::string name;  // as the vector has it; empty: the line, or the implicit connection
  Channel to;
  LinkId id = line_link;
  Transport transport = Transport::tcp;
  std::uint16_t port = 0;
  bool network = false;    // it was opened, and can end
  bool by_device = false;  // the device opened it
  bool sends = true;       // the bench has not closed it
  bool hears = true;       // more may come
  bool gone = false;       // reset, or vanished: there is nothing left to close
  bool jilted = false;     // the device ended it before the bench did
  bool lost = false;       // the device has had no power since it was opened
  bool asked = false;      // no step has taken anything since the last one that sent

  Pending pending;
  std::optional<Pending::EventAt> opened;  // by the device
  std::optional<Pending::EventAt> ending;  // the device's FIN or RST that no step has taken
  Time cause{};  // what the next reply answers: a transmission, the reply before it, a set or do
  Time last_heard{};
  Sent last_sent{};
  Bytes last_bytes{};  // of the last step that sent
  Bytes unfinished{};  // sent since the last complete frame
  Burst request{};     // of a client, taken by `expect` and not answered yet

  bool datagrams() const { return network && transport == Transport::udp; }
  /// Nothing that was sent waits for its rest: a probe would be read as one.
  bool between_frames() const { return sends && hears && !lost && unfinished.empty(); }
  /// Nothing is under way: a request of the bench's own disturbs no step.
  bool idle() const;
};

class Links {
 public:
  /// Events are written into `transcript`, and so is trouble of the port. Both outlive it.
  explicit Links(Transcript& transcript) : transcript_(transcript) {}

  /// A line: it is there.
  Link& add_line(std::string name, const Channel& to, LinkId id = line_link);
  /// The connection that the device will open, or the first datagram that it will send; until then
  /// nothing can be sent on it. What it opens otherwise is not heard.
  Link& await_device(const Channel& to, Transport transport);
  /// nullptr: trouble of the port.
  Link* open(std::string name, const Channel& to, Transport transport, std::uint16_t port);
  /// The link of that name that was opened last; nullptr: none.
  Link* find(std::string_view name);
  /// The first connection of the device that has no name yet; nullptr: none.
  Link* unnamed_of_device();
  /// The device's next connection is the implicit link again.
  void name(Link& link, const std::string& name, int step);
  /// One over which the bench may ask for itself in this protocol; nullptr: none.
  Link* idle(const harness::Protocol& spoken);
  std::list<Link>& all() { return links_; }

  /// Nothing: trouble of the port. The bytes are those of the present step, or nobody's (a probe).
  std::optional<Sent> transmit(Link& link, ByteView bytes, bool of_step = true);
  /// Takes what comes next on any link of the endpoint; false when `deadline` has passed, the
  /// port failed or the device floods.
  bool listen(endpoints::Endpoint& endpoint, Time deadline);
  bool listen(const Link& link, Time deadline) { return listen(*link.to.endpoint, deadline); }
  /// What came on `from`, to whoever listened there.
  void take(const endpoints::Endpoint& from, Burst burst);
  void close(Link& link, Closing how);
  /// The device has lost its power, and its connections with it.
  void lose(const endpoints::Endpoint& device);

  /// Answers are counted from now: memory was set, a link was opened.
  void restart(Time now);
  /// What no step has taken, nobody was waiting for.
  void leave_over();
  void note(Time now, std::string text, const Link* link = nullptr);

 private:
  Link* find(const endpoints::Endpoint& endpoint, LinkId id);
  Pending::EventAt record(const Link& link, results::Event event);
  Link* accept(const endpoints::Endpoint& from, const Burst& burst);
  void take_end(Link& link, const Burst& burst);
  int step() const { return static_cast<int>(transcript_.steps.size()) - 1; }

  Transcript& transcript_;
  std::list<Link> links_;
};

}  // namespace fieldproof::exchange
