#include "harness/exchange/arming.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "harness/exchange/p2p_blocks.hpp"

namespace fieldproof::exchange {

namespace {

using nlohmann::json;

bool is_on(const std::string& digits) { return digits.find_first_not_of('0') != std::string::npos; }

/// Have P2P channels partners of their own, at other ports or of other protocols?
bool has_several_partners(const json& config) {
  return config.value("p2p", json::object()).contains("channels");
}

// an interpreter starts slowly on a busy computer; one that says nothing costs this once a run
constexpr Duration answer_patience = 10s;
constexpr int most_restarts = 3;  // of a program that gives up

}  // namespace

Status Arming::load(const vectors::Case& source, const json& config) {
  case_ = &source;
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

void Arming::greet() {
  if (greeted_ || !ways_.stimulus) return;
  greeted_ = true;
  if (!ways_.stimulus.tell(json{{"hello", 1}, {"protocol", protocol_.name()}}.dump())) return;
  if (!ways_.stimulus.answer) return;
  const Result<Declared> declared = read_declaration(ways_.stimulus.answer(answer_patience));
  if (declared)
    declared_ = *declared;
  else
    bad_answer_ = declared.error().message;
}

bool Arming::share_memory(const std::string& a, const std::string& b) const {
  if (a == b) return true;
  const auto one = protocol_.named(a, 4), other = protocol_.named(b, 4);
  const bool bits = a.size() > 2 && b.size() > 2 && a[2] == 'X' && b[2] == 'X';
  return one && other && !bits && one->overlaps(*other);
}

std::string Arming::undeclared(const vectors::Case& source, const json& declared) const {
  if (!ways_.stimulus) return {};
  std::set<std::string> needs =
      needs_of(source, !protocol_.on_network(),
               [this](const std::string& a, const std::string& b) { return share_memory(a, b); });
  if (declared.contains("time_out")) needs.erase("time_out");
  for (const std::string& need : needs)
    if (!declared_.follows.contains(need))
      return fmt::format(
          "needs '{}', which the program of --stimulus does not declare to follow (README, \"The "
          "module as client\")",
          need);
  return {};
}

bool Arming::tells(std::string_view config_key) const {
  const std::string_view as = told_as(config_key);
  return ways_.stimulus && !as.empty() && declared_.follows.contains(std::string(as));
}

std::string Arming::not_told(std::string_view config_key) const {
  const std::string_view as = told_as(config_key);
  if (!ways_.stimulus || as.empty()) return {};
  return fmt::format(", and the program of --stimulus does not declare to follow '{}'", as);
}

bool Arming::follows(std::string_view action) const {
  const std::string_view as = action.starts_with("link")            ? "link"
                              : action.starts_with("send ")         ? "frames"
                              : action == "stop" || action == "run" ? "mode"
                              : action == "power_cycle"             ? "power_cycle"
                              : action.starts_with("error")         ? "mail"
                                                                    : "";
  return ways_.stimulus && declared_.answered && declared_.follows.contains(std::string(as));
}

Status Arming::act(const std::string& action) { return tell({{"do", action}}); }

Status Arming::done(std::string_view action) {
  if (action != "power_cycle" || follows(action) || !ways_.stimulus) return ok();
  greeted_ = false;
  greet();
  return tell_of_case();
}

bool Arming::started_anew() {
  gave_up_ = greeted_ = false;
  greet();
  return true;
}

bool Arming::revive() {
  return ways_.stimulus.restart && ++restarts_ <= most_restarts && ways_.stimulus.restart() &&
         started_anew();
}

std::string Arming::objection(const vectors::Case& source, const json& config) const {
  if (source.config.contains("monitor"))
    return "looks at the frame monitor of the module, which no command reads; see XG5000, frame "
           "monitor";
  if (has_several_partners(source.config))
    return "needs a partner for each channel, and the bench listens for one protocol at one port";
  Arming trial(protocol_, ways_);
  if (ways_.stimulus) {
    if (!bad_answer_.empty()) return bad_answer_;
    const Status loaded = trial.load(source, config);
    return loaded ? "" : loaded.error().message;
  }
  trial.blocks_ = p2p_blocks(source.config);
  if (trial.blocks_.empty()) return "has no P2P blocks, which alone a bench can prepare";
  const std::string set_up = "set up in XG5000 and list in \"prepared_blocks\" of the profile: ";
  const std::string missing = not_prepared(trial.blocks_, ways_.prepared, protocol_.name());
  if (ways_.prepared.empty())
    return "nothing makes the device ask: give --stimulus COMMAND, or " + set_up + missing;
  if (!missing.empty()) return "the module does not ask this: " + set_up + missing;
  if (const std::string other = asks_uncalled(trial.blocks_, ways_.prepared, protocol_.name());
      !other.empty())
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

/// A line of the case. A program that ended gets another chance with the next case.
Status Arming::tell(json line) {
  line["case"] = case_->id;
  if (declared_.answered) line["number"] = number_;
  if (probing_) line["probe"] = true;
  const Status told = ways_.stimulus.tell(line.dump());
  gave_up_ = !told;
  return told;
}

/// One line a block, in their order; the last says so.
Status Arming::ask_for(std::vector<json> blocks) {
  if (blocks.empty()) return ok();
  const Result<Image> now = image();
  if (!now) return now.error();
  std::ranges::stable_sort(
      blocks, {}, [](const json& block) { return block.value("block", json(0)).get<int>(); });
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    json values = json::object();
    for (const std::string& address : sent_addresses(blocks[i])) values[address] = now->at(address);
    json line{{"block", blocks[i]}, {"values", values}, {"last", i + 1 == blocks.size()}};
    if (const Status told = tell(std::move(line)); !told) return told;
  }
  return ok();
}

Status Arming::tell_of_case() {
  if (declared_.answered)
    if (const Status told = tell({{"begin", set_up_of(*case_, !protocol_.on_network())}}); !told)
      return told;
  std::vector<json> clocks;
  std::ranges::copy_if(blocks_, std::back_inserter(clocks), runs_by_clock);
  return ask_for(std::move(clocks));
}

Status Arming::begin(const vectors::Case& source, const json& config) {
  case_ = &source;
  blocks_ = p2p_blocks(source.config);
  if (!ways_.stimulus) return ok();
  if (gave_up_ && !revive()) return fail("the program of --stimulus has ended too often");
  ++number_;
  probing_ = std::exchange(probe_, false);
  if (const Status loaded = load(source, config); !loaded) return loaded;
  for (const auto& [address, hex] : source.memory)
    if (const Status set = shadow_->set(address, hex); !set) return set;
  return tell_of_case();
}

Status Arming::set(const std::string& address, const std::string& hex) {
  if (!ways_.stimulus) return ok();
  const Result<Image> before = image();
  if (!before) return before.error();
  if (const Status set = shadow_->set(address, hex); !set) return set;
  if (declared_.answered && declared_.follows.contains("memory"))
    if (const Status told = tell({{"set", {{address, hex}}}}); !told) return told;
  const Result<Image> after = image();
  if (!after) return after.error();
  std::vector<json> rising;
  for (const json& block : blocks_) {
    const auto was = before->find(flag_of(block)), is = after->find(flag_of(block));
    if (is != after->end() && !is_on(was->second) && is_on(is->second)) rising.push_back(block);
  }
  return ask_for(std::move(rising));
}

Result<bool> Arming::end() {
  if (!ways_.stimulus || !case_ || gave_up_) return false;
  if (!declared_.answered && std::ranges::none_of(blocks_, runs_by_clock)) return true;
  const Status told = tell({{"over", true}});
  return told ? Result<bool>(true) : told.error();
}

}  // namespace fieldproof::exchange
