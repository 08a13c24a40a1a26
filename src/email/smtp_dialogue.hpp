// What an SMTP client says to a server to hand over one mail (RFC 5321; DECISIONS.md email/smtp):
// HELO, MAIL FROM, a RCPT TO for each recipient, DATA, the text, QUIT. It says nothing before the
// greeting, and one thing at a time: each waits for the whole reply to the one before. No login,
// no encryption (FEnet EN 7.4.1).
//
// A reply may have several lines and come in any pieces; its first digit decides. A recipient that
// is refused does not keep the mail from the others, but its end is `address` then. After a refusal
// of all else comes QUIT. What is no reply ends the dialogue at once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "src/base/bytes.hpp"
#include "src/email/mail.hpp"

namespace fieldproof::email {

/// How a mail ended, as STATUS of its block shows it (DECISIONS.md email/status).
namespace email_status {
constexpr std::uint16_t none = 0,  // the server has taken it
    address = 0x01,                // it refuses the sender, or a recipient
    server = 0x03,                 // it cannot be reached, does not greet, or refuses HELO
    transfer = 0x05,               // it refuses the text, or ends, is silent or talks nonsense
    off = 0x07;                    // e-mail is switched off
}  // namespace email_status

class SmtpDialogue {
 public:
  explicit SmtpDialogue(Mail mail) : mail_(std::move(mail)) {}

  /// Bytes of the server. What is said to them; empty: nothing.
  std::string hear(ByteView bytes);
  /// The server has ended the connection, refused it, or let the time-out pass.
  void give_up();

  /// email_status; nothing: not known yet.
  std::optional<std::uint16_t> result() const { return result_; }
  /// There is nothing more to say or hear.
  bool over() const { return stage_ == Stage::over; }

 private:
  enum class Stage { greeting, hello, sender, recipients, data, content, quit, over };

  std::string answer(unsigned code);
  std::string recipient(bool taken);
  std::string next_recipient();
  std::string finish(std::uint16_t status);
  void break_off();

  Mail mail_;
  Stage stage_ = Stage::greeting;
  std::size_t recipient_ = 0, taken_ = 0;
  std::optional<std::uint16_t> result_;
  std::string heard_;  // no whole line yet
};

}  // namespace fieldproof::email
