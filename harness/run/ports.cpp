#include "harness/run/ports.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <tuple>

#include "harness/bench/what_to_check.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/run/exit_code.hpp"
#include "harness/run/look_on.hpp"

namespace fieldproof::run {

using bench::Benches;

namespace {

Status open_journal(const RunOptions& options, DutPlan& plan) {
  if (plan.journal.empty()) return ok();
  Result<safety::Journal> journal = safety::Journal::open(plan.journal);
  if (!journal) return journal.error();
  for (const safety::JournalDevice& device : {plan.bench.device, plan.bench.aux_device}) {
    // What a device that ended with its run had is gone with it.
    if (options.discard_journal || (plan.ends_with_run && !plan.aux))
      if (Status discarded = journal->discard(device); !discarded) return discarded;
    const auto open = std::ranges::count_if(
        journal->open_entries(),
        [&](const safety::OpenEntry& one) { return safety::is_same_device(one.device, device); });
    if (open > 0)
      return fail(
          fmt::format("cannot write to {}: an earlier run was cut off before it had put back {} of "
                      "its values; type: fieldproof restore {}\n"
                      "(or forget them: --discard-journal)",
                      device.endpoint, open, shell_word(plan.journal)));
  }
  plan.bench.journal = std::make_shared<safety::Journal>(std::move(*journal));
  return ok();
}

}  // namespace

Status open_journals(const RunOptions& options, RunPlan& plan) {
  Status opened = open_journal(options, plan);
  for (std::size_t i = 0; i < plan.others.size() && opened; ++i)
    opened = open_journal(options, plan.others[i]);
  return opened;
}

Result<Fixtures> Fixtures::open(const DutPlan& plan) {
  Fixtures fixtures;
  if (plan.aux)
    if (const Status opened = fixtures.open_aux(*plan.aux, plan.bench.aux_device, plan.known);
        !opened)
      return opened.error();
  for (const auto& [option, command, program] :
       {std::tuple("--stimulus", plan.stimulus, &fixtures.stimulus_),
        std::tuple("--control", plan.control, &fixtures.control_)}) {
    if (command.empty() || command == "-") continue;
    Result<std::unique_ptr<os::LineProgram>> started = os::LineProgram::start(option, command);
    if (!started) return started.error();
    *program = std::move(*started);
  }
  return fixtures;
}

void Fixtures::give(bench::BenchOptions& bench, const DutPlan& plan) const {
  if (aux_) bench.aux = {aux_.get(), aux_protocol_, aux_station_};
  bench.endpoint_is_stimulus = plan.stimulus == "-";
  if (stimulus_) bench.stimulus = exchange::program_of(*stimulus_);
  bench.endpoint_is_control = plan.control == "-";
  if (os::LineProgram* const program = control_.get())
    bench.control = {[program](const std::string& line) { return program->tell(line); },
                     [program](Duration patience) { return program->answer(patience); }};
}

Status Fixtures::open_aux(const endpoints::EndpointName& name, const safety::JournalDevice& device,
                          const harness::Protocols& known) {
  const Result<const harness::Protocol*> protocol = known.choose(device.protocol, "");
  if (!protocol) return fail("--aux: " + protocol.error().message);
  const harness::Protocol& spoken = endpoints::spoken_over(name, **protocol);
  Result<std::unique_ptr<harness::Protocol>> configured =
      spoken.configured(device.model, device.config);
  if (!configured) return fail("--aux: " + configured.error().message);
  aux_configured_ = std::move(*configured);
  Result<std::unique_ptr<endpoints::Endpoint>> endpoint = endpoints::open_endpoint(name, spoken);
  if (!endpoint) return fail("--aux: " + endpoint.error().message);
  aux_ = std::move(*endpoint);
  aux_protocol_ = aux_configured_ ? aux_configured_.get() : &spoken;
  aux_station_ = device.station;
  const Result<exchange::Sign> alive =
      exchange::Exchange(*aux_, *aux_protocol_, {}).first_sign(aux_station_, 10s);
  if (!alive) return alive.error();
  if (*alive == exchange::Sign::echo)
    return fail("--aux: " + bench::why_silent({aux_.get(), aux_protocol_, aux_station_}, *alive));
  return *alive == exchange::Sign::alive
             ? ok()
             : Status(fail(fmt::format("nothing answers on --aux {} at station {}",
                                       aux_->describe(), aux_station_)));
}

Result<std::vector<Fixtures>> open_fixtures(RunPlan& plan) {
  std::vector<Fixtures> all;
  const auto open = [&](DutPlan& dut) -> Status {
    Result<Fixtures> fixtures = Fixtures::open(dut);
    if (!fixtures) return fixtures.error();
    fixtures->give(dut.bench, dut);
    all.push_back(std::move(*fixtures));
    return ok();
  };
  Status opened = open(plan);
  for (std::size_t i = 0; i < plan.others.size() && opened; ++i) opened = open(plan.others[i]);
  if (!opened) return opened.error();
  return all;
}

Result<std::vector<Benches>> open_ports(const RunPlan& plan) {
  std::vector<Benches> ports;
  const auto open = [&](const DutPlan& dut) -> Status {
    Result<Benches> port =
        Benches::open(plan.matrix.empty() ? dut.endpoint
                                          : endpoints::with_line(dut.endpoint, plan.matrix.front()),
                      dut.protocols, dut.bench);
    if (!port) return port.error();
    ports.push_back(std::move(*port));
    return ok();
  };
  if (const Status opened = open(plan); !opened) return opened.error();
  for (const DutPlan& other : plan.others)
    if (const Status opened = open(other); !opened) return opened.error();
  return ports;
}

namespace {

Status take_fingerprint(DutPlan& dut, Benches& port, bool wanted) {
  const bench::Fingerprint& declared = dut.identity.fingerprint;
  if (declared.empty() && !wanted) return ok();
  Result<bench::Fingerprint> found = port.fingerprint();
  if (!found && declared.empty()) return ok();
  if (!found) return looked_on(found.error(), port, dut);
  dut.identity.fingerprint_found = std::move(*found);
  const std::string difference =
      bench::fingerprint_difference(declared, dut.identity.fingerprint_found);
  if (difference.empty()) return ok();
  return fail(
      fmt::format("this is not the device '{}' of the bench file: {}; connect that device, or take "
                  "the fingerprint anew with "
                  "fieldproof probe ENDPOINT --fingerprint",
                  dut.identity.name, difference));
}

}  // namespace

Status take_fingerprints(RunPlan& plan, std::vector<Benches>& ports, bool wanted) {
  Status taken = take_fingerprint(plan, ports.front(), wanted);
  for (std::size_t i = 0; i < plan.others.size() && taken; ++i)
    taken = take_fingerprint(plan.others[i], ports[i + 1], wanted);
  return taken;
}

}  // namespace fieldproof::run
