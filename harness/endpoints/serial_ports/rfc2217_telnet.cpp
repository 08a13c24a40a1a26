#include "harness/endpoints/serial_ports/rfc2217_telnet.hpp"

namespace fieldproof::endpoints::telnet {

namespace {

constexpr Byte iac = 255;
constexpr Byte sub_begin = 250;
constexpr Byte sub_end = 240;
/// No notification is as long; a signature may be.
constexpr std::size_t longest_sub = 1024;
constexpr std::string_view the_protocol = "RFC 2217 (COM-PORT-OPTION)";
constexpr std::string_view eight_bits = "binary transmission";

void add_data(Byte byte, std::vector<Message>& messages) {
  if (messages.empty() || !std::holds_alternative<Bytes>(messages.back()))
    messages.emplace_back(Bytes{});
  std::get<Bytes>(messages.back()).push_back(byte);
}

}  // namespace

Bytes escaped(ByteView data) {
  Bytes result;
  result.reserve(data.size());
  for (const Byte byte : data) {
    result.push_back(byte);
    if (byte == iac) result.push_back(iac);
  }
  return result;
}

Bytes negotiation(Verb verb, Byte option) { return {iac, verb, option}; }

Bytes command(Byte command, ByteView value) {
  Bytes result{iac, sub_begin, com_port, command};
  const Bytes body = escaped(value);
  result.insert(result.end(), body.begin(), body.end());
  result.insert(result.end(), {iac, sub_end});
  return result;
}

std::vector<Message> Decoder::decode(ByteView bytes) {
  std::vector<Message> messages;
  for (const Byte byte : bytes) take(byte, messages);
  return messages;
}

void Decoder::take(Byte byte, std::vector<Message>& messages) {
  switch (state_) {
    case State::data:
      if (byte == iac)
        state_ = State::command;
      else
        add_data(byte, messages);
      return;
    case State::command: return take_command(byte, messages);
    case State::option:
      messages.emplace_back(Negotiation{verb_, byte});
      state_ = State::data;
      return;
    case State::sub:
      if (byte == iac)
        state_ = State::sub_command;
      else if (sub_.size() < longest_sub)
        sub_.push_back(byte);
      return;
    case State::sub_command:
      if (byte == iac) {
        if (sub_.size() < longest_sub) sub_.push_back(iac);
        state_ = State::sub;
      } else {
        // Anything but the end is a fault of the server; what stands there is lost either way.
        if (byte == sub_end) end_sub(messages);
        state_ = State::data;
      }
      return;
  }
}

void Decoder::take_command(Byte byte, std::vector<Message>& messages) {
  state_ = State::data;
  if (byte == iac) return add_data(iac, messages);
  if (byte == sub_begin) {
    sub_.clear();
    state_ = State::sub;
  } else if (byte >= will && byte <= dont) {
    verb_ = static_cast<Verb>(byte);
    state_ = State::option;
  }  // NOP, GA and the like say nothing to us
}

void Decoder::end_sub(std::vector<Message>& messages) {
  if (sub_.size() < 2 || sub_[0] != com_port) return;
  messages.emplace_back(Notification{sub_[1], Bytes(sub_.begin() + 2, sub_.end())});
}

Bytes Negotiator::opening() {
  Bytes bytes;
  for (const Bytes& one :
       {negotiation(will, binary), negotiation(do_it, binary), negotiation(will, suppress_go_ahead),
        negotiation(do_it, suppress_go_ahead), negotiation(will, com_port)})
    bytes.insert(bytes.end(), one.begin(), one.end());
  return bytes;
}

Bytes Negotiator::answer(const Negotiation& from_server) {
  const auto [verb, option] = from_server;
  const bool wanted = option == binary || option == suppress_go_ahead ||
                      (option == com_port && (verb == do_it || verb == dont));
  // Answering what was asked for would answer an answer, and go on for ever (RFC 854).
  if (!wanted)
    return verb == do_it  ? negotiation(wont, option)
           : verb == will ? negotiation(dont, option)
                          : Bytes{};
  std::set<Byte>& agreed_to = verb == do_it || verb == dont ? ours_ : theirs_;
  if (verb == do_it || verb == will)
    agreed_to.insert(option);
  else
    agreed_to.erase(option);
  if ((verb == dont || verb == wont) && option != suppress_go_ahead)
    refused_ = std::string(option == com_port ? the_protocol : eight_bits);
  return {};
}

std::string Negotiator::missing() const {
  if (!ours_.contains(com_port)) return std::string(the_protocol);
  if (!ours_.contains(binary) || !theirs_.contains(binary)) return std::string(eight_bits);
  return "";
}

}  // namespace fieldproof::endpoints::telnet
