#include "harness/run/ports.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <thread>
#include <tuple>

#include "harness/bench/what_to_check.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/run/exit_code.hpp"
#include "harness/run/look_on.hpp"
#include "harness/safety/journal_note.hpp"

namespace fieldproof::run {

using bench::Benches;

namespace {

/// Whose memory the plan's journal may hold. What a device that ended with its run had is gone.
std::vector<safety::JournalDevice> lasting_devices(const DutPlan& plan) {
  std::vector<safety::JournalDevice> devices;
  if (!plan.ends_with_run) devices.push_back(plan.bench.device);
  if (plan.aux) devices.push_back(plan.bench.aux_device);
  return devices;
}

Status check_open(const std::vector<safety::OpenEntry>& entries,
                  const safety::JournalDevice& device, const std::string& journal) {
  const auto open = std::ranges::count_if(entries, [&](const safety::OpenEntry& one) {
    return safety::is_same_device(one.device, device);
  });
  if (open == 0) return ok();
  return fail(
      fmt::format("cannot write to {}: an earlier run was cut off before it had put back {} of its "
                  "values; type: fieldproof restore {}\n"
                  "(or forget them: --discard-journal)",
                  device.endpoint, open, shell_word(journal)));
}

/// What an earlier run has left of this device, whatever folder it wrote to.
Status check_noted_journal(const RunOptions& options, const safety::JournalDevice& device,
                           const std::string& own) {
  const std::string other = safety::JournalNote(device).journal();
  std::error_code failed;
  const bool there = std::filesystem::exists(other, failed);
  if (other.empty() || (options.discard_journal && !there)) return ok();
  if (std::filesystem::equivalent(other, own, failed)) return ok();  // opened and looked at next
  if (options.discard_journal) {
    Result<safety::Journal> journal = safety::Journal::open(other);
    return journal ? journal->discard(device) : Status(journal.error());
  }
  if (!there)
    return fail(
        fmt::format("cannot write to {}: an earlier run was cut off, and what it had not put back "
                    "stood in {}, which is gone; see that the device is as it should be, then "
                    "forget it: --discard-journal",
                    device.endpoint, other));
  const Result<std::vector<safety::OpenEntry>> entries = safety::read_journal(other);
  return entries ? check_open(*entries, device, other) : Status(entries.error());
}

/// The notes of a device end with a run that has put back all.
std::shared_ptr<safety::Journal> noted(safety::Journal journal,
                                       std::vector<safety::JournalDevice> devices) {
  for (const safety::JournalDevice& device : devices)
    safety::JournalNote(device).keep(journal.path());
  return {new safety::Journal(std::move(journal)),
          [devices = std::move(devices)](safety::Journal* used) {
            const std::unique_ptr<safety::Journal> owned(used);
            for (const safety::JournalDevice& device : devices)
              if (used->open_entries().empty()) safety::JournalNote(device).drop(used->path());
          }};
}

Status open_journal(const RunOptions& options, DutPlan& plan) {
  if (plan.journal.empty()) return ok();
  const std::vector<safety::JournalDevice> devices = lasting_devices(plan);
  for (const safety::JournalDevice& device : devices)
    if (const Status none = check_noted_journal(options, device, plan.journal); !none) return none;
  Result<safety::Journal> journal = safety::Journal::open(plan.journal);
  if (!journal) return journal.error();
  for (const safety::JournalDevice& device : {plan.bench.device, plan.bench.aux_device}) {
    // What a device that ended with its run had is gone with it.
    if (options.discard_journal || (plan.ends_with_run && !plan.aux))
      if (Status discarded = journal->discard(device); !discarded) return discarded;
    if (const Status none = check_open(journal->open_entries(), device, plan.journal); !none)
      return none;
  }
  plan.bench.journal = noted(std::move(*journal), devices);
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

namespace {

Status open_device(DutPlan& dut, const RunPlan& plan, Devices& opened) {
  Result<Fixtures> fixtures = Fixtures::open(dut);
  if (!fixtures) return fixtures.error();
  fixtures->give(dut.bench, dut);
  Result<Benches> port = Benches::open(
      plan.matrix.empty() ? dut.endpoint : endpoints::with_line(dut.endpoint, plan.matrix.front()),
      dut.protocols, dut.bench);
  if (!port) return port.error();
  opened.fixtures.push_back(std::move(*fixtures));
  opened.ports.push_back(std::move(*port));
  return ok();
}

/// None of them can be opened.
Error all_missing(const std::vector<Error>& missing) {
  Error all{{}, false, true};
  for (const Error& one : missing) {
    all.message += (all.message.empty() ? "" : "; ") + one.message;
    all.absent &= one.absent;
  }
  return all;
}

}  // namespace

Result<Devices> open_devices(RunPlan& plan) {
  std::vector<DutPlan> duts;
  duts.push_back(std::move(static_cast<DutPlan&>(plan)));
  std::ranges::move(plan.others, std::back_inserter(duts));
  plan.others.clear();
  Devices opened;
  const bool alone = duts.size() == 1;
  for (DutPlan& dut : duts) {
    const Status there = open_device(dut, plan, opened);
    if (!there && (alone || there.error().interrupted)) return there.error();
    if (!there)
      plan.missing.push_back(
          {dut.identity.name + ": " + there.error().message, false, there.error().absent});
    else if (opened.ports.size() == 1)
      static_cast<DutPlan&>(plan) = std::move(dut);
    else
      plan.others.push_back(std::move(dut));
  }
  if (opened.ports.empty()) return all_missing(plan.missing);
  return opened;
}

Result<std::vector<Benches>> open_more(const RunPlan& plan, std::size_t cases) {
  constexpr std::size_t cases_a_thread = 64;  // fewer are over before a thread has begun
  std::vector<Benches> more;
  const bool beside = plan.aux || !plan.stimulus.empty() || !plan.control.empty();
  if (!plan.matrix.empty() || plan.soak > 0ns || beside) return more;
  const std::size_t processors = std::thread::hardware_concurrency();
  const std::size_t threads = processors < 2 ? 0 : std::min(processors, cases / cases_a_thread);
  while (more.size() < threads) {
    Result<Benches> one = Benches::open(plan.endpoint, plan.protocols, plan.bench);
    if (!one) return one.error();
    more.push_back(std::move(*one));
  }
  return more;
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
