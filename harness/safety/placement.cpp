#include "harness/safety/placement.hpp"

namespace fieldproof::safety {

namespace {

using Memory = std::vector<std::pair<std::string, std::string>>;

using Written = harness::Protocol::Written;

class Placing {
 public:
  Placing(const std::vector<Bytes>& requests, const harness::Protocol& declared)
      : requests_(requests), declared_(declared) {}

  Status place(Memory& memory) {
    for (auto& [address, hex] : memory)
      if (const Status placed = place(address, hex); !placed) return placed;
    return ok();
  }
  bool moved() const { return moved_; }

 private:
  Status place(std::string& address, std::string& hex) {
    Result<harness::Protocol::Placed> placed = declared_.placed(address, hex, requests_);
    if (!placed) return placed.error();
    if (Status apart = keep_apart(address, hex.size(), *placed); !apart) return apart;
    moved_ = moved_ || placed->address != address || placed->hex != hex;
    address = std::move(placed->address);
    hex = std::move(placed->hex);
    return ok();
  }

  /// What the vector has in two places must not come together.
  Status keep_apart(const std::string& address, std::size_t digits,
                    const harness::Protocol::Placed& placed) {
    const auto from = declared_.named(address, digits);
    const auto to = declared_.named(placed.address, placed.hex.size());
    if (!from || !to) return ok();
    for (const auto& [other_from, other_to] : places_)
      if (to->overlaps(other_to) && !from->overlaps(other_from))
        return fail("needs " + address + " and " + other_from.address +
                    " apart; the declared device has both at " + placed.address);
    places_.emplace_back(*from, *to);
    return ok();
  }

  const std::vector<Bytes>& requests_;
  const harness::Protocol& declared_;
  std::vector<std::pair<Written, Written>> places_;  // in the vector, on the device
  bool moved_ = false;
};

}  // namespace

Result<std::optional<vectors::Case>> placed_case(const exchange::PreparedCase& prepared,
                                                 const harness::Protocol& declared) {
  std::vector<Bytes> requests;
  for (const exchange::PreparedStep& step : prepared.steps)
    if (step.step->kind == vectors::Step::Kind::send)
      requests.push_back(step.frames.front().frame.bytes);
  if (std::string why = declared.tied_to_default(requests); !why.empty())
    return fail(std::move(why));
  vectors::Case moved = *prepared.source;
  Placing placing(requests, declared);
  Status placed = placing.place(moved.memory);
  for (vectors::Step& step : moved.steps)
    if (placed) placed = placing.place(step.memory);
  if (!placed) return placed.error();
  return placing.moved() ? std::optional(std::move(moved)) : std::nullopt;
}

}  // namespace fieldproof::safety
