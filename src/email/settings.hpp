// The e-mail settings of a P2P parameter (FEnet EN 7.4.1, 7.4.2): user, server, events of the CPU,
// address book and messages, read from JSON and checked.
//
//   {"use": true, "user": "PLC", "address": "plc@plant.example",
//    "server": "192.0.2.25", "port": 25, "period_s": 10,
//    "events": {"run_to_stop": {"message": 0, "to": 0}, "stop_to_run": ..., "error": ...},
//    "addresses": [{"number": 0, "name": "Tony", "address": "tony@plant.example"},
//                  {"number": 2, "name": "Friend", "group": [0, 1]}],
//    "messages": [{"number": 0, "title": "Pump 3",
//                  "parts": [{"text": "Pressure ", "change": false}, {"mb": 10, "change": true}]}]}
//
// Numbers are 0 to 255, the place in the list where none is given. What the manual names and the
// module does not use may stand there, too: pop3_server, account, password, interval_s.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"
#include "src/base/time.hpp"

namespace fieldproof::email {

constexpr std::size_t most_members = 10;  // of a group (FEnet EN 7.4.3)
constexpr std::uint16_t smtp_port = 25;

struct Mailbox {
  std::string name{};     // "Tony"; may be empty
  std::string address{};  // "tony@plant.example"
};

/// A string, or so many bytes of memory from the address on that the block gives (form MB).
struct MessagePart {
  std::string text{};
  unsigned memory_bytes = 0;  // 0: a string
  bool change = false;        // the line ends behind it
};

struct Message {
  std::string title{};
  std::vector<MessagePart> parts{};

  /// Parts of the form MB.
  std::size_t memory_parts() const;
};

/// What is mailed at an event of the CPU; absent: nothing.
struct EventMail {
  unsigned message = 0, address = 0;
};
enum class CpuEvent { run_to_stop, stop_to_run, error };
constexpr std::array<std::string_view, 3> event_names{"run_to_stop", "stop_to_run", "error"};

struct EmailSettings {
  bool use = false;
  Mailbox sender{.name = "PLC"};
  std::string server{};  // empty: whoever is there
  std::uint16_t port = smtp_port;
  Duration period = 10s;  // at which the CPU is looked at
  std::array<std::optional<EventMail>, event_names.size()> events{};
  std::map<unsigned, std::vector<Mailbox>> addresses{};  // one, or the members of a group
  std::map<unsigned, Message> messages{};
};

/// Errors name the key: "cannot read p2p.email.addresses[2]: ...".
Result<EmailSettings> parse_email_settings(const nlohmann::json& email);

/// Is there such a message, and such an address? The error names the key, message or to, and those
/// that there are.
Status check_numbers(const EmailSettings& settings, unsigned message, unsigned address);

/// "0, 1, 4"
template <typename Table>
std::string numbers_of(const Table& table) {
  std::string text;
  for (const auto& [number, what] : table)
    text += (text.empty() ? "" : ", ") + std::to_string(number);
  return text.empty() ? "none" : text;
}

}  // namespace fieldproof::email
