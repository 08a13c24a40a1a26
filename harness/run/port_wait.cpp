#include "harness/run/port_wait.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "harness/endpoints/kinds.hpp"
#include "harness/run/exit_code.hpp"
#include "harness/system/interrupt.hpp"
#include "harness/system/port_watch.hpp"

namespace fieldproof::run {

namespace {

using Clock = std::chrono::steady_clock;

constexpr Duration ask_server_every = 1s;
/// Our own trying may be among what happened: it is not to keep the processor busy.
constexpr Duration between_tries = 200ms;

bool is_waited_for(const endpoints::KindOf& kind) {
  return !kind.emulated && !kind.can_restart && !kind.listens;
}

Status await_port(const DutPlan& dut, Clock::time_point give_up) {
  const endpoints::KindOf& kind = endpoints::kind_of(dut.endpoint);
  std::optional<os::PortWatch> watch;
  if (kind.local_port) watch.emplace(dut.endpoint.target);
  for (std::string told; is_waited_for(kind);) {
    if (watch) watch->arm();
    const auto port = endpoints::open_endpoint(dut.endpoint, *dut.protocols.front());
    if (port) break;
    const Duration left = give_up - Clock::now();
    if (port.error().interrupted || left <= 0ns) return port.error();
    if (told != port.error().message) complain("waiting: " + port.error().message, 0);
    told = port.error().message;
    if (watch) watch->wait(left);
    os::pause_for(std::min(left, watch ? between_tries : ask_server_every));
    if (os::interrupted()) return Error{"interrupted", true};
  }
  return ok();
}

}  // namespace

Status await_ports(const RunPlan& plan) {
  if (plan.wait_port == 0ns) return ok();
  const auto give_up = Clock::now() + plan.wait_port;
  for (std::size_t i = 0; i <= plan.others.size(); ++i) {
    const Status free = await_port(plan.dut(i), give_up);
    if (free || (!plan.others.empty() && !free.error().interrupted)) continue;
    Error why = free.error();
    if (!why.interrupted)
      why.message += fmt::format(" (waited for {:g} s: --wait-port)", to_ms(plan.wait_port) / 1000);
    return why;
  }
  return ok();
}

}  // namespace fieldproof::run
