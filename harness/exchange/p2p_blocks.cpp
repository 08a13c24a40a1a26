#include "harness/exchange/p2p_blocks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "src/base/letters.hpp"

namespace fieldproof::exchange {

namespace {

using nlohmann::json;

/// Vectors may write a number as text: "${size}".
json plain_value(const json& value) {
  if (!value.is_string()) return value;
  const std::string& text = value.get_ref<const std::string&>();
  const bool number =
      !text.empty() && text.size() < 6 && text.find_first_not_of("0123456789") == std::string::npos;
  return number ? json(std::stoi(text)) : value;
}

void make_list(json& block, const char* key) {
  if (block.contains(key) && block[key].is_string()) block[key] = json::array({block[key]});
}

std::string list_of(const json& block, const char* key) {
  return block.contains(key)
             ? fmt::format("{}", fmt::join(block[key].get<std::vector<std::string>>(), ", "))
             : "?";
}

std::string text_of(const json& block, const char* key) {
  const json value = block.value(key, json());
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// As the channel has it for itself, else as all have it.
std::string transport_of(const json& p2p, const json& channel) {
  for (const json& own : p2p.value("channels", json::array()))
    if (own.is_object() && own.contains("transport") &&
        plain_value(own.value("channel", json())) == plain_value(channel))
      return own.value("transport", "tcp");
  return p2p.value("transport", "tcp");
}

}  // namespace

std::vector<json> complete_blocks(const json& blocks, const json& p2p) {
  std::vector<json> result;
  if (!blocks.is_array()) return result;
  for (const json& given : blocks) {
    json block{{"parameter", p2p.value("parameter", json(1))},
               {"block", result.size()},
               {"function", "read"}};
    const std::string function = given.is_object() ? given.value("function", "read") : "";
    const bool mail = function == "esend" || function == "ereceive";  // they need no channel
    if (!mail) block["channel"] = p2p.value("channel", json(1));
    if (function == "read" || function == "write")
      block.update({{"command", "single"}, {"type", "word"}, {"size", 1}});
    block.update(given);
    if (!mail && !block.contains("transport"))
      if (std::string transport = transport_of(p2p, block["channel"]); transport != "tcp")
        block["transport"] = std::move(transport);
    for (const char* key : {"parameter", "block", "channel", "message", "size", "station", "to"})
      if (block.contains(key)) block[key] = plain_value(block[key]);
    if (block.contains("flag")) block["flag"] = upper(block["flag"].get<std::string>());
    make_list(block, "read");
    make_list(block, "save");
    make_list(block, "data");
    result.push_back(std::move(block));
  }
  return result;
}

bool asks_by_datagrams(const json& config) {
  return std::ranges::any_of(p2p_blocks(config), [](const json& block) {
    return block.value("transport", "tcp") == "udp";
  });
}

std::vector<json> p2p_blocks(const json& config) {
  const auto p2p = config.find("p2p");
  if (p2p == config.end() || !p2p->is_object()) return {};
  return complete_blocks(p2p->value("blocks", json()), *p2p);
}

std::string flag_of(const json& block) { return block.value("flag", ""); }

bool runs_by_clock(const json& block) {
  const std::string flag = flag_of(block);
  return !flag.empty() && (flag.front() != '%' || flag.starts_with("%F"));
}

std::vector<std::string> sent_addresses(const json& block) {
  if (block.value("function", "") != "write" || !block.contains("read")) return {};
  return block["read"].get<std::vector<std::string>>();
}

std::string in_words(const json& block, std::string_view protocol) {
  const std::string function = block.value("function", "read");
  std::string text = fmt::format("P2P {} block {}: {} client, ", text_of(block, "parameter"),
                                 text_of(block, "block"), protocol);
  if (block.contains("channel")) text += fmt::format("channel {}, ", text_of(block, "channel"));
  text += function;
  if (block.contains("transport")) text += ", " + text_of(block, "transport");
  if (block.contains("frame")) text += " " + text_of(block, "frame");
  if (block.contains("command")) {
    text += fmt::format(", {}", text_of(block, "command"));
    text += block["command"] == "continuous"
                ? fmt::format(", {} x {}", text_of(block, "size"), text_of(block, "type"))
                : ", " + text_of(block, "type");
  }
  if (block.contains("flag")) text += ", on " + flag_of(block);
  if (block.contains("to"))
    text +=
        fmt::format(", message {} to address {}", text_of(block, "message"), text_of(block, "to"));
  if (block.contains("data")) text += ", data " + list_of(block, "data");
  const std::string station = " of station " + text_of(block, "station");
  if (function == "read")
    text += fmt::format(", from {}{}, into {}", list_of(block, "read"), station,
                        list_of(block, "save"));
  if (function == "write")
    text += fmt::format(", from {}, into {}{}", list_of(block, "read"), list_of(block, "save"),
                        station);
  return text;
}

namespace {

bool same_place(const json& a, const json& b) {
  return a.value("parameter", json()) == b.value("parameter", json()) &&
         a.value("block", json()) == b.value("block", json());
}

/// "station is 3, 2 is needed".
std::string differences(const json& wanted, const json& set_up) {
  std::vector<std::string> found;
  const auto text = [](const json& block, const std::string& key) {
    return block.contains(key) ? block[key].dump() : std::string("nothing");
  };
  json keys = wanted;
  keys.update(set_up);
  for (const auto& [key, value] : keys.items())
    if (text(wanted, key) != text(set_up, key))
      found.push_back(
          fmt::format("{} is {}, {} is needed", key, text(set_up, key), text(wanted, key)));
  return fmt::format("{}", fmt::join(found, "; "));
}

}  // namespace

std::string not_prepared(const std::vector<json>& blocks, const std::vector<json>& prepared,
                         std::string_view protocol) {
  std::string missing;
  for (const json& block : blocks) {
    if (std::ranges::find(prepared, block) != prepared.end()) continue;
    if (!missing.empty()) missing += "; ";
    missing += in_words(block, protocol);
    const auto place =
        std::ranges::find_if(prepared, [&](const json& one) { return same_place(one, block); });
    if (place != prepared.end())
      missing += fmt::format(" (listed there is another: {})", differences(block, *place));
  }
  return missing;
}

std::string asks_uncalled(const std::vector<json>& blocks, const std::vector<json>& prepared,
                          std::string_view protocol) {
  for (const json& one : prepared) {
    const bool wanted =
        std::ranges::any_of(blocks, [&](const json& block) { return same_place(block, one); });
    if (!wanted && runs_by_clock(one)) return in_words(one, protocol);
  }
  return {};
}

}  // namespace fieldproof::exchange
