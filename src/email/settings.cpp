#include "src/email/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "src/p2p/block.hpp"
#include "src/plc/config_reader.hpp"

namespace fieldproof::email {

namespace {
using nlohmann::json;
using p2p::highest_mail_number;

constexpr std::size_t longest_line = 998;     // RFC 5321 4.5.3.1.6, without CR LF
constexpr std::size_t longest_address = 254;  // RFC 5321 4.5.3.1.3, without < and >
constexpr std::size_t longest_name = 64;      // of a user, and of an entry of the address book
constexpr unsigned shortest_period = 10;      // seconds
constexpr unsigned longest_period = 24 * 3600;
constexpr const char* whose = "p2p.email";

bool is_printable(char c) { return c >= ' ' && c <= '~'; }

bool is_address(std::string_view text) {
  constexpr std::string_view foreign = " <>,;:\"()\\";
  const std::size_t at = text.find('@');
  return at != std::string_view::npos && at > 0 && at + 1 < text.size() &&
         text.find('@', at + 1) == std::string_view::npos && text.size() <= longest_address &&
         std::ranges::all_of(text, is_printable) &&
         text.find_first_of(foreign) == std::string_view::npos;
}

/// One object of the settings, and what is wrong with it.
struct ObjectReader {
  ObjectReader(const json& of, std::string name)
      : object(of), what(std::move(name)), reader(object, what) {}

  Status known(std::span<const std::string_view> keys) const {
    return plc::known_keys(object, what, keys);
  }
  Error wrong(const std::string& cause) const {
    return fail(fmt::format("cannot read {}: {}", what, cause));
  }
  Status done() const { return reader.error() ? Status(*reader.error()) : ok(); }
  bool has(std::string_view key) const { return object.contains(key); }

  /// ASCII that can be printed, as no other is supported (7.4.1).
  Status ascii(const char* key, std::size_t longest, std::string& to) {
    reader.text(key, to);
    if (reader.error()) return *reader.error();
    if (!std::ranges::all_of(to, is_printable))
      return wrong(
          fmt::format("{} has a character that is no printable ASCII; e-mail supports "
                      "ASCII alone (FEnet EN 7.4.1)",
                      key));
    if (to.size() > longest)
      return wrong(fmt::format("{} has {} characters; give at most {}", key, to.size(), longest));
    return ok();
  }
  Status address(std::string& to) {
    reader.text("address", to);
    if (reader.error()) return *reader.error();
    if (is_address(to)) return ok();
    return wrong(
        fmt::format("address is '{}'; give one such as plc@plant.example, of at most {} characters",
                    to, longest_address));
  }

