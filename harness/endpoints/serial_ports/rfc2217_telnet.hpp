// Telnet (RFC 854, 856) and its COM-PORT-OPTION (RFC 2217) as bytes: what a client says, and how it
// reads the server.
#pragma once

#include <set>
#include <string>
#include <variant>
#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::endpoints::telnet {

enum Verb : Byte { will = 251, wont = 252, do_it = 253, dont = 254 };

constexpr Byte binary = 0;  // RFC 856: all 8 bits, no CR NUL
constexpr Byte suppress_go_ahead = 3;
constexpr Byte com_port = 44;

/// Commands of the client (RFC 2217, 2 to 4); the server answers with `answer + command`.
enum Command : Byte {
  set_baud_rate = 1,  // 4 bytes, most significant first
  set_data_size = 2,
  set_parity = 3,  // 1 none, 2 odd, 3 even
  set_stop_size = 4,
  set_control = 5,
  notify_line_state = 6,  // of the server alone
  set_line_state_mask = 10,
  purge_data = 12,
};
constexpr Byte answer = 100;

enum Control : Byte { ask_flow_control = 0, no_flow_control = 1, rts_on = 11, rts_off = 12 };
enum LineState : Byte { overrun_error = 2, parity_error = 4, framing_error = 8, break_detect = 16 };
constexpr Byte purge_both = 3;

/// Data as it travels: each 255 is doubled.
Bytes escaped(ByteView data);
/// IAC VERB OPTION
Bytes negotiation(Verb verb, Byte option);
/// IAC SB COM-PORT-OPTION command value IAC SE
Bytes command(Byte command, ByteView value);

struct Negotiation {
  Verb verb{};
  Byte option = 0;
};
struct Notification {
  Byte command = 0;  // as sent: answer + command
  Bytes value;
};
/// Data, or what the server says beside it.
using Message = std::variant<Bytes, Negotiation, Notification>;

/// Takes the server's stream apart, however it is cut.
class Decoder {
 public:
  /// In the order they came; data that stands together is one message.
  std::vector<Message> decode(ByteView bytes);

 private:
  enum class State { data, command, option, sub, sub_command };
  void take(Byte byte, std::vector<Message>& messages);
  void take_command(Byte byte, std::vector<Message>& messages);
  void end_sub(std::vector<Message>& messages);

  State state_ = State::data;
  Verb verb_{};
  Bytes sub_;
};

/// The client's side of the negotiation: both directions binary, and the client commands the port.
class Negotiator {
 public:
  /// What is sent first.
  static Bytes opening();
  /// What is answered: nothing to an agreement on what we want, refusal of everything else.
  Bytes answer(const Negotiation& from_server);
  /// What the server has not agreed to yet: "RFC 2217 (COM-PORT-OPTION)", "binary transmission";
  /// empty: all is agreed.
  std::string missing() const;
  /// What it has refused of that, or empty.
  const std::string& refused() const { return refused_; }

 private:
  std::set<Byte> ours_, theirs_;  // options that the server has agreed to: our WILL, our DO
  std::string refused_;
};

}  // namespace fieldproof::endpoints::telnet
