#include "harness/endpoints/rfc2217.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/endpoints/serial_ports/rfc2217_session.hpp"

namespace fieldproof::endpoints {

namespace {

constexpr Duration default_patience = 3s;

class Rfc2217Endpoint final : public Endpoint {
 public:
  Rfc2217Endpoint(const EndpointName& name, const SerialOptions& options, Duration patience)
      : where_(name.target),
        settings_(options.settings),
        session_(name.target, options.settings, options.direction, patience) {
    capabilities_ = capabilities_of(name);
    capabilities_.timing_floor = options.floor;
    capabilities_.shared = is_shared(name);
    capabilities_.paced = true;
  }

  Status open() {
    Status opened = session_.open();
    if (opened) capabilities_.round_trip = session_.round_trip();
    return opened;
  }

  const Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override {
    return "rfc2217:" + where_ + ' ' + line::to_string(settings_);
  }
  Time now() const override { return session_.now(); }
  void has_no_wire() override {
    capabilities_.paced = false;
    session_.has_no_wire();
  }
  Duration character_time() const override { return settings_.character_time(); }
  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId) override { return session_.send(bytes); }
  Result<Burst> receive(Time deadline) override { return session_.receive(deadline); }

  Status begin(const nlohmann::json&) override {
    if (!session_.ended()) return ok();
    ++reconnections_;
    return session_.open();
  }

  bool lets_others_in() override { return os::takes_another_client(where_); }

  std::string line_errors() override {
    std::string text = line_errors_between({}, session_.take_line_errors());
    const int count = std::exchange(reconnections_, 0);
    if (count > 0)
      text += fmt::format("{}{} lost connection{}", text.empty() ? "" : ", ", count,
                          count == 1 ? "" : "s");
    return text;
  }

 private:
  Capabilities capabilities_;
  std::string where_;
  line::LineSettings settings_;
  Rfc2217Session session_;
  int reconnections_ = 0;
};

}  // namespace

Result<std::unique_ptr<Endpoint>> open_rfc2217(const EndpointName& name) {
  return open_rfc2217(name, default_patience);
}

Result<std::unique_ptr<Endpoint>> open_rfc2217(const EndpointName& name, Duration patience) {
  const Result<SerialOptions> options = serial_options(name);
  if (!options) return options.error();
  if (options->direction == Direction::kernel) {
    return fail(
        fmt::format("cannot open rfc2217:{}: RFC 2217 has no command for rs485=1; set it at the "
                    "server (ser2net.yaml: "
                    "`connector: serialdev,/dev/ttyUSB0,9600n81,local,rs485=0:0`) and leave rs485 "
                    "out here, or use rs485=rts",
                    name.target));
  }
  auto endpoint = std::make_unique<Rfc2217Endpoint>(name, *options, patience);
  if (const Status opened = endpoint->open(); !opened) return opened.error();
  return std::unique_ptr<Endpoint>(std::move(endpoint));
}

}  // namespace fieldproof::endpoints
