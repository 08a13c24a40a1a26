// The steps of a case that open and close links, or look past them at the device.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/exchange/case_run.hpp"

namespace fieldproof::exchange {

using vectors::Step;

namespace {

constexpr Duration restart_patience = 10s;

}  // namespace

void CaseRun::open(const PreparedStep& step) {
  const Channel to{around_.device.endpoint, step.protocol, step.station};
  if (!step.network) return open_line(step.link, to);
  if (links_.open(step.link, to, step.step->link.transport, step.port)) links_.restart(now());
}

void CaseRun::open_line(const std::string& name, const Channel& to) {
  constexpr unsigned second_channel = 2;  // "services" (vectors/README.md)
  const Result<LinkId> id = to.endpoint->open_line(second_channel);
  if (!id)
    transcript_.trouble = id.error();
  else
    links_.add_line(name, to, *id);
}

/// What it says on the connection may have come with it.
void CaseRun::await_opening(const PreparedStep& step) {
  const Link* implicit = links_.find("");
  record().cause = implicit ? implicit->cause : now();
  record().deadline =
      record().cause + prepared_.reply_limit(*step.step, around_.timing.response_max);
  const Time give_up = record().deadline + around_.timing.late_watch;
  Link* link = links_.unnamed_of_device();
  while (!link && links_.listen(*around_.device.endpoint, give_up))
    link = links_.unnamed_of_device();
  if (!link) return;
  links_.name(*link, step.link, index());
  link->to.protocol = step.protocol;
}

void CaseRun::close(const PreparedStep& step) {
  Link& link = *links_.find(step.link);
  while (links_.listen(link, now())) {
  }
  if (stopped()) return;
  // Behind a FIN answers may still come; nothing is heard behind a RST.
  if (step.step->closing != Closing::fin) {
    // The answer to what was asked last may have been quicker: whether it was, says nothing.
    if (link.asked) link.pending.drop();
    link.pending.leave_over();
  }
  if (!link.gone) links_.close(link, step.step->closing);
}

void CaseRun::await_ending(const PreparedStep& step) {
  Link& link = *links_.find(step.link);
  record().cause = link.cause;
  record().deadline = link.cause + prepared_.reply_limit(*step.step, around_.timing.response_max);
  const Time give_up = record().deadline + around_.timing.late_watch;
  while (link.hears && links_.listen(link, give_up)) {
  }
  if (!link.ending) return;
  (*link.ending)->step = index();
  links_.restart((*link.ending)->start);
  link.ending.reset();
  if (link.sends && !link.gone) links_.close(link, Closing::fin);
}

void CaseRun::act(const std::string& action) {
  const Result<std::vector<harness::Protocol::Setting>> settings =
      around_.device.protocol->set_off_by(action);
  if (!client_ && can().real_device && settings && !settings->empty()) {
    set_memory(*settings);
    links_.note(now(), "do " + action);
    return;
  }
  Arming* const told = client_ && can().real_device ? around_.arming : nullptr;
  Status done = ok();
  if (action == "power_cycle") links_.lose(*around_.device.endpoint);
  if (action == "power_cycle" && can().real_device && !told)
    done = cycle_power();
  else if (told && told->follows(action))
    done = told->act(action);
  else
    done = around_.device.endpoint->act(action);
  if (done && told) done = told->done(action);  // a client answers no probe
  if (!done) record().refused = done.error().message;
  links_.restart(now());
  links_.note(now(), "do " + action);
}

/// By a word to the device, where it takes one; else it needs time to start again, and is asked
/// until it answers, which its counters count.
Status CaseRun::cycle_power() {
  endpoints::Endpoint& endpoint = *around_.device.endpoint;
  const Status told = endpoint.renew();
  if (told || prepared_.counts_from_power_on()) return told;
  if (const Status done = endpoint.act("power_cycle"); !done) return done;
  Channel device = around_.device;
  device.station = prepared_.station;
  const Result<Sign> back = Sanity(device, around_.timing)
                                .anything_answers(restart_patience, prepared_.reply_delay, true);
  if (!back) transcript_.trouble = back.error();
  return ok();
}

/// Requests for memory go over a link of the case that waits for nothing: a further connection
/// could be one too many for the device.
void CaseRun::borrow_idle_link() {
  if (const Link* idle = links_.idle(*around_.device.protocol)) memory_.borrow(idle->id);
}

void CaseRun::set_memory(const std::vector<std::pair<std::string, std::string>>& memory) {
  links_.restart(now());
  borrow_idle_link();
  for (const MemoryRun run : memory_.runs(prepared_, memory)) {
    const Status done = memory_.set(prepared_, run);
    for (const auto& [address, hex] : run)
      links_.note(now(), fmt::format("set {} = {}", address, hex));
    if (done) continue;
    record().refused = std::string(memory_.refused() ? set_up_failure : "") + done.error().message;
    record().refused_by_device = around_.arming && around_.arming->gave_up();
    if (memory_.refused()) links_.note(now(), memory_.said());
    break;
  }
  memory_.leave();
}

/// A frame that nobody answers (the bench's own reply to a client) is still on its way when the
/// send returns. What another station has answered is still to end for the one that is looked at.
void CaseRun::settle_before_look() {
  const bool unanswered = index() > 0 && last_sending_ == index() - 1;
  if (can().simulated || !last_sender_ || !(unanswered || neighbours_)) return;
  const Time settled =
      std::max(last_sender_->last_sent.end, neighbours_ ? last_sender_->last_heard : Time{}) +
      around_.timing.quiet;
  while (links_.listen(*last_sender_, settled)) {
  }
}

/// Those from power-on are taken as they are.
void CaseRun::note_counters() {
  constexpr std::array<std::string_view, 8> counts{"@services", "@errors",      "@sent",
                                                   "@received", "@total_sent",  "@total_received",
                                                   "@udp_sent", "@udp_received"};
  if (client_ || !can().control || prepared_.counts_from_power_on()) return;
  for (const PreparedStep& one : prepared_.steps)
    if (one.step->kind == Step::Kind::check)
      for (const auto& [address, hex] : one.step->memory)
        if (std::ranges::count(counts, address) > 0)
          if (const Result<std::string> value = memory_.get(prepared_, address, hex.size()))
            counters_[address] = *value;
}

std::string CaseRun::since_beginning(const std::string& address, std::string value) const {
  const auto before = counters_.find(address);
  if (before == counters_.end() || value.size() > 8) return value;
  const unsigned long counted =
      std::stoul(value, nullptr, 16) - std::stoul(before->second, nullptr, 16);
  const unsigned long most = (1ul << (4 * value.size())) - 1;
  return fmt::format("{:0{}X}", counted & most, value.size());
}

void CaseRun::look_at_memory(const PreparedStep& step) {
  settle_before_look();
  borrow_idle_link();
  record().passed_over = step.passed_over;
  const std::string_view judged = step.passed_over ? " (not judged)" : "";
  for (const auto& [address, hex] : step.step->memory) {
    if (!memory_.can_read(prepared_, address)) continue;
    const Result<std::string> value = memory_.get(prepared_, address, hex.size());
    if (value) {
      record().memory.emplace_back(address, since_beginning(address, *value));
      links_.note(now(),
                  fmt::format("check {}: {}{}", address, record().memory.back().second, judged));
      continue;
    }
    record().refused = "the bench cannot look: " + value.error().message;
    if (memory_.refused()) links_.note(now(), memory_.said());
    break;
  }
  memory_.leave();
}

}  // namespace fieldproof::exchange