  const json& object;
  std::string what;
  plc::ConfigReader reader;
};

/// The number of an entry; an error where another has it.
template <typename Table>
Result<unsigned> number_of(ObjectReader& entry, std::size_t place, const Table& known) {
  auto number = static_cast<unsigned>(place);
  entry.reader.whole("number", highest_mail_number, number);
  if (const Status read = entry.done(); !read) return read.error();
  if (number > highest_mail_number)
    return entry.wrong(fmt::format("it has the number {} by its place; numbers are 0 to {}", number,
                                   highest_mail_number));
  if (known.contains(number))
    return entry.wrong(
        fmt::format("number {} is there twice; give each entry a number of its own", number));
  return number;
}

/// A list of the settings: `read` gets each object, with its name for messages and its place.
template <typename Read>
Status each_of(const json& email, const char* key, Read read) {
  const auto list = email.find(key);
  if (list == email.end()) return ok();
  if (!list->is_array())
    return fail(fmt::format("cannot read {}: {} is no list; give a list of objects", whose, key));
  for (std::size_t i = 0; i < list->size(); ++i)
    if (const Status one = read((*list)[i], fmt::format("{}.{}[{}]", whose, key, i), i); !one)
      return one;
  return ok();
}

/// An entry of the address book that is read when all single ones are known.
struct Group {
  const json& object;
  std::string what;
  unsigned number = 0;
};

Status read_address(const json& object, const std::string& what, std::size_t place,
                    EmailSettings& settings, std::vector<Group>& groups) {
  constexpr std::array<std::string_view, 4> keys{"address", "group", "name", "number"};
  ObjectReader entry(object, what);
  if (const Status known = entry.known(keys); !known) return known;
  const Result<unsigned> number = number_of(entry, place, settings.addresses);
  if (!number) return number.error();
  if (entry.has("group") == entry.has("address"))
    return entry.wrong("give address, of one person, or group, the numbers of its members");
  Mailbox one;
  if (const Status name = entry.ascii("name", longest_name, one.name); !name) return name;
  std::vector<Mailbox>& to = settings.addresses[*number];
  if (entry.has("group")) {
    groups.push_back({object, what, *number});
    return ok();
  }
  if (const Status read = entry.address(one.address); !read) return read;
  to.push_back(std::move(one));
  return ok();
}

/// The number of a person whose address there is.
Result<unsigned> read_member(const json& member, const ObjectReader& entry,
                             const std::vector<Group>& groups, const EmailSettings& settings) {
  if (!member.is_number_integer() || member < 0 || member > highest_mail_number)
    return entry.wrong(
        fmt::format("group has {}, which is no number of an address; numbers are 0 "
                    "to {}",
                    member.dump(), highest_mail_number));
  const auto number = member.get<unsigned>();
  if (std::ranges::find(groups, number, &Group::number) != groups.end())
    return entry.wrong(
        fmt::format("group has {}, which is a group itself; give the numbers of persons", number));
  if (!settings.addresses.contains(number))
    return entry.wrong(fmt::format("group has {}, and there is no such address; there are {}",
                                   number, numbers_of(settings.addresses)));
  return number;
}

Status read_group(const Group& group, const std::vector<Group>& groups, EmailSettings& settings) {
  const ObjectReader entry(group.object, group.what);
  const json& members = group.object.at("group");
  if (!members.is_array() || members.empty())
    return entry.wrong("group is no list of numbers; give the numbers of its members");
  if (members.size() > most_members)
    return entry.wrong(fmt::format("group has {} members; a group has at most {} (FEnet EN 7.4.3)",
                                   members.size(), most_members));
  std::set<unsigned> seen;
  for (const json& member : members) {
    const Result<unsigned> number = read_member(member, entry, groups, settings);
    if (!number) return number.error();
    if (!seen.insert(*number).second)
      return entry.wrong(fmt::format("group has {} twice; give each member once", *number));
    settings.addresses[group.number].push_back(settings.addresses.at(*number).front());
  }
  return ok();
}

Status read_addresses(const json& email, EmailSettings& settings) {
  std::vector<Group> groups;
  const Status read =
      each_of(email, "addresses", [&](const json& one, const std::string& what, std::size_t place) {
        return read_address(one, what, place, settings, groups);
      });
  if (!read) return read;
  for (const Group& group : groups)
    if (const Status one = read_group(group, groups, settings); !one) return one;
  return ok();
}

Status read_part(const json& object, const std::string& what, MessagePart& part) {
  constexpr std::array<std::string_view, 3> keys{"change", "mb", "text"};
  ObjectReader entry(object, what);
  if (const Status known = entry.known(keys); !known) return known;
  if (entry.has("mb") == entry.has("text"))
    return entry.wrong("give text, a string, or mb, the number of bytes from memory");
  entry.reader.boolean("change", part.change);
  entry.reader.whole("mb", longest_line, part.memory_bytes);
  if (const Status text = entry.ascii("text", longest_line, part.text); !text) return text;
  if (entry.has("mb") && part.memory_bytes == 0) return entry.wrong("mb is 0; give at least 1");
  return ok();
}

/// No line is longer than SMTP carries.
bool lines_fit(const Message& message) {
  std::size_t line = 0;
  for (const MessagePart& part : message.parts) {
    line += part.text.size() + part.memory_bytes;
    if (line > longest_line) return false;
    if (part.change) line = 0;
  }
  return true;
}

Status read_message(const json& object, const std::string& what, std::size_t place,
                    EmailSettings& settings) {
  constexpr std::array<std::string_view, 3> keys{"number", "parts", "title"};
  ObjectReader entry(object, what);
  if (const Status known = entry.known(keys); !known) return known;
  const Result<unsigned> number = number_of(entry, place, settings.messages);
  if (!number) return number.error();
  Message message;
  if (const Status title = entry.ascii("title", longest_line - 9, message.title); !title)
    return title;
  if (entry.has("parts") && !object.at("parts").is_array())
    return entry.wrong("parts is no list; give a list of {\"text\": ...} and {\"mb\": ...}");
  const json parts = entry.has("parts") ? object.at("parts") : json::array();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string name = fmt::format("{}.parts[{}]", what, i);
    if (const Status part = read_part(parts[i], name, message.parts.emplace_back()); !part)
      return part;
  }
  if (message.memory_parts() > p2p::p2p_max_variables)
    return entry.wrong(fmt::format("parts has {} of the form mb; a block has at most {} areas",
                                   message.memory_parts(), p2p::p2p_max_variables));
  if (!lines_fit(message))
    return entry.wrong(fmt::format(
        "parts make a line of more than {} characters, which SMTP does not carry; set change",
        longest_line));
  settings.messages[*number] = std::move(message);
  return ok();
}

Status read_event(const json& events, std::size_t event, EmailSettings& settings) {
  const auto found = events.find(event_names[event]);
  if (found == events.end()) return ok();
  constexpr std::array<std::string_view, 2> keys{"message", "to"};
  ObjectReader entry(*found, fmt::format("{}.events.{}", whose, event_names[event]));
  if (const Status known = entry.known(keys); !known) return known;
  for (const std::string_view key : keys)
    if (!entry.has(key))
      return entry.wrong(fmt::format("there is no {}; give the number of what is mailed", key));
  EventMail& mail = settings.events[event].emplace();
  entry.reader.whole("message", highest_mail_number, mail.message);
  entry.reader.whole("to", highest_mail_number, mail.address);
  if (const Status read = entry.done(); !read) return read;
  if (const Status numbers = check_numbers(settings, mail.message, mail.address); !numbers)
    return entry.wrong(numbers.error().message);
  if (settings.messages.at(mail.message).memory_parts() > 0)
    return entry.wrong(fmt::format(
        "message {} has parts of the form mb, and an event has no data; give one of strings",
        mail.message));
  return ok();
}

Status read_events(const json& email, EmailSettings& settings) {
  const auto events = email.find("events");
  if (events == email.end()) return ok();
  if (const Status known = plc::known_keys(*events, "p2p.email.events", event_names); !known)
    return known;
  for (std::size_t event = 0; event < event_names.size(); ++event)
    if (const Status read = read_event(*events, event, settings); !read) return read;
  return ok();
}

Status read_server(ObjectReader& entry, EmailSettings& settings) {
  unsigned port = smtp_port, period = shortest_period, unused = 0;
  std::string not_used;
  entry.reader.boolean("use", settings.use);
  entry.reader.host("server", settings.server);
  entry.reader.whole("port", 65'535, port);
  entry.reader.whole("period_s", longest_period, period);
  entry.reader.host("pop3_server", not_used);
  for (const char* key : {"account", "password"}) entry.reader.text(key, not_used);
  entry.reader.whole("interval_s", longest_period, unused);
  if (const Status read = entry.done(); !read) return read;
  if (port == 0) return entry.wrong("port is 0; leave it out for 25, the port of SMTP");
  if (period < shortest_period)
    return entry.wrong(fmt::format("period_s is {}; give at least {} s (FEnet EN 7.4.1)", period,
                                   shortest_period));
  settings.port = static_cast<std::uint16_t>(port);
  settings.period = std::chrono::seconds(period);
  return ok();
}
}  // namespace

std::size_t Message::memory_parts() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(parts, [](const MessagePart& part) { return part.memory_bytes > 0; }));
}

