#include "src/p2p/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "src/base/spelling.hpp"
#include "src/p2p/condition.hpp"
#include "src/p2p/driver.hpp"
#include "src/plc/config_reader.hpp"

namespace fieldproof::p2p {

namespace {
using nlohmann::json;
using Function = P2pBlock::Function;

constexpr unsigned highest_station = 255, most_elements = 2000;

struct Word {
  std::string_view text;
  int meaning;
};
constexpr std::array functions{
    Word{"read", int(Function::read)},   Word{"write", int(Function::write)},
    Word{"send", int(Function::send)},   Word{"receive", int(Function::receive)},
    Word{"esend", int(Function::esend)}, Word{"ereceive", int(Function::ereceive)}};
constexpr std::array commands{Word{"single", 0}, Word{"continuous", 1}};
constexpr std::array types{Word{"bit", 'X'}, Word{"byte", 'B'}, Word{"word", 'W'},
                           Word{"dword", 'D'}, Word{"lword", 'L'}};

std::string channel_numbers(const P2pRules& rules) {
  return fmt::format("1 {} {}", rules.channels == 2 ? "or" : "to", rules.channels);
}

std::string_view type_name(char type) {
  return std::ranges::find(types, int(type), &Word::meaning)->text;
}

/// Reads one block; the first error stays.
class BlockReader {
 public:
  BlockReader(const json& object, const plc::PlcModel& model, const P2pRules& rules,
              P2pBlock& block, std::string what)
      : object_(object),
        model_(model),
        rules_(rules),
        block_(block),
        reader_(object, what),
        what_(std::move(what)) {}

  Status read() {
    constexpr std::array<std::string_view, 15> keys{
        "block",   "channel", "command", "data", "flag",    "frame", "function", "info",
        "message", "read",    "save",    "size", "station", "to",    "type"};
    if (const Status known = plc::known_keys(object_, what_, keys); !known) return known;
    int function = int(block_.function), continuous = block_.continuous, type = block_.type;
    reader_.whole("channel", rules_.channels, block_.channel);
    reader_.whole("station", highest_station, block_.station);
    reader_.whole("size", most_elements, block_.size);
    if (reader_.error()) return *reader_.error();
    for (const Status& status : {word("function", functions, function),
                                 word("command", commands, continuous), word("type", types, type)})
      if (!status) return status;
    block_.function = static_cast<Function>(function);
    block_.continuous = continuous != 0;
    block_.type = static_cast<char>(type);
    if (block_.channel == 0) return wrong("channel is 0; use " + channel_numbers(rules_));
    if (block_.size == 0) return wrong("size is 0; give at least 1");
    if (const Status status = read_condition(); !status) return status;
    if (block_.is_mail()) return read_mail();
    for (const char* key : {"data", "info", "message", "to"})
      if (object_.contains(key))
        return wrong(fmt::format("'{}' is of e-mail blocks; remove it, or set function", key));
    return block_.is_user_frame() ? read_user_frame() : read_variables();
  }

 private:
  Error wrong(const std::string& cause) const {
    return fail(fmt::format("cannot read {}: {}", what_, cause));
  }

  template <std::size_t count>
  Status word(const char* key, const std::array<Word, count>& words, int& to) {
    std::string text(std::ranges::find(words, to, &Word::meaning)->text);
    reader_.text(key, text);
    if (reader_.error()) return *reader_.error();
    std::vector<std::string_view> known;
    for (const Word& w : words) known.push_back(w.text);
    const auto found = std::ranges::find(words, text, &Word::text);
    if (found == words.end())
      return wrong(fmt::format("{} is '{}'; use one of {}{}", key, text, fmt::join(known, ", "),
                               suggestion(text, known)));
    to = found->meaning;
    return ok();
  }

  Status read_condition() {
    std::string flag;
    reader_.text("flag", flag);
    if (reader_.error()) return *reader_.error();
    if (block_.function == Function::ereceive && flag.empty()) return ok();
    if (block_.function == Function::receive)
      return flag.empty()
                 ? ok()
                 : Status(wrong("a receive block has no flag: it is always armed; remove 'flag'"));
    Result<P2pCondition> condition = parse_p2p_condition(flag, model_);
    if (!condition) return wrong(condition.error().message);
    block_.condition = *condition;
    return ok();
  }

  /// One text, or a list of up to four.
  Result<std::vector<std::string>> names(const char* key) const {
    std::vector<std::string> texts;
    const auto value = object_.find(key);
    if (value == object_.end()) return texts;
    const json list = value->is_array() ? *value : json::array({*value});
    for (const json& text : list) {
      if (!text.is_string())
        return wrong(fmt::format("{} is not an address, or a list of addresses", key));
      texts.push_back(text.get<std::string>());
    }
    if (texts.empty() || texts.size() > p2p_max_variables)
      return wrong(fmt::format("{} has {} addresses; a block has 1 to {} variables", key,
                               texts.size(), p2p_max_variables));
    return texts;
  }

