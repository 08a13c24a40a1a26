// A vector, checked and expanded: what the bench executes. One vector may give many cases (`each`).
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/notation/notation.hpp"
#include "harness/vectors/number.hpp"
#include "src/base/burst.hpp"

namespace fieldproof::vectors {

/// What this project decided where the manuals are silent: an entry of DECISIONS.md.
struct Decision {
  std::string id;        // "cnet/order-of-checks"
  std::string sentence;  // the first of the entry; empty until load_decisions has found it
};

/// The sentence that a case, or one step of it, rests on. The words are those of the first
/// statement; a vector of its own document gives them itself.
struct Source {
  std::string manual, section, quote;
  std::vector<std::string> statements;  // ids, the one that carries the assertion first
};

/// A frame of a step as the vector gives it: notation, and the literal bytes where they are
/// printed.
struct Frame {
  std::string alternative;  // its name; empty where there is one frame alone
  std::string text;         // notation, with the framing of its protocol
  notation::Notation notation;
  std::optional<std::string> wire;  // "05 30 ??"
  std::string body{};               // as written, where a framing was put around it: "pdu(03 ...)"
};

/// One of our own devices in the partner's chair: it answers what a client asks, well or by a
/// fault.
struct PartnerSpec {
  std::string model;                                        // empty: the first of the protocol
  nlohmann::json config = nlohmann::json::object();         // keys of given.config
  std::vector<std::pair<std::string, std::string>> memory;  // set before each answer
  std::string fault;                                        // of partner_faults; empty: none
};

/// What may happen to the partner's answer (vectors/README.md).
inline constexpr std::array<std::string_view, 14> partner_faults{
    "wrong_station", "wrong_check", "nak",   "wrong_head", "wrong_tail", "short",       "long",
    "not_hex",       "late",        "never", "echo",       "garbage",    "other_block", "previous"};

/// What an `open` step opens.
struct LinkSpec {
  std::string protocol;  // empty: the case's
  Transport transport = Transport::tcp;
  std::uint16_t port = 0;  // 0: the protocol's
};

/// What a check may find where a manual leaves several readings: the values at the addresses of the
/// step's memory, in its order.
struct CheckedValues {
  std::string alternative;                     // its name
  std::vector<std::string> digits;             // hex
  std::vector<std::optional<Number>> numbers;  // beside digits, where it names a number
};

struct Step {
  enum class Kind {
    send,
    expect,
    silence,
    wait,
    set,
    check,
    act,
    open,
    close,
    expect_close,
    partner,
    expect_open
  };
  Kind kind = Kind::send;
  Source source{};            // where the step rests on another sentence than its case, else empty
  std::vector<Frame> frames;  // send: one; expect: the preferred first
  std::string reading;        // what the alternatives of `expect`, `check` are about: type_echo
  std::vector<std::pair<std::string, std::string>> memory;  // set, check: address and hex digits
  std::vector<std::optional<Number>> numbers;  // check: beside memory, where it names a number
  std::vector<CheckedValues> alternatives;     // check: all that it may find, memory as the first
  std::string action;                          // do
  Duration duration{};                         // wait
  std::optional<Duration> within;              // expect: instead of the profile's response_max
  std::optional<Duration> every;               // expect: the period at which it comes
  std::optional<Duration> max_gap;             // expect: longest silence inside the frame
  std::optional<PartnerSpec> partner;          // partner, expect: who answers the request
  int times = 1;
  std::string on;                  // name of the link; empty: the only one that is open
  LinkSpec link;                   // open
  Closing closing = Closing::fin;  // close
  std::optional<LinkEvent> ending = std::nullopt;  // expect_close: closed or reset; nothing: either
  bool may_stay = false;                           // expect_close: it need not end
};

struct Case {
  std::string id, vector_id;
  int rev = 1;
  std::string title;
  std::string protocol;  // "xgt-cnet", from the folder of the id
  Source source;
  std::string level, basis, why;
  std::string on_model;  // nothing of it is on a wire: instruction, register, configuration, timing
  std::vector<Decision> decisions;  // that it rests on
  std::vector<std::string> models;  // empty: all
  nlohmann::json config = nlohmann::json::object();
  std::vector<std::pair<std::string, std::string>> memory;
  bool fresh = false;
  bool transpose = true;
  bool line_alone = false;  // its line is the whole case: what it looks at in memory is beside it
  std::vector<Step> steps;
  bool by_rule = false;  // made from another case (explore::derived_cases)
  nlohmann::json facts;  // kind table: not null
  std::string file;      // for messages
};

/// given.config.station as a number; `fallback` when absent, nothing when it is not 0-255.
std::optional<int> config_station(const nlohmann::json& config, int fallback);

/// The names of its alternatives, the preferred one first.
std::vector<std::string> alternatives_of(const Step& step);

bool is_client_case(const Case& one);
/// `role`: "client", "server", or empty for both.
bool has_role(const Case& one, const std::string& role);

/// "1234*3" and "seq(3)" written out as hex digits; nothing when not hex.
std::optional<std::string> expand_hex(const std::string& text);

}  // namespace fieldproof::vectors
