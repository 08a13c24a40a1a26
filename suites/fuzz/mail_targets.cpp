#include "suites/fuzz/mail_targets.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "src/email/smtp_dialogue.hpp"
#include "suites/fuzz/rule.hpp"

namespace fieldproof::fuzz {

namespace {

constexpr const char* good_settings = R"({
  "user": "Hall 2.1", "address": "plc@plant.example", "server": "10.0.0.25", "period_s": 10,
  "events": {"error": {"message": 0, "to": 2}},
  "addresses": [{"name": "Tony", "address": "tony@plant.example"},
                {"number": 1, "address": "peter@plant.example"},
                {"number": 2, "name": "Friend", "group": [0, 1]}],
  "messages": [{"title": "Pump 3", "parts": [{"text": ".", "change": true}, {"text": "end"}]},
               {"number": 4, "title": "Tank", "parts": [{"mb": 10, "change": true}]}]})";

email::Mail mail() {
  const auto settings = email::parse_email_settings(nlohmann::json::parse(good_settings));
  rule(bool(settings), "the settings of these tests are good");
  return email::make_mail(*settings, {0, 2});
}

}  // namespace

/// The first byte says in pieces of how many bytes the others come.
void feed_replies(ByteView input) {
  if (input.empty()) return;
  email::SmtpDialogue dialogue(mail());
  const std::size_t size = input[0] + std::size_t{1};
  for (ByteView rest = input.subspan(1); !rest.empty();) {
    const bool over = dialogue.over();
    const std::string said = dialogue.hear(rest.first(std::min(size, rest.size())));
    rule(said.empty() || said.ends_with("\r\n"), "a module says whole lines");
    rule(said.empty() || !over, "it says nothing behind its end");
    rest = rest.subspan(std::min(size, rest.size()));
  }
  dialogue.give_up();
  rule(dialogue.over() && dialogue.result(), "a mail that is over has ended in some way");
}

std::vector<Bytes> good_replies() {
  std::vector<Bytes> all;
  for (const char* text :
       {"220 a\r\n250-b\r\n250 c\r\n250 d\r\n250 e\r\n250 f\r\n354 g\r\n250 h\r\n"
        "221 i\r\n",
        "220 a\r\n250 b\r\n250 c\r\n550 d\r\n450 e\r\n221 f\r\n", "554 a\r\n221 b\r\n"})
    for (const Byte piece : {Byte{0}, Byte{6}}) {
      Bytes one = to_bytes(text);
      one.insert(one.begin(), piece);
      all.push_back(std::move(one));
    }
  return all;
}

void feed_mail_settings(ByteView input) {
  const nlohmann::json read = nlohmann::json::parse(to_text(input), nullptr, false);
  if (read.is_discarded()) return;
  const auto settings = email::parse_email_settings(read);
  if (!settings) return rule(!settings.error().message.empty(), "an error says what is wrong");
  for (const auto& [address, mailboxes] : settings->addresses)
    for (const auto& [message, parts] : settings->messages) {
      const email::Mail one = email::make_mail(*settings, {message, address});
      rule(!one.recipients.empty() && one.recipients.size() <= email::most_members,
           "a mail has one recipient to ten");
      rule(one.content.ends_with("\r\n.\r\n"), "a text has its end");
    }
}

std::vector<Bytes> good_mail_settings() { return {to_bytes(good_settings)}; }

}  // namespace fieldproof::fuzz