  Status read_variables() {
    if (object_.contains("frame"))
      return wrong("'frame' is of send and receive blocks; remove it, or set function");
    const bool reads = block_.function == Function::read;
    const char *own_key = reads ? "save" : "read", *partner_key = reads ? "read" : "save";
    const auto own = names(own_key), partner = names(partner_key);
    if (!own) return own.error();
    if (!partner) return partner.error();
    if (own->empty() || partner->empty())
      return wrong(
          fmt::format("there is no {}; a {} block has read (where from) and save (where to)",
                      own->empty() ? own_key : partner_key, reads ? "read" : "write"));
    if (own->size() != partner->size())
      return wrong(fmt::format("read and save have not the same number of addresses: {} and {}",
                               reads ? partner->size() : own->size(),
                               reads ? own->size() : partner->size()));
    if (block_.continuous && own->size() != 1)
      return wrong("a continuous block has one variable; use command single, or one address");
    if (!block_.continuous && object_.contains("size"))
      return wrong("size is of continuous blocks; remove it, or set command");
    for (std::size_t i = 0; i < own->size(); ++i) {
      const Result<plc::DeviceAddress> address = own_address(own_key, (*own)[i], block_.elements());
      if (!address) return address.error();
      if (address->type != block_.type)
        return wrong(fmt::format("{} '{}' is of type {}, and the block of type {}; make them equal",
                                 own_key, (*own)[i], type_name(address->type),
                                 type_name(block_.type)));
      block_.variables.push_back({(*partner)[i], *address});
    }
    return ok();
  }

  Status read_user_frame() {
    reader_.text("frame", block_.frame);
    if (reader_.error()) return *reader_.error();
    const bool sends = block_.function == Function::send;
    const char *own_key = sends ? "read" : "save", *other = sends ? "save" : "read";
    if (block_.frame.empty()) return wrong("there is no frame; give its name, such as GROUP.FRAME");
    for (const char* key : {other, "command", "type", "station"})
      if (object_.contains(key))
        return wrong(
            fmt::format("'{}' is not of a {} block; remove it", key, sends ? "send" : "receive"));
    const auto own = names(own_key);
    if (!own) return own.error();
    for (const std::string& name : *own) {
      const Result<plc::DeviceAddress> address = own_address(own_key, name, 1);
      if (!address) return address.error();
      block_.variables.push_back({"", *address});
    }
    return ok();
  }

  /// ESEND has the numbers of a message and of an address; ERECEIVE has areas, and does nothing
  /// (FEnet EN 7.4.3).
  Status read_mail() {
    const bool sends = block_.function == Function::esend;
    if (!rules_.network)
      return wrong("e-mail is sent by an Ethernet module alone; use function send, or read");
    for (const char* key :
         {"channel", "command", "frame", "read", "size", "station", "type", sends ? "save" : "data",
          sends ? "info" : "message", sends ? "info" : "to"})
      if (object_.contains(key))
        return wrong(fmt::format("'{}' is not of an {} block; remove it", key,
                                 sends ? "esend" : "ereceive"));
    block_.channel = 0;
    if (sends) return read_esend();
    block_.condition = {};  // it never fires
    return ok();
  }

  Status read_esend() {
    for (const char* key : {"message", "to"})
      if (!object_.contains(key))
        return wrong(fmt::format("there is no {}; give the number of {} in p2p.email", key,
                                 std::string_view(key) == "to" ? "an address" : "a message"));
    reader_.whole("message", highest_mail_number, block_.message);
    reader_.whole("to", highest_mail_number, block_.address);
    if (reader_.error()) return *reader_.error();
    const auto own = names("data");
    if (!own) return own.error();
    for (const std::string& name : *own) {
      const Result<plc::DeviceAddress> address = own_address("data", name, 1);
      if (!address) return address.error();
      if (address->type != 'B')
        return wrong(
            fmt::format("data '{}' is of type {}; a mail takes bytes: give one such as "
                        "%MB100",
                        name, type_name(address->type)));
      block_.variables.push_back({"", *address});
    }
    return ok();
  }

  Result<plc::DeviceAddress> own_address(const char* key, const std::string& name,
                                         unsigned elements) const {
    const plc::ParsedAddress parsed = plc::parse_address(model_, name);
    if (!parsed)
      return wrong(fmt::format("{} '{}' is wrong on {}: {}", key, name, model_.name,
                               plc::describe(parsed.fault)));
    if (!plc::fits(model_, parsed.address, elements))
      return wrong(fmt::format("{} '{}': the area ends before the last of {} elements", key, name,
                               elements));
    const plc::DeviceArea& area = model_.areas[parsed.address.area];
    if (std::string_view(key) == "save" && !area.write)
      return wrong(
          fmt::format("save '{}': {} is read only; save in another area", name, area.letter));
    return parsed.address;
  }

