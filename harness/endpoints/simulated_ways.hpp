// The ways to one emulated device, all at one moment: its serial lines and its network. Time costs
// nothing.
#pragma once

#include <deque>
#include <list>
#include <optional>
#include <vector>

#include "src/base/medium.hpp"
#include "src/line/line.hpp"
#include "src/net/network.hpp"

namespace fieldproof::endpoints {

/// Devices and hosts are not owned.
class SimulatedWays {
 public:
  /// One line, on which nobody is.
  SimulatedWays() { renew({}, line::Duplex::full); }
  SimulatedWays(const SimulatedWays&) = delete;
  SimulatedWays& operator=(const SimulatedWays&) = delete;

  /// New ways, on which nobody is; time goes on.
  void renew(const line::LineSettings& bench, line::Duplex duplex);
  Time now() const { return line_->now(); }

  line::SimulatedLine& line() { return *line_; }
  const line::SimulatedLine& line() const { return *line_; }
  /// The line of a further channel, with the same settings on both sides.
  LinkId add_line(line::Device& device, const line::LineSettings& settings);
  /// The network; one host has it.
  void attach(net::Host& host);
  /// nullptr: nobody is there.
  net::SimulatedNetwork* network() { return network_ ? &*network_ : nullptr; }

  /// On a line, time passes until all is sent. Errors: the link is not open.
  Result<Sent> send(ByteView bytes, LinkId link);
  /// What the bench hears next on any of them (Endpoint::receive).
  Burst receive(Time deadline);

 private:
  /// Marks what it hears with its link.
  class FurtherLine : public Medium {
   public:
    FurtherLine(const line::LineSettings& bench, Time now, LinkId link)
        : line_(bench, line::Duplex::full, now), link_(link) {}

    line::SimulatedLine& line() { return line_; }
    LinkId link() const { return link_; }
    Time now() const override { return line_.now(); }
    std::optional<Time> next_event() const override { return line_.next_event(); }
    void run(Time until) override { line_.run(until); }
    std::optional<Burst> take() override { return marked(line_.take()); }
    std::optional<Burst> take_part() override { return marked(line_.take_part()); }

   private:
    std::optional<Burst> marked(std::optional<Burst> burst) const {
      if (burst) burst->link = link_;
      return burst;
    }
    line::SimulatedLine line_;
    LinkId link_;
  };

  bool one_line_alone() const { return media_.size() == 1; }
  line::SimulatedLine* line_of(LinkId link);

  std::optional<line::SimulatedLine> line_;
  std::list<FurtherLine> further_;
  std::optional<net::SimulatedNetwork> network_;
  std::vector<Medium*> media_;
  std::deque<Burst> heard_;  // while the bench was sending
  LinkId next_line_ = 0;
};

}  // namespace fieldproof::endpoints
