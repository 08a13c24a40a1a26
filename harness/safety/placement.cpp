#include "harness/safety/placement.hpp"

namespace fieldproof::safety {

namespace {

using Memory = std::vector<std::pair<std::string, std::string>>;

/// False: nothing of it lies elsewhere.
Result<bool> place(Memory& memory, const std::vector<Bytes>& requests,
                   const harness::Protocol& declared) {
  bool moved = false;
  for (auto& [address, hex] : memory) {
    Result<harness::Protocol::Placed> placed = declared.placed(address, hex, requests);
    if (!placed) return placed.error();
    moved = moved || placed->address != address || placed->hex != hex;
    address = std::move(placed->address);
    hex = std::move(placed->hex);
  }
  return moved;
}

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
  Result<bool> changed = place(moved.memory, requests, declared);
  bool any = changed && *changed;
  for (vectors::Step& step : moved.steps) {
    if (!changed) break;
    changed = place(step.memory, requests, declared);
    any = any || (changed && *changed);
  }
  if (!changed) return changed.error();
  return any ? std::optional(std::move(moved)) : std::nullopt;
}

}  // namespace fieldproof::safety