  const json& object_;
  const plc::PlcModel& model_;
  const P2pRules& rules_;
  P2pBlock& block_;
  plc::ConfigReader reader_;
  std::string what_;
};

Error wrong_block(unsigned number, const std::string& cause) {
  return fail(fmt::format("cannot set up P2P block {}: {}", number, cause));
}

/// What blocks must not have in common, and where they may be.
Status check_together(const P2pParameters& parameters) {
  std::set<unsigned> numbers;
  std::set<std::string> received;
  const unsigned first_channel =
      parameters.blocks.empty() ? parameters.channel : parameters.blocks.front().channel;
  for (const P2pBlock& block : parameters.blocks) {
    if (!numbers.insert(block.number).second)
      return wrong_block(block.number, "it is there twice; give each block a number of its own");
    if (block.function == Function::receive && !received.insert(block.frame).second)
      return wrong_block(
          block.number,
          fmt::format(
              "frame {} has a receive block already; one block receives a frame (Cnet EN 6.2.4)",
              block.frame));
    if (block.is_mail() && !parameters.email)
      return wrong_block(block.number, "there are no e-mail settings; give 'email' in p2p");
    if (!parameters.network && parameters.parameter != 1 && block.channel != first_channel)
      return wrong_block(
          block.number,
          fmt::format(
              "channel is {}; P2P {} is a module of one channel, and other blocks have channel {}",
              block.channel, parameters.parameter, first_channel));
  }
  return ok();
}
}  // namespace

Result<P2pParameters> parse_p2p_parameters(const json& p2p, const plc::PlcModel& model,
                                           const P2pRules& rules) {
  constexpr std::array<std::string_view, 9> keys{"blocks",    "channel",   "link",
                                                 "parameter", "email",     "partner",
                                                 "port",      "transport", "channels"};
  const auto own_keys = std::span(keys).first(rules.network ? keys.size() : keys.size() - 5);
  if (const Status known = plc::known_keys(p2p, "p2p", own_keys); !known) return known.error();
  P2pParameters parameters;
  parameters.network = rules.network;
  plc::ConfigReader reader(p2p, "p2p");
  reader.whole("parameter", p2p_parameters, parameters.parameter);
  reader.whole("channel", rules.channels, parameters.channel);
  reader.boolean("link", parameters.link);
  reader.host("partner", parameters.partner);
  reader.whole("port", 65'535u, parameters.port);
  bool datagrams = false;
  reader.either("transport", "udp", "tcp", datagrams);
  if (datagrams) parameters.transport = Transport::udp;
  if (reader.error()) return *reader.error();
  if (parameters.parameter == 0 || parameters.channel == 0)
    return fail("cannot read p2p: parameter is 1 to 3, and channel " + channel_numbers(rules));
  if (rules.network) {
    Result<std::vector<P2pChannel>> channels = parse_p2p_channels(p2p, rules.channels);
    if (!channels) return channels.error();
    parameters.channels = std::move(*channels);
  }
  parameters.email = p2p.contains("email");
  const auto list = p2p.find("blocks");
  // The events of the CPU are mailed without any block.
  if (list == p2p.end() && parameters.email) return parameters;
  if (list == p2p.end() || !list->is_array() || list->empty())
    return fail("cannot read p2p: there are no blocks; give a list of them");
  if (list->size() > p2p_blocks)
    return fail(fmt::format("cannot read p2p: there are {} blocks; a parameter has at most 32",
                            list->size()));
  for (const json& object : *list) {
    P2pBlock block;
    block.number = static_cast<unsigned>(parameters.blocks.size());
    block.channel = parameters.channel;
    block.station = rules.station;
    plc::ConfigReader number(object, fmt::format("p2p.blocks[{}]", block.number));
    if (object.is_object()) number.whole("block", p2p_blocks - 1, block.number);
    if (number.error()) return *number.error();
    const Status status =
        BlockReader(object, model, rules, block, fmt::format("P2P block {}", block.number)).read();
    if (!status) return status.error();
    parameters.blocks.push_back(std::move(block));
  }
  std::ranges::sort(parameters.blocks, {}, &P2pBlock::number);
  if (const Status status = check_together(parameters); !status) return status.error();
  return parameters;
}

P2pChannel P2pParameters::settings_of(unsigned channel_number) const {
  const auto own = std::ranges::find(channels, channel_number, &P2pChannel::number);
  if (own != channels.end()) return *own;
  return {channel_number, {}, partner, port, transport};
}

Status check_p2p_driver(const P2pParameters& parameters, unsigned channel, const P2pDriver& driver,
                        const plc::PlcModel& model) {
  const bool user_frames = driver.name() == "user-frames";
  for (const P2pBlock& block : parameters.blocks) {
    if (block.channel != channel) continue;
    if (block.is_user_frame() != user_frames) {
      const char* cause =
          user_frames
              ? "the driver user-frames has send and receive alone"
              : "a channel whose driver is {} sends and receives no user frames (Cnet EN 6.2.3)";
      return wrong_block(block.number, fmt::format(fmt::runtime(cause), driver.name()) +
                                           "; set function, or another driver");
    }
    if (const Status status = driver.check(block, model); !status)
      return wrong_block(block.number, status.error().message);
  }
  return ok();
}

}  // namespace fieldproof::p2p
