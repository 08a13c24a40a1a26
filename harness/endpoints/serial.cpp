#include "harness/endpoints/serial.hpp"

#include <sys/ioctl.h>
#include <termios.h>

#include <nlohmann/json.hpp>

#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/endpoints/serial_ports/serial_port.hpp"
#include "harness/endpoints/serial_ports/serial_settings.hpp"
#include "harness/system/fd_link.hpp"

namespace fieldproof::endpoints {

namespace {

/// An argument of ioctl that is a number.
void* number(std::intptr_t value) { return reinterpret_cast<void*>(value); }

class SerialEndpoint final : public Endpoint {
 public:
  SerialEndpoint(const os::SystemCalls& calls, SerialPort port, const EndpointName& name,
                 const SerialOptions& options)
      : calls_(calls),
        lock_(std::move(port.lock)),
        path_(name.target),
        settings_(options.settings),
        direction_(options.direction),
        link_(std::move(port.fd), "serial:" + path_),
        latency_(std::move(port.latency)) {
    capabilities_ = capabilities_of(name);
    capabilities_.wire = !is_pty(calls_, link_.fd());
    capabilities_.timing_floor = options.floor;
    if (capabilities_.wire) use_wire();
    counting_ = read_line_errors(calls_, link_.fd(), counted_);
  }
  ~SerialEndpoint() override {
    // Where another process keeps the terminal open, the exclusive mode would outlive us.
    calls_.ioctl(link_.fd(), TIOCNXCL, nullptr);
  }

  const Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override {
    return "serial:" + path_ + ' ' + line::to_string(settings_);
  }
  Time now() const override { return link_.now(); }
  Duration character_time() const override { return settings_.character_time(); }
  void has_no_wire() override {
    capabilities_.wire = capabilities_.paced = false;
    capabilities_.driver_silence.reset();
    link_.set_character_time({});
  }
  Status begin(const nlohmann::json&) override { return ok(); }
  Result<Burst> receive(Time deadline) override { return link_.receive(deadline); }

  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId) override {
    if (direction_ != Direction::rts) return link_.send(bytes);
    if (const Status on = set_rts(calls_, link_.fd(), path_, true); !on) return on.error();
    Result<Sent> sent = link_.send(bytes);
    // The time is over by now; TCSBRK with 1 (tcdrain) covers what the driver still holds.
    calls_.ioctl(link_.fd(), TCSBRK, number(1));
    if (const Status off = set_rts(calls_, link_.fd(), path_, false); !off) return off.error();
    return sent;
  }

  std::string line_errors() override {
    LineErrorCounts counts;
    if (!counting_ || !read_line_errors(calls_, link_.fd(), counts)) return "";
    std::string text = line_errors_between(counted_, counts);
    counted_ = counts;
    return text;
  }

 private:
  void use_wire() {
    capabilities_.paced = true;
    link_.set_character_time(settings_.character_time());
    capabilities_.line = line::to_string(settings_);
    capabilities_.driver_silence = latency_->silence(settings_.character_time());
    capabilities_.driver_silence_by = latency_->describe();
  }

  os::SystemCalls calls_;
  os::PortLock lock_;  // outlives link_: the port is free when its lock is
  Capabilities capabilities_;
  std::string path_;
  line::LineSettings settings_;
  Direction direction_;
  os::FdLink link_;
  std::unique_ptr<ReceiveLatency> latency_;  // nullptr: a pty
  LineErrorCounts counted_;
  bool counting_ = false;
};

}  // namespace

Result<std::unique_ptr<Endpoint>> open_serial(const EndpointName& name) {
  return open_serial(name, os::real_system_calls());
}

Result<std::unique_ptr<Endpoint>> open_serial(const EndpointName& name,
                                              const os::SystemCalls& calls) {
  const std::string& path = name.target;
  const Result<SerialOptions> options = serial_options(name);
  if (!options) return options.error();
  if (path.empty())
    return fail("cannot open serial: there is no port; write serial:/dev/ttyUSB0; " +
                serial_ports_there());

  Result<SerialPort> port = open_serial_port(calls, path, options->settings);
  if (!port) return port.error();
  if (const Status done = apply_direction(calls, port->fd.get(), path, options->direction); !done)
    return done.error();
  calls.ioctl(port->fd.get(), TCFLSH, number(TCIOFLUSH));
  return std::unique_ptr<Endpoint>(
      std::make_unique<SerialEndpoint>(calls, std::move(*port), name, *options));
}

}  // namespace fieldproof::endpoints
