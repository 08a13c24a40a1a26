#include "harness/hosting/device_host.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <set>

#include "harness/endpoints/set_up/device_control.hpp"
#include "harness/hosting/bus_link.hpp"
#include "harness/hosting/host_port.hpp"
#include "harness/hosting/party.hpp"
#include "harness/system/fd_link.hpp"
#include "harness/system/interrupt.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::hosting {

namespace {

using nlohmann::json;

constexpr int exit_usage = 2;
constexpr int exit_trouble = 3;
/// A device that is due again and again must not keep the host from listening.
constexpr int most_at_once = 1000;
/// So many links have names in the monitor.
constexpr std::size_t most_names = 1000;

bool has_line(const HostOptions& options) { return !options.pty.empty() || !options.tty.empty(); }
bool has_both(const HostOptions& options) { return options.port != 0 && has_line(options); }

void complain(const std::string& message) { fmt::print(stderr, "fieldproof: {}\n", message); }

class DeviceHost {
 public:
  DeviceHost(const HostOptions& options, HostPort& port, BusLink* bus)
      : options_(options),
        port_(port),
        bus_(bus),
        control_(options.control),
        answers_(options.control >= 0 ? ::dup(options.control == 0 ? 1 : options.control) : -1),
        hangup_(os::catch_hangup()) {}

  Status begin(const json& config);
  Status change_config(const json& change);
  int run();

 private:
  enum Slot : std::size_t { interrupt_slot, hangup_slot, control_slot, first_port_slot };

  void wait();
  Status hear();
  Status check_listens(const Party& party, const std::string& model) const;
  void run_due(Time until);
  Status serve_bus();
  void tell_time();
  void transmit(std::vector<Burst> bursts);
  void serve_control();
  void answer_lines();
  void power_cycle();
  void show(bool to_device, const Burst& burst);
  bool is_known_to_stand(bool to_device, const Burst& burst);

