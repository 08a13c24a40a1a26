#include "src/email/smtp_dialogue.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::email {

namespace {
/// RFC 5321 4.5.3.1.5 has 512; some servers say more.
constexpr std::size_t longest_reply_line = 2048;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// "250 ok", "250-ok", "250"
bool is_reply(std::string_view line) {
  return line.size() >= 3 && std::ranges::all_of(line.substr(0, 3), is_digit) &&
         (line.size() == 3 || line[3] == ' ' || line[3] == '-');
}
}  // namespace

std::string SmtpDialogue::hear(ByteView bytes) {
  if (over()) return {};
  heard_ += to_text(bytes);
  for (std::size_t end = 0; (end = heard_.find('\n')) != std::string::npos;) {
    std::string line = heard_.substr(0, end);
    heard_.erase(0, end + 1);
    if (line.ends_with('\r')) line.pop_back();
    if (!is_reply(line)) {
      break_off();
      return {};
    }
    if (line.size() > 3 && line[3] == '-') continue;
    heard_.clear();  // what comes before it is asked for is no reply
    return answer(static_cast<unsigned>(std::stoul(line.substr(0, 3))));
  }
  if (heard_.size() > longest_reply_line) break_off();
  return {};
}

void SmtpDialogue::give_up() {
  if (!over()) break_off();
}

void SmtpDialogue::break_off() {
  if (!result_) result_ = stage_ <= Stage::hello ? email_status::server : email_status::transfer;
  stage_ = Stage::over;
}

std::string SmtpDialogue::finish(std::uint16_t status) {
  result_ = status;
  stage_ = Stage::quit;
  return "QUIT\r\n";
}

std::string SmtpDialogue::answer(unsigned code) {
  const bool done = code / 100 == 2, go_on = code / 100 == 3;
  switch (stage_) {
    case Stage::greeting:
      if (!done) return finish(email_status::server);
      stage_ = Stage::hello;
      return "HELO " + mail_.greeting + "\r\n";
    case Stage::hello:
      if (!done) return finish(email_status::server);
      stage_ = Stage::sender;
      return "MAIL FROM:<" + mail_.sender + ">\r\n";
    case Stage::sender:
      if (!done) return finish(email_status::address);
      stage_ = Stage::recipients;
      return next_recipient();
    case Stage::recipients: return recipient(done);
    case Stage::data:
      if (!go_on) return finish(email_status::transfer);
      stage_ = Stage::content;
      return mail_.content;
    case Stage::content:
      if (!done) return finish(email_status::transfer);
      // Who is not among those that it was taken for shows.
      return finish(taken_ < mail_.recipients.size() ? email_status::address : email_status::none);
    case Stage::quit:
    case Stage::over: break;
  }
  stage_ = Stage::over;
  return {};
}

std::string SmtpDialogue::recipient(bool taken) {
  taken_ += taken;
  if (++recipient_ < mail_.recipients.size()) return next_recipient();
  if (taken_ == 0) return finish(email_status::address);
  stage_ = Stage::data;
  return "DATA\r\n";
}

std::string SmtpDialogue::next_recipient() {
  return "RCPT TO:<" + mail_.recipients[recipient_] + ">\r\n";
}

}  // namespace fieldproof::email
