#include "harness/vectors/link_names.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::vectors {

namespace {

bool uses_link(Step::Kind kind) {
  switch (kind) {
    case Step::Kind::send:
    case Step::Kind::expect:
    case Step::Kind::silence:
    case Step::Kind::partner:
    case Step::Kind::close:
    case Step::Kind::expect_close: return true;
    default: return false;
  }
}

bool pauses(const Step& step) {
  const auto is_pause = [](const notation::Item& item) {
    return item.kind == notation::Item::Kind::pause;
  };
  return std::ranges::any_of(step.frames, [&](const Frame& frame) {
    return std::ranges::any_of(frame.notation, is_pause);
  });
}

/// Has a P2P channel of the device this protocol for its own?
bool speaks(const nlohmann::json& config, const std::string& protocol) {
  const auto p2p = config.find("p2p");
  if (p2p == config.end() || !p2p->is_object()) return false;
  const nlohmann::json channels = p2p->value("channels", nlohmann::json::array());
  return std::ranges::any_of(channels, [&](const nlohmann::json& one) {
    return one.is_object() && one.value("protocol", "") == protocol;
  });
}

bool sends(Step::Kind kind) { return kind == Step::Kind::send || kind == Step::Kind::partner; }

}  // namespace

LinkNames::LinkNames(const Case& source, bool network, IsLine lines)
    : source_(source),
      lines_(std::move(lines)),
      network_(network),
      client_(is_client_case(source)) {
  const bool opens = std::ranges::any_of(
      source.steps, [](const Step& step) { return step.kind == Step::Kind::open; });
  implicit_ = network && !client_ && !opens;
  if (implicit_ || client_ || !network) entries_.push_back({""});
  entries_.push_back({std::string(aux_link)});
}

LinkNames::Entry* LinkNames::find(const std::string& name) {
  const auto found = std::find_if(entries_.rbegin(), entries_.rend(),
                                  [&](const Entry& entry) { return entry.name == name; });
  return found == entries_.rend() ? nullptr : &*found;
}

std::string LinkNames::open_names() const {
  std::string names;
  for (const Entry& entry : entries_)
    if (entry.state != State::ended && !entry.name.empty() && entry.name != aux_link)
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", entry.name);
  return names.empty() ? "no link is open" : "open: " + names;
}

Result<std::string> LinkNames::next(const Step& step) {
  if (step.kind == Step::Kind::open) return opened(step);
  if (step.kind == Step::Kind::expect_open) return opened_by_device(step);
  if (!uses_link(step.kind)) {
    if (step.on.empty()) return std::string();
    return fail(fmt::format("\"on\": \"{}\": this step uses no link", step.on));
  }
  const Result<Entry*> used = this->used(step);
  if (!used) return used.error();
  Entry& entry = **used;
  // A line, and what the device may open again at any time, never ends for good.
  const bool own_line = entry.name.empty() && !network_;
  const bool line = own_line || entry.name == aux_link || !entry.line.empty();
  const bool lasts = line || (entry.name.empty() && client_);
  const bool ends = step.kind == Step::Kind::close || step.kind == Step::Kind::expect_close;
  if (ends && line)
    return fail(fmt::format(
        "{} runs on a serial line, which neither side can close; take \"{}\" out, or name a link "
        "of a protocol of a network (\"on\")",
        own_line             ? source_.protocol
        : entry.line.empty() ? entry.name
                             : entry.line,
        step.kind == Step::Kind::close ? "close" : "expect_close"));
  if (lasts) return entry.name;
  if (entry.state == State::ended || (sends(step.kind) && entry.state != State::open) ||
      (step.kind == Step::Kind::close && entry.state != State::open))
    return fail(fmt::format("link '{}' is closed; {}", entry.name, open_names()));
  if (step.kind == Step::Kind::send && entry.datagrams && pauses(step))
    return fail(fmt::format(
        "link '{}' carries datagrams, and one send is one of them: take the pause (~) out",
        entry.name));
  if (step.kind == Step::Kind::close)
    entry.state = step.closing == Closing::fin ? State::half_closed : State::ended;
  if (step.kind == Step::Kind::expect_close) entry.state = State::ended;
  return entry.name;
}