  const HostOptions& options_;
  HostPort& port_;
  BusLink* bus_;  // nullptr: none
  os::UniqueFd control_, answers_;
  int hangup_;
  os::RunClock clock_;
  std::unique_ptr<plc::EmulatedDevice> device_;
  std::unique_ptr<Party> party_;  // of device_
  Time device_time_{};
  json changed_ = json::object();  // by {"config": ...}
  std::string control_text_;
  bool control_closed_ = false;
  std::vector<pollfd> fds_;
  std::map<LinkId, std::string> names_;  // of links, for the monitor
  std::set<LinkId> unanswered_;          // connections of the device's own, not known to stand
};

/// Replaces the device by a fresh one. What waits on the line belongs to the old one.
Status DeviceHost::begin(const json& config) {
  json merged = options_.config;
  merged.update(config);
  if (!options_.model.empty()) merged["model"] = options_.model;
  merged.emplace("station", 1);  // as the in-process emulator, and as a bench asks by default
  merged.emplace("inter_character_floor_ms", to_ms(port_.own_silence()));
  if (has_both(options_) && merged.contains("services"))
    for (auto& [name, service] : merged["services"].items())
      if (service.is_object())
        service.emplace("inter_character_floor_ms", to_ms(port_.own_silence()));
  Result<std::unique_ptr<plc::EmulatedDevice>> device = options_.make_device(merged);
  if (!device) return device.error();
  const std::string model = merged.value("model", "the device");
  const bool network = options_.port != 0;
  std::unique_ptr<Party> party = party_of(**device, network, !network || has_both(options_));
  if (!party && has_both(options_) && (*device)->network())
    return fail(
        fmt::format("cannot emulate {}: it has no serial line beside its network; leave --pty and "
                    "--tty out, or give it one: --config with "
                    "{{\"services\": {{\"PROTOCOL\": {{}}}}}} of a serial protocol",
                    model));
  if (network && !has_both(options_) && merged.contains("services") && line_of(**device))
    return fail(
        fmt::format("cannot emulate {}: of its services one is on a serial line, to which nothing "
                    "leads; give --pty or --tty as well, or take it out of services",
                    model));
  if (!party)
    return fail(fmt::format("cannot emulate {}: it has no {}", model,
                            options_.port != 0 ? "network; leave --tcp and --udp out"
                                               : "serial line; give --tcp HOST:PORT"));
  if (const Status listens = check_listens(*party, model); !listens) return listens;
  if (bus_ && !(*device)->bus_end())
    return fail(fmt::format("cannot emulate {}: it has no fieldbus; leave --bus out", model));
  // Who has connected since the port is open talks to the first device.
  const bool of_another = device_ || options_.port == 0;
  party_ = std::move(party);
  device_ = std::move(*device);
  if (bus_) bus_->begin(*device_->bus_end());
  if (of_another) port_.flush();
  return ok();
}

Status DeviceHost::change_config(const json& change) {
  json changed = changed_;
  for (const auto& [key, value] : change.items())
    if (value.is_null())
      changed.erase(key);
    else
      changed[key] = value;
  if (const Status begun = begin(changed); !begun) return begun;
  changed_ = std::move(changed);
  return ok();
}

/// Whom would a socket serve that the device does not listen on?
Status DeviceHost::check_listens(const Party& party, const std::string& model) const {
  const auto none = [&](Transport transport) {
    return !party.listens(transport,
                          transport == Transport::tcp ? options_.port : options_.udp_port);
  };
  if (options_.port == 0) return ok();
  if (!options_.tcp.empty() && none(Transport::tcp))
    return fail(fmt::format(
        "cannot emulate {}: it takes no connections as it is set up; leave --tcp out, or "
        "give a client its server in \"services\" (vectors/README.md)",
        model));
  if (!options_.udp.empty() && none(Transport::udp))
    return fail(fmt::format("cannot emulate {}: it takes no datagrams; leave --udp out", model));
  return ok();
}

int DeviceHost::run() {
  while (!os::interrupted() && !control_closed_) {
    wait();
    // The line first: what was sent before a question over the control socket counts before its
    // answer.
    if (const Status heard = hear(); !heard) {
      complain(heard.error().message);
      return exit_trouble;
    }
    run_due(clock_.now());
    if (const Status joined = serve_bus(); !joined) {
      complain(joined.error().message);
      return exit_trouble;
    }
    if (fds_[hangup_slot].revents != 0 || fds_[control_slot].revents != 0) tell_time();
    if (fds_[hangup_slot].revents != 0) power_cycle();
    if (fds_[control_slot].revents != 0) serve_control();
  }
  return 0;
}

void DeviceHost::wait() {
  fds_.assign({{os::interrupt_fd(), POLLIN, 0}, {hangup_, POLLIN, 0}, {control_.get(), POLLIN, 0}});
  port_.add_to(fds_);
  if (bus_) bus_->add_to(fds_);
  timespec timeout{};
  const std::optional<Time> wake = party_->wake_at();
  if (wake) {
    const Duration left = std::max(*wake - clock_.now(), Duration::zero());
    timeout = {static_cast<time_t>(left / 1s), static_cast<long>((left % 1s).count())};
  }
  if (::ppoll(fds_.data(), fds_.size(), wake ? &timeout : nullptr, nullptr) <= 0)
    for (pollfd& one : fds_) one.revents = 0;
  port_.heard(std::span(fds_).subspan(first_port_slot));
}

/// Feeds what has arrived. Where the device was due meanwhile, the host looked late, and the bytes
/// may have come in time: they count as come at that moment, so that a busy machine does not look
/// like a gap on the line.
Status DeviceHost::hear() {
  for (int i = 0; i < most_at_once; ++i) {
    Result<std::optional<Burst>> burst = port_.read();
    if (!burst) return burst.error();
    if (!*burst) return ok();
    Time moment = clock_.now();
    if (const std::optional<Time> wake = party_->wake_at()) moment = std::min(moment, *wake);
    device_time_ = std::max(device_time_, moment);
    (*burst)->start = device_time_;
    show(true, **burst);
    party_->receive(**burst);
    run_due(device_time_);  // not until now: more may be waiting to be read
  }
  return ok();
}

void DeviceHost::run_due(Time until) {
  for (int i = 0; i < most_at_once; ++i) {
    const std::optional<Time> wake = party_->wake_at();
    if (!wake || *wake > until) return;
    device_time_ = std::max(device_time_, *wake);
    transmit(party_->advance(device_time_));
  }
}

/// What a partner asks for, it asks for now.
Status DeviceHost::serve_bus() {
  if (!bus_) return ok();
  if (fds_.back().revents != 0) {
    tell_time();
    if (const Status served = bus_->serve(*device_->bus_end()); !served) return served;
  }
  bus_->tell(*device_->bus_end());
  return ok();
}

/// What is changed through the back door is changed now, not when the device last had something to
/// do: a client whose flag rises counts its time-out from here.
void DeviceHost::tell_time() {
  device_time_ = std::max(device_time_, clock_.now());
  transmit(party_->advance(device_time_));
}

void DeviceHost::transmit(std::vector<Burst> bursts) {
  for (const Burst& burst : bursts) {
    port_.write(burst);
    show(false, burst);
  }
}

void DeviceHost::serve_control() {
  std::array<char, 4096> buffer;
  const ssize_t n = ::read(control_.get(), buffer.data(), buffer.size());
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (n <= 0) {
    control_closed_ = true;  // the bench has ended
    return;
  }
  control_text_.append(buffer.data(), static_cast<std::size_t>(n));
  answer_lines();
}

void DeviceHost::answer_lines() {
  for (std::size_t end; (end = control_text_.find('\n')) != std::string::npos;
       control_text_.erase(0, end + 1)) {
    std::string answer =
        endpoints::answer_control(std::string_view(control_text_).substr(0, end),
                                  {[this](const json& config) { return begin(config); },
                                   [this](const json& change) { return change_config(change); },
                                   [this] { return device_.get(); }});
    for (std::string_view left = answer; !left.empty();) {
      const ssize_t n = ::write(answers_.get(), left.data(), left.size());
      if (n < 0 && errno == EINTR && !os::interrupted()) continue;
      if (n < 0) {
        control_closed_ = true;
        return;
      }
      left.remove_prefix(static_cast<std::size_t>(n));
    }
  }
}

void DeviceHost::power_cycle() {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t n = ::read(hangup_, &count, sizeof count);
  if (const Status done = device_->act("power_cycle"); !done) complain(done.error().message);
}

void DeviceHost::show(bool to_device, const Burst& burst) {
  if (!options_.monitor) return;
  if (burst.link != line_link && !burst.peer.empty()) {
    if (names_.size() >= most_names) names_.erase(names_.begin());
    names_[burst.link] = burst.link < first_own_link
                             ? fmt::format("#{} {}", burst.link, burst.peer)
                             : fmt::format("#own {} to {}:{}", burst.link - first_own_link + 1,
                                           burst.peer, burst.port);
  }
  const auto name = names_.find(burst.link);
  options_.monitor({clock_.now(), to_device, burst.bytes, burst.event,
                    name == names_.end() ? "" : name->second, is_known_to_stand(to_device, burst)});
}

/// Of connections of the device's own.
bool DeviceHost::is_known_to_stand(bool to_device, const Burst& burst) {
  if (!to_device && burst.event == LinkEvent::opened) unanswered_.insert(burst.link);
  const bool answered = to_device ? burst.event != LinkEvent::reset : port_.stands(burst.link);
  const bool stands = answered || !unanswered_.contains(burst.link);
  if (answered || burst.event == LinkEvent::reset) unanswered_.erase(burst.link);
  return stands;
}

/// What happened on a link; empty: bytes were sent.
std::string happening(const Traffic& traffic) {
  const char* by = traffic.to_device ? "the other side" : "the device";
  switch (traffic.event) {
    case LinkEvent::opened: return traffic.to_device ? "connected" : "connects";
    case LinkEvent::closed: return fmt::format("closed by {} (FIN)", by);
    case LinkEvent::reset:
      return traffic.stands ? fmt::format("reset by {} (RST)", by)
                            : "refused, or out of reach: nothing was sent";
    case LinkEvent::data:
    case LinkEvent::datagram: break;
  }
  return {};
}

void announce(const HostOptions& options, const std::string& where) {
  if (options.say) return options.say(where);
  if (options.control > 0) return;  // a bench started it, and knows
  fmt::print("{}\n", where);
  std::fflush(stdout);
}

/// "line" of the device, or of its service on the line.
std::string line_settings(const HostOptions& options) {
  const auto line_in = [](const json& config) {
    const auto line = config.find("line");
    return line != config.end() && line->is_string() ? line->get<std::string>() : std::string();
  };
  std::string line = line_in(options.config);
  if (has_both(options) && options.config.contains("services"))
    for (const json& service : options.config["services"])
      if (service.is_object() && line.empty()) line = line_in(service);
  return line.empty() ? line::to_string(line::LineSettings{}) : line;
}

Result<std::unique_ptr<HostPort>> open_line(const HostOptions& options) {
  return options.tty.empty() ? open_pty_port(options.pty)
                             : open_tty_port(options.tty, line_settings(options));
}

int host(const HostOptions& options, Result<std::unique_ptr<HostPort>> port) {
  if (!port) {
    complain(port.error().message);
    return exit_trouble;
  }
  os::catch_interrupts();
  ::signal(SIGPIPE, SIG_IGN);  // a bench that has ended reads no answers
  std::optional<BusLink> bus;
  if (!options.bus.empty()) {
    Result<BusLink> opened = BusLink::open(options.bus);
    if (!opened) {
      complain(opened.error().message);
      return exit_trouble;
    }
    bus = std::move(*opened);
  }
  DeviceHost host(options, **port, bus ? &*bus : nullptr);
  if (const Status made = host.begin(json::object()); !made) {
    complain(made.error().message);
    return exit_usage;
  }
  announce(options, (*port)->describe() + (bus ? ", " + bus->describe() : ""));
  return host.run();
}

}  // namespace