Result<EmailSettings> parse_email_settings(const json& email) {
  constexpr std::array<std::string_view, 13> keys{
      "account",  "address",     "addresses", "events", "interval_s", "messages", "password",
      "period_s", "pop3_server", "port",      "server", "use",        "user"};
  ObjectReader entry(email, whose);
  if (const Status known = entry.known(keys); !known) return known.error();
  EmailSettings settings;
  settings.use = true;
  if (const Status server = read_server(entry, settings); !server) return server.error();
  if (const Status user = entry.ascii("user", longest_name, settings.sender.name); !user)
    return user.error();
  if (const Status own = entry.address(settings.sender.address); !own) return own.error();
  if (const Status addresses = read_addresses(email, settings); !addresses)
    return addresses.error();
  const Status messages =
      each_of(email, "messages", [&](const json& one, const std::string& what, std::size_t place) {
        return read_message(one, what, place, settings);
      });
  if (!messages) return messages.error();
  if (const Status events = read_events(email, settings); !events) return events.error();
  return settings;
}

Status check_numbers(const EmailSettings& settings, unsigned message, unsigned address) {
  if (!settings.messages.contains(message))
    return fail(
        fmt::format("message is {}, and p2p.email.messages has none of that number; it "
                    "has {}",
                    message, numbers_of(settings.messages)));
  if (!settings.addresses.contains(address))
    return fail(fmt::format("to is {}, and p2p.email.addresses has none of that number; it has {}",
                            address, numbers_of(settings.addresses)));
  return ok();
}

}  // namespace fieldproof::email
