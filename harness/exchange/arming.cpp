#include "harness/exchange/arming.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "harness/exchange/p2p_blocks.hpp"

namespace fieldproof::exchange {

namespace {

using nlohmann::json;

bool is_on(const std::string& digits) { return digits.find_first_not_of('0') != std::string::npos; }

bool same_place(const json& a, const json& b) {
  return a.value("parameter", json()) == b.value("parameter", json()) &&
         a.value("block", json()) == b.value("block", json());
}

}  // namespace

Status Arming::load(const vectors::Case& source, const json& config) {
  case_ = source.id;
  blocks_ = p2p_blocks(source.config);
  json own = config;
  const std::string model = own.value("model", "");
  for (const char* key : {"model", "protocol", "bench_line", "neighbours"}) own.erase(key);
  Result<std::unique_ptr<plc::EmulatedDevice>> made = protocol_.make_device(model, own);
  if (!made) return fail("cannot follow the memory of the case: " + made.error().message);
  shadow_ = std::move(*made);
  return ok();
}

Result<Arming::Image> Arming::image() const {
  Image image;
  for (const json& block : blocks_) {
    std::vector<std::string> addresses = sent_addresses(block);
    if (!flag_of(block).empty() && !runs_by_clock(block)) addresses.push_back(flag_of(block));
    for (const std::string& address : addresses) {
      Result<std::string> one = shadow_->get(address, 0);
      const bool run = address != flag_of(block) && block.value("command", "") == "continuous";
      if (one && run)
        one = shadow_->get(address, one->size() * block.value("size", std::size_t{1}));
      if (!one) return one.error();
      image[address] = *one;
    }
  }
  return image;
}

std::vector<std::string> Arming::flags() const {
  std::vector<std::string> flags;
  for (const json& block : blocks_)
    if (!flag_of(block).empty() && !runs_by_clock(block)) flags.push_back(flag_of(block));
  return flags;
}

/// What must be set up in the module, in words.
std::string Arming::missing_block() const {
  std::string missing;
  for (const json& block : blocks_)
    if (std::ranges::find(ways_.prepared, block) == ways_.prepared.end())
      missing += (missing.empty() ? "" : "; ") + in_words(block, protocol_.name());
  return missing;
}

/// A prepared block that asks whether the case wants it or not.
std::string Arming::foreign_clock() const {
  for (const json& one : ways_.prepared) {
    const bool wanted =
        std::ranges::any_of(blocks_, [&](const json& block) { return same_place(block, one); });
    if (!wanted && runs_by_clock(one)) return in_words(one, protocol_.name());
  }
  return {};
}

/// The first memory without which the line shows something else, when nobody can set it.
Result<std::string> Arming::needs_memory(const vectors::Case& source) {
  Result<Image> before = image();
  if (!before) return before.error();
  const auto matters =
      [&](const std::vector<std::pair<std::string, std::string>>& memory) -> Result<std::string> {
    for (const auto& [address, hex] : memory) {
      if (const Status set = shadow_->set(address, hex); !set) return set.error();
      const Result<Image> after = image();
      if (!after) return after.error();
      if (*after != *before) return fmt::format("{} = {}", address, hex);
    }
    return std::string();
  };
  Result<std::string> needed = matters(source.memory);
  for (const vectors::Step& step : source.steps)
    if (needed && needed->empty() && step.kind == vectors::Step::Kind::set)
      needed = matters(step.memory);
  return needed;
}

std::string Arming::objection(const vectors::Case& source, const json& config) const {
  Arming trial(protocol_, ways_);
  if (ways_.stimulus) {
    const Status loaded = trial.load(source, config);
    return loaded ? "" : loaded.error().message;
  }
  trial.blocks_ = p2p_blocks(source.config);
  if (trial.blocks_.empty()) return "has no P2P blocks, which alone a bench can prepare";
  const std::string set_up = "set up in XG5000 and list in \"prepared_blocks\" of the profile: ";
  if (ways_.prepared.empty())
    return "nothing makes the device ask: give --stimulus COMMAND, or " + set_up +
           trial.missing_block();
  if (const std::string missing = trial.missing_block(); !missing.empty())
    return "the module does not ask this: " + set_up + missing;
  if (const std::string other = trial.foreign_clock(); !other.empty())
    return "another block asks all the time; take its link enable away: " + other;
  if (ways_.aux) return {};
  if (const Status loaded = trial.load(source, config); !loaded) return loaded.error().message;
  const Result<std::string> needed = trial.needs_memory(source);
  if (!needed) return needed.error().message;
  return needed->empty() ? ""
                         : fmt::format(
                               "needs {} in the module, which only a second channel can set: give "
                               "--aux ENDPOINT",
                               *needed);
}

Status Arming::ask_for(const json& block) const {
  const Result<Image> now = image();
  if (!now) return now.error();
  json values = json::object();
  for (const std::string& address : sent_addresses(block)) values[address] = now->at(address);
  return ways_.stimulus(json{{"case", case_}, {"block", block}, {"values", values}}.dump());
}

Status Arming::begin(const vectors::Case& source, const json& config) {
  case_ = source.id;
  blocks_ = p2p_blocks(source.config);
  if (!ways_.stimulus) return ok();
  if (const Status loaded = load(source, config); !loaded) return loaded;
  for (const auto& [address, hex] : source.memory)
    if (const Status set = shadow_->set(address, hex); !set) return set;
  for (const json& block : blocks_)
    if (runs_by_clock(block))
      if (const Status asked = ask_for(block); !asked) return asked;
  return ok();
}

Status Arming::set(const std::string& address, const std::string& hex) {
  if (!ways_.stimulus) return ok();
  const Result<Image> before = image();
  if (!before) return before.error();
  if (const Status set = shadow_->set(address, hex); !set) return set;
  const Result<Image> after = image();
  if (!after) return after.error();
  for (const json& block : blocks_) {
    const auto was = before->find(flag_of(block)), is = after->find(flag_of(block));
    if (is == after->end() || is_on(was->second) || !is_on(is->second)) continue;
    if (const Status asked = ask_for(block); !asked) return asked;
  }
  return ok();
}

Result<bool> Arming::end() {
  if (!ways_.stimulus) return false;
  const Status told = ways_.stimulus(json{{"case", case_}, {"over", true}}.dump());
  return told ? Result<bool>(true) : told.error();
}

}  // namespace fieldproof::exchange
