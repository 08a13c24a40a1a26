#include "src/email/mail.hpp"

#include <algorithm>
#include <string_view>

namespace fieldproof::email {

namespace {

/// Characters of a word that needs no quotes (RFC 5322 3.2.3), and blanks between such words.
bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view(" !#$%&'*+-/=?^_`{|}~").find(c) != std::string_view::npos;
}

std::string in_quotes(std::string_view name) {
  std::string text = "\"";
  for (const char c : name) text += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
  return text + '"';
}

/// "Tony <tony@plant.example>"
std::string written(const Mailbox& one) {
  if (one.name.empty()) return one.address;
  const bool plain = std::ranges::all_of(one.name, is_plain);
  return (plain ? one.name : in_quotes(one.name)) + " <" + one.address + '>';
}

std::string header(const EmailSettings& settings, const std::vector<Mailbox>& to,
                   const std::string& title) {
  std::string text =
      "From: " + written(settings.sender) + "\r\nReply-To: " + settings.sender.address + "\r\nTo: ";
  for (const Mailbox& one : to) text += (&one == &to.front() ? "" : ",\r\n ") + written(one);
  return text + "\r\nSubject: " + title + "\r\n\r\n";
}

std::string printable(const Bytes& bytes) {
  std::string text;
  for (const Byte byte : bytes) text += byte >= ' ' && byte <= '~' ? static_cast<char>(byte) : '.';
  return text;
}

/// A last line without an end gets one.
std::string body(const Message& message, const std::vector<Bytes>& data) {
  std::string text;
  auto next = data.begin();
  for (const MessagePart& part : message.parts) {
    text += part.memory_bytes == 0 ? part.text : next != data.end() ? printable(*next++) : "";
    if (part.change) text += "\r\n";
  }
  if (!text.empty() && !text.ends_with("\r\n")) text += "\r\n";
  return text;
}

/// RFC 5321 4.5.2: a dot that begins a line is sent twice, and one alone ends the text.
std::string with_end(const std::string& text) {
  std::string sent;
  bool begins = true;
  for (const char c : text) {
    if (begins && c == '.') sent += '.';
    sent += c;
    begins = c == '\n';
  }
  return sent + ".\r\n";
}

}  // namespace

Mail make_mail(const EmailSettings& settings, const EventMail& numbers,
               const std::vector<Bytes>& data) {
  const std::vector<Mailbox>& to = settings.addresses.at(numbers.address);
  const Message& message = settings.messages.at(numbers.message);
  Mail mail;
  mail.sender = settings.sender.address;
  mail.greeting = mail.sender.substr(mail.sender.find('@') + 1);
  for (const Mailbox& one : to) mail.recipients.push_back(one.address);
  mail.content = with_end(header(settings, to, message.title) + body(message, data));
  return mail;
}

}  // namespace fieldproof::email
