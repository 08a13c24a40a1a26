#include "harness/explore/client_pool.hpp"

#include <algorithm>
#include <array>

#include "harness/exchange/p2p_blocks.hpp"
#include "harness/notation/frame_template.hpp"

namespace fieldproof::explore {

using nlohmann::json;
using notation::FrameTemplate;
using vectors::Case;
using vectors::Step;

namespace {

constexpr std::array known_keys{"station", "role", "p2p", "time_out", "delay_ms", "write_order"};
constexpr std::array known_p2p_keys{"blocks", "parameter", "transport"};

bool knows_all(const json& object, const auto& keys) {
  return std::ranges::all_of(object.items(), [&](const auto& item) {
    return std::ranges::find(keys, item.key()) != keys.end();
  });
}

bool gives_blocks(const Case& one, const harness::Protocol& protocol, std::string_view model) {
  if (one.protocol != protocol.name() || !vectors::is_client_case(one)) return false;
  if (!one.models.empty() && std::ranges::find(one.models, model) == one.models.end()) return false;
  return knows_all(one.config, known_keys) && one.config.contains("p2p") &&
         knows_all(one.config["p2p"], known_p2p_keys);
}

bool asks_on_a_flag(const json& block) {
  const std::string function = block.value("function", "");
  return (function == "read" || function == "write") && block.value("channel", 1) == 1 &&
         block.contains("read") && block.contains("save") && !exchange::flag_of(block).empty() &&
         !exchange::runs_by_clock(block);
}

/// Where the case looks besides the memory of its block.
void note_results(const Case& one, const json& block, ClientPool& pool) {
  const std::vector<Watched> own = own_memory(block);
  for (const Step& step : one.steps) {
    if (step.kind != Step::Kind::check) continue;
    for (const auto& [address, hex] : step.memory)
      if (!address.starts_with('@') &&
          std::ranges::find(own, address, &Watched::first) == own.end())
        pool.results[number_of(block)].insert({address, hex.size()});
  }
}

std::set<std::size_t> open_places(const FrameTemplate& frame) {
  std::set<std::size_t> open;
  for (std::size_t i = 0; i < frame.cells.size(); ++i)
    if (frame.cells[i].kind != FrameTemplate::Cell::Kind::literal &&
        frame.cells[i].kind != FrameTemplate::Cell::Kind::check)
      open.insert(i);
  return open;
}

/// What is open in most requests: a few vectors are about just that.
class OpenPlaces {
 public:
  void note(const Case& one, const harness::Protocol& protocol) {
    for (const Step& step : one.steps) {
      if (step.kind != Step::Kind::expect || step.frames.empty()) continue;
      const Result<std::vector<FrameTemplate>> frames =
          notation::make_templates(step.frames.front().notation, protocol.fields_at(1));
      if (!frames || protocol.frame_length(frames->front().bytes) == std::nullopt) continue;
      ++requests_;
      for (const std::size_t at : open_places(frames->front())) ++times_[at];
    }
  }
  std::set<std::size_t> most() const {
    std::set<std::size_t> open;
    for (const auto& [at, times] : times_)
      if (2 * times > requests_) open.insert(at);
    return open;
  }

 private:
  std::size_t requests_ = 0;
  std::map<std::size_t, std::size_t> times_;  // by offset
};

std::size_t digits_of(const std::string& type) {
  if (type == "dword") return 8;
  if (type == "lword") return 16;
  return type == "word" ? 4 : 2;
}

}  // namespace

BlockNumber number_of(const json& block) {
  return {block.value("parameter", 1), block.value("block", 0)};
}

std::vector<Watched> own_memory(const json& block) {
  const char* key = block.value("function", "") == "read" ? "save" : "read";
  const bool continuous = block.value("command", "single") == "continuous";
  const std::size_t digits = digits_of(block.value("type", "word")) *
                             (continuous ? std::max(1, block.value("size", 1)) : 1);
  std::vector<Watched> memory;
  for (const std::string& address : block.at(key).get<std::vector<std::string>>())
    memory.emplace_back(address, digits);
  return memory;
}

ClientPool client_pool(const std::vector<Case>& cases, const harness::Protocol& protocol,
                       std::string_view model) {
  ClientPool pool;
  OpenPlaces open;
  std::map<std::string, ClientPool::Group> groups;
  std::set<std::string> flags, seen;
  for (const Case& one : cases) {
    if (!gives_blocks(one, protocol, model)) continue;
    open.note(one, protocol);
    json rest = one.config;
    rest["p2p"].erase("blocks");
    const std::vector<json> blocks = exchange::p2p_blocks(one.config);
    for (const json& block : blocks) {
      if (!asks_on_a_flag(block)) continue;
      flags.insert(exchange::flag_of(block));
      if (blocks.size() == 1) note_results(one, block, pool);
      json like = block;
      for (const char* key : {"flag", "block", "parameter"}) like.erase(key);
      if (!seen.insert(rest.dump() + like.dump()).second) continue;
      ClientPool::Group& group = groups[rest.dump()];
      group.config = rest;
      group.blocks.push_back(block);
    }
  }
  for (auto& [key, group] : groups) pool.groups.push_back(std::move(group));
  pool.flags.assign(flags.begin(), flags.end());
  pool.open = open.most();
  return pool;
}

notation::Notation request_notation(ByteView frame, const std::set<std::size_t>& open) {
  std::string text;
  for (std::size_t i = 0; i < frame.size();) {
    std::size_t end = i;
    while (end < frame.size() && !open.contains(end)) ++end;
    text += notation::print_bytes(frame.subspan(i, end - i)) + ' ';
    if (end < frame.size()) text += "?? ";
    i = end + 1;
  }
  Result<notation::Notation> parsed = notation::parse_notation(text);
  return parsed ? std::move(*parsed) : notation::Notation{};
}

}  // namespace fieldproof::explore
