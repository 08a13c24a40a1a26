#include "harness/bench/benches.hpp"

#include <algorithm>

namespace fieldproof::bench {

Result<Benches> Benches::open(const endpoints::EndpointName& name,
                              const std::vector<const harness::Protocol*>& protocols,
                              const BenchOptions& options) {
  Benches benches;
  for (const harness::Protocol* protocol : protocols) {
    endpoints::EndpointName own = name;
    own.options["protocol"] = protocol->name();
    Result<std::unique_ptr<endpoints::Endpoint>> endpoint =
        endpoints::open_endpoint(own, *protocol);
    if (!endpoint) return endpoint.error();
    std::unique_ptr<harness::Protocol> configured;
    if ((*endpoint)->capabilities().real_device) {
      Result<std::unique_ptr<harness::Protocol>> declared =
          protocol->configured(options.profile.model, options.profile.config);
      if (!declared)
        return fail("cannot use profile " + options.profile.name + ": " + declared.error().message);
      configured = std::move(*declared);
    }
    BenchOptions one = options;
    one.device.protocol = protocol->name();
    auto bench =
        std::make_unique<Bench>(**endpoint, configured ? *configured : *protocol, std::move(one));
    benches.members_.push_back(
        {protocol, std::move(*endpoint), std::move(configured), std::move(bench)});
  }
  return benches;
}

Status Benches::start() {
  for (Member& member : members_) {
    if (!member.bench->stopped().empty()) continue;
    if (Status alive = member.bench->start(); !alive) return alive;
  }
  return ok();
}

std::optional<exchange::Channel> Benches::silent_line() const {
  for (const Member& member : members_)
    if (std::optional<exchange::Channel> asked = member.bench->silent_line()) return asked;
  return std::nullopt;
}

const Benches::Member& Benches::member_for(const vectors::Case& source) const {
  const auto own = std::ranges::find_if(
      members_, [&](const Member& member) { return member.protocol->name() == source.protocol; });
  return own == members_.end() ? members_.front() : *own;
}

results::CaseResult Benches::run(const vectors::Case& source) {
  return member_for(source).bench->run(source);
}

std::size_t Benches::could_run(const std::vector<const vectors::Case*>& cases,
                               const BenchOptions& options) const {
  std::size_t count = 0;
  for (const Member& member : members_) {
    const Bench other(*member.endpoint, member.configured ? *member.configured : *member.protocol,
                      options);
    count += static_cast<std::size_t>(std::ranges::count_if(cases, [&](const vectors::Case* one) {
      return &member_for(*one) == &member && other.could_run(*one);
    }));
  }
  return count;
}

std::pair<const harness::Protocol*, std::vector<harness::Protocol::Written>> Benches::written_by(
    const vectors::Case& source) const {
  const Member& member = member_for(source);
  return {member.protocol, member.bench->written_by(source)};
}

Result<std::string> Benches::measure_floor() {
  std::string text;
  for (Member& member : members_) {
    Result<std::optional<AdapterFloor>> measured = member.bench->measure_floor();
    if (!measured) return measured.error();
    if (!*measured) continue;
    member.bench->use_floor(**measured);
    const std::string own = to_string(**measured, member.bench->floor());
    text += members_.size() == 1
                ? own
                : (text.empty() ? "" : "; ") + std::string(member.protocol->name()) + ' ' + own;
  }
  return text;
}

std::string Benches::use_floor(const AdapterFloor& floor) {
  for (Member& member : members_) member.bench->use_floor(floor);
  return to_string(floor, members_.front().bench->floor());
}

Status Benches::start_those_that_answer() {
  for (Member& member : members_) {
    const Status alive = member.bench->start();
    if (alive) continue;
    if (alive.error().interrupted || member.bench->port_failed()) return alive;
    member.bench->set_aside(alive.error().message);
  }
  return ok();
}

std::string Benches::stopped() const {
  const auto can_run = [](const Member& member) { return member.bench->stopped().empty(); };
  return members_.empty() || std::ranges::any_of(members_, can_run)
             ? ""
             : members_.front().bench->stopped();
}

std::vector<results::CaseResult> Benches::set_up_findings() const {
  std::vector<results::CaseResult> all;
  for (const Member& member : members_)
    std::ranges::move(member.bench->set_up_findings().results(), std::back_inserter(all));
  return all;
}

std::string Benches::put_back() {
  std::string open;
  for (Member& member : members_)
    if (const std::string one = member.bench->put_back(); !one.empty())
      open += (open.empty() ? "" : ", ") + one;
  return open;
}

bool Benches::interrupted() const {
  return std::ranges::any_of(members_,
                             [](const Member& member) { return member.bench->interrupted(); });
}

std::string Benches::protocol_names() const {
  std::string names;
  for (const Member& member : members_)
    names += (names.empty() ? "" : ", ") + std::string(member.protocol->name());
  return names;
}

}  // namespace fieldproof::bench
