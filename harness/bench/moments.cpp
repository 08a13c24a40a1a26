#include "harness/bench/moments.hpp"

#include "harness/exchange/memory_access.hpp"

namespace fieldproof::bench {

namespace {

using exchange::PreparedCase;
using harness::Protocol;
using vectors::Step;

/// A range has no digits.
Protocol::Look look_of(const Step& step) {
  Protocol::Look look = step.memory;
  for (std::size_t i = 0; i < look.size() && i < step.numbers.size(); ++i)
    if (step.numbers[i] && step.numbers[i]->is_range()) look[i].second.clear();
  return look;
}

/// Does it leave the device alone? What is written may be memory that moves nothing.
bool is_act(const Step& step, const Protocol& protocol) {
  if (step.kind != Step::Kind::set) return step.kind == Step::Kind::act;
  for (const auto& [address, digits] : step.memory)
    if (!protocol.moved_by(exchange::place_name(address).address).empty()) return true;
  return false;
}

class Finder {
 public:
  explicit Finder(const Protocol& protocol) : protocol_(protocol) {}

  void look(std::size_t index, const Step& step) {
    steps_.push_back(index);
    looks_.push_back(look_of(step));
  }

  /// The looks since the one before it are all that saw what was so until here.
  void end_stretch(bool acted) {
    const std::vector<bool> passing = protocol_.of_a_moment(looks_);
    for (std::size_t i = 0; i < passing.size(); ++i)
      if (passing[i]) found_.steps.push_back(steps_[i]);
    found_.acted_in |= acted && !passing.empty() && passing.back();
    count_ += looks_.size();
    steps_.clear();
    looks_.clear();
  }

  Moments found() {
    found_.alone = count_ > 0 && count_ == found_.steps.size();
    return std::move(found_);
  }

 private:
  const Protocol& protocol_;
  std::vector<std::size_t> steps_;
  std::vector<Protocol::Look> looks_;
  std::size_t count_ = 0;
  Moments found_;
};

}  // namespace

Moments moments_of(const PreparedCase& prepared, const Protocol& protocol) {
  Finder finder(protocol);
  for (std::size_t i = 0; i < prepared.steps.size(); ++i) {
    const Step& step = *prepared.steps[i].step;
    if (step.kind == Step::Kind::check)
      finder.look(i, step);
    else if (is_act(step, protocol))
      finder.end_stretch(true);
  }
  finder.end_stretch(false);
  return finder.found();
}

}  // namespace fieldproof::bench
