#include "suites/xgt_cnet/broken/broken_server.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/base/spelling.hpp"

namespace fieldproof::xgt_cnet_broken {

BrokenPlc::BrokenPlc(Behaviour behaviour, GoodPlc plc, Duration gap)
    : behaviour_(std::move(behaviour)),
      plc_(std::move(plc)),
      receiver_(xgt_cnet::FrameReceiver::Side::server, gap) {
  if (behaviour_.power_on) behaviour_.power_on(plc_);
}

void BrokenPlc::receive(const Burst& burst) {
  now_ = burst.end();
  frames_in_burst_ = 0;
  Burst heard = burst;
  if (behaviour_.hear) behaviour_.hear(heard.bytes);
  remember(heard.bytes);
  receiver_.receive(heard, *this);
}

void BrokenPlc::remember(ByteView bytes) {
  const auto head = std::find(bytes.rbegin(), bytes.rend(), xgt_cnet::xgt_enq);
  if (head != bytes.rend()) {
    since_head_.clear();
    bytes = bytes.subspan(static_cast<std::size_t>(bytes.rend() - head) - 1);
  }
  since_head_.insert(since_head_.end(), bytes.begin(), bytes.end());
}

std::optional<Time> BrokenPlc::wake_at() const { return pending_.wake_at(receiver_.wake_at()); }

Bytes BrokenPlc::advance(Time now) {
  now_ = now;
  in_silence_ = true;
  receiver_.advance(now, *this);
  in_silence_ = false;
  return pending_.take(now);
}

void BrokenPlc::on_frame(ByteView frame, Time end) {
  const Bytes request(frame.begin(), frame.end());
  const bool together = frames_in_burst_++ > 0;
  pending_.put(behaviour_.answer ? behaviour_.answer(request, together, plc_)
                                 : broken::Sendings{{plc_.answer(request)}},
               end);
}

void BrokenPlc::on_broken_frame(std::uint16_t) {
  if (behaviour_.cut_off && in_silence_) pending_.put(behaviour_.cut_off(since_head_, plc_), now_);
}

Result<std::string> BrokenPlc::get(std::string_view address, std::size_t digits) const {
  return plc_.memory().get(address, digits);
}

Status BrokenPlc::act(std::string_view action) {
  const Status done = plc_.memory().act(action);
  if (!done || action != "power_cycle") return done;
  receiver_.reset();
  pending_.clear();
  if (behaviour_.power_on) behaviour_.power_on(plc_);
  return done;
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_plc(std::string_view fault,
                                                             const plc::PortConfig& config,
                                                             Storage& storage) {
  const Fault* known = find_fault(fault);
  if (!known && fault != "none") {
    std::vector<std::string_view> names{"none"};
    for (const Fault& one : faults()) names.push_back(one.name);
    return fail(
        fmt::format("cannot break a server by '{}': there is no such fault; --list shows them{}",
                    fault, suggestion(fault, names)));
  }
  Result<std::unique_ptr<plc::Plc>> plc = xgt_cnet::make_plc(config);
  if (!plc) return plc.error();
  GoodPlc good(std::move(*plc), *plc::find_plc_model(config.model), config.station);
  const Duration gap =
      plc::effective_gap(config.inter_character, config.inter_character_floor, config.line);
  return std::unique_ptr<plc::EmulatedDevice>(
      new BrokenPlc(known ? known->make(storage) : Behaviour{}, std::move(good), gap));
}

}  // namespace fieldproof::xgt_cnet_broken
