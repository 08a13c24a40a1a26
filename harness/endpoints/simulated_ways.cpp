#include "harness/endpoints/simulated_ways.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fieldproof::endpoints {

namespace {

/// Above what a network gives, and below what a device gives.
constexpr LinkId first_further_line = first_own_link / 2;

}  // namespace

void SimulatedWays::renew(const line::LineSettings& bench, line::Duplex duplex) {
  const Time now = line_ ? line_->now() : Time{};
  heard_.clear();
  further_.clear();
  network_.reset();
  line_.emplace(bench, duplex, now);
  media_ = {&*line_};
  next_line_ = first_further_line;
}

LinkId SimulatedWays::add_line(line::Device& device, const line::LineSettings& settings) {
  FurtherLine& one = further_.emplace_back(settings, now(), next_line_++);
  one.line().attach(device, settings);
  media_.push_back(&one);
  return one.link();
}

void SimulatedWays::attach(net::Host& host) {
  network_.emplace(net::Conditions{}, now());
  network_->attach(host);
  media_.push_back(&*network_);
}

line::SimulatedLine* SimulatedWays::line_of(LinkId link) {
  if (link == line_link) return &*line_;
  const auto found = std::ranges::find(further_, link, &FurtherLine::link);
  return found == further_.end() ? nullptr : &found->line();
}

Result<Sent> SimulatedWays::send(ByteView bytes, LinkId link) {
  line::SimulatedLine* const line = line_of(link);
  if (!line && network_) return network_->send(link, bytes);
  if (!line) return fail(fmt::format("cannot send on link {}: it is not open", link));
  if (one_line_alone()) {
    const auto [start, end] = line->transmit(bytes);
    return Sent{start, end};
  }
  const auto [start, end] = line->begin_to_transmit(bytes);
  for (;;) {
    Burst burst = receive_in_step(media_, end);
    if (burst.bytes.empty() && burst.event == LinkEvent::data) return Sent{start, end};
    heard_.push_back(std::move(burst));
  }
}

Burst SimulatedWays::receive(Time deadline) {
  if (!heard_.empty()) {
    Burst burst = std::move(heard_.front());
    heard_.pop_front();
    return burst;
  }
  return one_line_alone() ? line_->receive(deadline) : receive_in_step(media_, deadline);
}

}  // namespace fieldproof::endpoints
