#include "harness/exchange/links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ranges>

#include "harness/exchange/timing.hpp"

namespace fieldproof::exchange {

using results::Event;

namespace {

std::string where(const Link& link) {
  return link.port == 0
             ? std::string()
             : fmt::format(" {} {}", link.transport == Transport::udp ? "UDP" : "TCP", link.port);
}

}  // namespace

bool Link::idle() const {
  const bool answered = last_heard >= last_sent.end;
  return network && between_frames() && answered && pending.empty() && !ending;
}

Link& Links::add_line(std::string name, const Channel& to, LinkId id) {
  Link& link = links_.emplace_back();
  link.id = id;
  link.name = std::move(name);
  link.to = to;
  // Memory that was given through the protocol may just have been answered.
  link.cause = link.last_heard = to.endpoint->now();
  link.last_sent = {link.cause, link.cause};
  return link;
}

Link& Links::await_device(const Channel& to, Transport transport) {
  Link& link = add_line({}, to);
  link.transport = transport;
  link.id = not_there;
  link.network = link.by_device = true;
  link.sends = false;
  return link;
}

Link* Links::open(std::string name, const Channel& to, Transport transport, std::uint16_t port) {
  const Result<LinkId> id = to.endpoint->open(transport, port);
  if (!id) {
    transcript_.trouble = id.error();
    return nullptr;
  }
  Link& link = add_line(std::move(name), to);
  link.id = *id;
  link.transport = transport;
  link.port = port;
  link.network = true;
  Event event{Event::Kind::opened, link.cause, link.cause, {}, "opened" + where(link), step()};
  record(link, std::move(event));
  return &link;
}

Link* Links::find(std::string_view name) {
  const auto found = std::ranges::find(links_.rbegin(), links_.rend(), name, &Link::name);
  return found == links_.rend() ? nullptr : &*found;
}

Link* Links::find(const endpoints::Endpoint& endpoint, LinkId id) {
  const auto found = std::ranges::find_if(
      links_, [&](const Link& link) { return link.to.endpoint == &endpoint && link.id == id; });
  return found == links_.end() ? nullptr : &*found;
}

Link* Links::unnamed_of_device() {
  const auto found = std::ranges::find_if(links_, [](const Link& link) {
    return link.by_device && link.name.empty() && link.id != not_there;
  });
  return found == links_.end() ? nullptr : &*found;
}

Link* Links::idle(const harness::Protocol& spoken) {
  const auto found = std::ranges::find_if(
      links_, [&](const Link& link) { return link.idle() && link.to.protocol == &spoken; });
  return found == links_.end() ? nullptr : &*found;
}

void Links::name(Link& link, const std::string& name, int step) {
  link.name = name;
  if (link.opened) {
    (*link.opened)->link = name;
    (*link.opened)->step = step;
  }
  if (link.ending) (*link.ending)->link = name;
  for (const Pending::EventAt event : link.pending.events()) event->link = name;
  if (!find("")) await_device(link.to, link.transport).cause = link.cause;
}

Pending::EventAt Links::record(const Link& link, Event event) {
  event.link = link.name;
  event.port = link.port;
  event.transport = link.transport;
  return transcript_.events.insert(transcript_.events.end(), std::move(event));
}

std::optional<Sent> Links::transmit(Link& link, ByteView bytes, bool of_step) {
  const Result<Sent> sent = link.to.endpoint->send(bytes, link.id);
  if (!sent) {
    transcript_.trouble = sent.error();
    return std::nullopt;
  }
  record(link, {Event::Kind::sent,
                sent->start,
                sent->end,
                Bytes(bytes.begin(), bytes.end()),
                {},
                of_step ? step() : -1});
  if (!of_step) return *sent;
  link.last_sent = *sent;
  link.asked = true;
  link.cause = sent->end;
  if (!link.network || link.datagrams()) return *sent;
  link.unfinished.insert(link.unfinished.end(), bytes.begin(), bytes.end());
  while (const auto length = link.to.protocol->frame_length(link.unfinished))
    link.unfinished.erase(link.unfinished.begin(),
                          link.unfinished.begin() + static_cast<std::ptrdiff_t>(*length));
  return *sent;
}

bool Links::listen(endpoints::Endpoint& endpoint, Time deadline) {
  if (transcript_.trouble || transcript_.flooded) return false;
  Result<Burst> burst = endpoint.receive(deadline);
  if (!burst) {
    transcript_.trouble = burst.error();
    return false;
  }
  if (is_nothing(*burst)) return false;
  take(endpoint, std::move(*burst));
  return !transcript_.flooded;
}

/// A connection of the device: the implicit link from now on. Nothing where nobody waits for one.
Link* Links::accept(const endpoints::Endpoint& from, const Burst& burst) {
  Link* before = find("");
  if (!before || !before->by_device || before->to.endpoint != &from) return nullptr;
  const bool datagram = burst.event == LinkEvent::datagram;
  if (datagram != before->datagrams()) return nullptr;
  const Time cause = before->cause;
  Link& link = before->id == not_there ? *before : await_device(before->to, before->transport);
  link.id = burst.link;
  link.port = burst.port;
  link.sends = true;
  link.cause = cause;
  if (datagram) return &link;                         // nothing is opened there
  const bool now = burst.event == LinkEvent::opened;  // else it stands since an earlier case
  link.opened = record(link, {Event::Kind::opened,
                              burst.start,
                              burst.start,
                              {},
                              (now ? "opened by the device" : "open already") + where(link),
                              -1});
  (*link.opened)->by_device = true;
  return &link;
}

void Links::take_end(Link& link, const Burst& burst) {
  const bool reset = burst.event == LinkEvent::reset;
  link.ending = record(link, {reset ? Event::Kind::reset : Event::Kind::closed,
                              burst.start,
                              burst.start,
                              {},
                              reset ? "reset by the device (RST)" : "closed by the device (FIN)",
                              -1});
  (*link.ending)->by_device = true;
  link.hears = false;
  link.gone = reset;
  link.jilted = link.sends;
}

void Links::take(const endpoints::Endpoint& from, Burst burst) {
  Link* link = find(from, burst.link);
  // A device may keep a connection over several cases.
  if (!link && burst.link >= first_own_link) link = accept(from, burst);
  if (!link || !link->hears) return;
  if (is_end(burst)) return take_end(*link, burst);
  if (burst.event == LinkEvent::opened) return;
  link->last_heard = burst.end();
  link->pending.add(record(
      *link, {Event::Kind::received, burst.start, burst.end(), std::move(burst.bytes), {}, -1}));
  transcript_.flooded = transcript_.flooded || link->pending.bytes().size() > flood_limit;
}

void Links::lose(const endpoints::Endpoint& device) {
  for (Link& link : links_)
    link.lost |= link.network && !link.datagrams() && link.to.endpoint == &device;
}

void Links::close(Link& link, Closing how) {
  if (link.by_device && link.datagrams()) {  // there is nothing to end
    link.sends = link.hears = false;
    link.gone = true;
    return;
  }
  const Time now = link.to.endpoint->now();
  const Status closed = link.to.endpoint->close(link.id, how);
  if (!closed && !transcript_.trouble) transcript_.trouble = closed.error();
  link.sends = false;
  link.hears = link.hears && how == Closing::fin;
  link.gone = how != Closing::fin;
  link.cause = now;
  if (how == Closing::vanish) return note(now, "the bench has vanished", &link);
  const bool reset = how == Closing::rst;
  record(link, {reset ? Event::Kind::reset : Event::Kind::closed,
                now,
                now,
                {},
                reset ? "reset (RST)" : "closed (FIN)",
                step()});
}

void Links::restart(Time now) {
  for (Link& link : links_) link.cause = now;
}

void Links::leave_over() {
  for (Link& link : links_) {
    link.pending.leave_over();
    const bool named = !link.by_device || !link.name.empty();
    if (link.ending && link.jilted && named) (*link.ending)->surplus = true;
    link.ending.reset();
  }
}

void Links::note(Time now, std::string text, const Link* link) {
  Event& event = transcript_.events.emplace_back();
  event.start = event.end = now;
  event.text = std::move(text);
  if (link) event.link = link->name;
}

}  // namespace fieldproof::exchange