/// Empty: it is on a network.
std::string LinkNames::line_of(const LinkSpec& link) const {
  if (link.protocol.empty() || link.protocol == source_.protocol)
    return network_ ? "" : source_.protocol;
  return lines_ && lines_(link.protocol) ? link.protocol : "";
}

Result<std::string> LinkNames::opened(const Step& step) {
  const std::string& protocol = step.link.protocol;
  const auto services = source_.config.find("services");
  const bool serves = services != source_.config.end() && services->contains(protocol);
  if (client_ && !serves)
    return fail(
        "the device opens the connections of a case of role client; expect_open names one, or "
        "\"protocol\" of \"open\" a server in given.config.services");
  if (!network_ && step.link.protocol.empty())
    return fail(fmt::format(
        "{} runs on a serial line, which is always open; take \"open\" out, or name the "
        "\"protocol\" of another service of the device",
        source_.protocol));
  if (step.on.empty() || step.on == aux_link)
    return fail(fmt::format("a link cannot be called '{}'", step.on));
  const Entry* same = find(step.on);
  if (same && same->state == State::open)
    return fail(fmt::format("link '{}' is open already", step.on));
  if (!protocol.empty() && protocol != source_.protocol && !serves)
    return fail(
        fmt::format("{} is no service of this case; list it in given.config.services", protocol));
  entries_.push_back(
      {step.on, State::open, step.link.transport == Transport::udp, line_of(step.link)});
  return step.on;
}

Result<std::string> LinkNames::opened_by_device(const Step& step) {
  if (!client_ || !network_)
    return fail(
        "expect_open waits for a connection of the device, which none but a case of role "
        "client on a network has");
  const Entry* same = find(step.on);
  if (step.on.empty() || step.on == aux_link || (same && same->state == State::open))
    return fail(fmt::format("a connection cannot be called '{}': {}", step.on,
                            same ? "that name is taken" : "it needs a name"));
  if (step.link.transport == Transport::udp)
    return fail("expect_open waits for a connection, which no datagram opens; take transport out");
  if (!step.link.protocol.empty() && step.link.protocol != source_.protocol &&
      !speaks(source_.config, step.link.protocol))
    return fail(fmt::format("no channel of the device speaks {}; list it in p2p.channels",
                            step.link.protocol));
  entries_.push_back({step.on});
  return step.on;
}

Result<LinkNames::Entry*> LinkNames::used(const Step& step) {
  if (!step.on.empty()) {
    if (Entry* named = find(step.on)) return named;
    return fail(fmt::format("no link '{}' is open; {}", step.on, open_names()));
  }
  const auto own_name = [](const Entry& entry) {
    return !entry.name.empty() && entry.name != aux_link;
  };
  const bool named = network_ && client_ && std::ranges::any_of(entries_, own_name);
  if (Entry* implicit = named ? nullptr : find("")) return implicit;
  std::vector<Entry*> open, half;
  for (Entry& entry : entries_) {
    if (entry.name == aux_link || (named && entry.name.empty())) continue;
    if (entry.state == State::open) open.push_back(&entry);
    if (entry.state == State::half_closed) half.push_back(&entry);
  }
  if (open.size() == 1) return open.front();
  if (open.empty() && !half.empty() && !sends(step.kind)) return half.back();
  return fail(open.empty()
                  ? std::string("no link is open here")
                  : fmt::format("several links are open, so the step must say \"on\" which; {}",
                                open_names()));
}

Status check_links(const Case& source, bool network, LinkNames::IsLine lines) {
  LinkNames names(source, network, std::move(lines));
  for (std::size_t i = 0; i < source.steps.size(); ++i)
    if (const Result<std::string> name = names.next(source.steps[i]); !name)
      return fail(fmt::format("steps[{}]: {}", i, name.error().message));
  return ok();
}

}  // namespace fieldproof::vectors