std::string monitor_line(const Traffic& traffic) {
  std::string text = to_text(traffic.bytes);
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '.');
  const std::string link = traffic.link.empty() ? "" : traffic.link + "  ";
  if (const std::string what = happening(traffic); !what.empty())
    return fmt::format("{:>12.3f} ms  {}{}", to_ms(traffic.moment), link, what);
  return fmt::format("{:>12.3f} ms  {}{}  {:>4}  {}  {}", to_ms(traffic.moment), link,
                     traffic.to_device ? "received"
                     : traffic.stands  ? "sent    "
                                       : "waiting ",
                     traffic.bytes.size(), to_hex(traffic.bytes), text);
}

int host_on_tty(const HostOptions& options) { return host(options, open_line(options)); }

int host_on_socket(const HostOptions& options) {
  if (options.port == 0) return host(options, open_line_socket(options.tcp));
  Result<std::unique_ptr<HostPort>> network =
      open_network_port({options.tcp, options.udp, options.port, options.udp_port});
  if (!network || !has_line(options)) return host(options, std::move(network));
  Result<std::unique_ptr<HostPort>> line = open_line(options);
  if (line) line = join_ports(std::move(*network), std::move(*line));
  return host(options, std::move(line));
}

int host_device(const HostOptions& options) {
  return options.port == 0 && options.tcp.empty() ? host_on_tty(options) : host_on_socket(options);
}

}  // namespace fieldproof::hosting
