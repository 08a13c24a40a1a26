// Faults of what is said to the server, when, and of how its replies are taken (DECISIONS.md
// email/smtp).
#include <algorithm>

#include "suites/email/broken/faults.hpp"

namespace fieldproof::email_broken {

namespace {

/// The same words behind another code; a piece of a reply stays as it is.
std::string with_code(std::string text, std::string_view code) {
  return text.size() < code.size() ? text : text.replace(0, code.size(), code);
}

/// `then` instead of QUIT.
MakeBehaviour at_quit(LinkEvent then) {
  return acts([then](Bursts& does, Module&) {
    for (Burst& one : does)
      if (to_text(one.bytes) == "QUIT\r\n") {
        one.bytes.clear();
        one.event = then;
      }
  });
}

/// What it does at the end of a connection.
MakeBehaviour at_end(LinkEvent instead) {
  return acts([instead](Bursts& does, Module&) {
    for (Burst& one : does)
      if (one.event == LinkEvent::closed) one.event = instead;
  });
}

MakeBehaviour never_ends() {
  return acts([](Bursts& does, Module&) {
    std::erase_if(does, [](const Burst& one) { return one.event == LinkEvent::closed; });
  });
}

/// The end comes with QUIT, and not again.
MakeBehaviour ends_with_quit() {
  return acts([](Bursts& does, Module&) {
    std::erase_if(does, [](const Burst& one) { return one.event == LinkEvent::closed; });
    for (std::size_t i = 0; i < does.size(); ++i)
      if (to_text(does[i].bytes) == "QUIT\r\n")
        does.push_back({.bytes = {},
                        .start = does[i].start,
                        .link = does[i].link,
                        .event = LinkEvent::closed});
  });
}

/// HELO goes out with the connection, and is not said again.
MakeBehaviour does_not_wait() {
  return acts([](Bursts& does, Module&) {
    std::erase_if(does, [](const Burst& one) {
      return one.event == LinkEvent::data && to_text(one.bytes).starts_with("HELO");
    });
    for (std::size_t i = 0; i < does.size(); ++i)
      if (does[i].event == LinkEvent::opened)
        does.push_back({.bytes = to_bytes("HELO plant.example\r\n"),
                        .start = does[i].start,
                        .link = does[i].link});
  });
}

/// A reply that says no is heard as one that says yes, where it is the answer to `command`.
MakeBehaviour takes_no_for_yes(std::string command, std::string yes) {
  return hears([=](std::string text, Module& module) {
    const bool no = text.starts_with('4') || text.starts_with('5');
    return no && module.last_said.starts_with(command) ? with_code(text, yes) : text;
  });
}

std::vector<Fault> command_faults() {
  return {
      {"ehlo", "greets by EHLO", says_instead("HELO", "EHLO"), "email/dialogue/one_address",
       "command"},
      {"helo_alone", "HELO names no domain", says_instead("HELO plant.example", "HELO"),
       "email/dialogue/one_address", "argument"},
      {"helo_user", "HELO names the whole address", says_instead("HELO ", "HELO plc@"),
       "email/dialogue/one_address", "argument"},
      {"helo_fixed", "HELO names always the same domain",
       says_instead("HELO [10.0.0.7]", "HELO plant.example"), "email/address/own_domain",
       "argument"},
      {"sender_bare", "the sender stands without brackets",
       says_instead("FROM:<plc@plant.example>", "FROM:plc@plant.example"),
       "email/dialogue/one_address", "argument"},
      {"sender_by_name", "the recipient has its name in RCPT TO",
       says_instead("TO:<tony@", "TO:Tony <tony@"), "email/dialogue/one_address", "argument"},
      {"line_feed_alone", "lines end with LF", says_instead("\r\n", "\n"),
       "email/dialogue/one_address", ""},
      {"no_quit", "ends without QUIT", at_quit(LinkEvent::closed), "email/dialogue/one_address",
       ""},
      {"ends_with_quit", "does not wait for the reply to QUIT", ends_with_quit(),
       "email/dialogue/silence_at_bye", "no reason"},
      {"resets", "ends by RST", at_end(LinkEvent::reset), "email/dialogue/one_address", ""},
      {"never_ends", "keeps the connection", never_ends(), "email/dialogue/one_address",
       "did not close"},
      {"does_not_wait", "says HELO before the greeting", does_not_wait(),
       "email/dialogue/nothing_before_the_flag", ""},
      {"login", "logs in where the server offers it", says([](std::string text, Module& module) {
         return module.last_said.starts_with("HELO") && text.starts_with("MAIL")
                    ? std::string("AUTH LOGIN\r\n")
                    : text;
       }),
       "email/dialogue/no_login", "AUTH"},
      {"speaks_pop3", "logs in as to a POP3 server", acts([](Bursts& does, Module&) {
         for (Burst& one : does)
           if (one.event == LinkEvent::opened)
             does.push_back({.bytes = to_bytes("USER plc\r\n"), .link = one.link});
       }),
       "email/dialogue/nothing_before_the_flag", ""},
  };
}

std::vector<Fault> reply_faults() {
  return {
      {"first_line_is_all", "the first line of a reply is taken for all of it",
       hears([](std::string text, Module&) {
         if (text.size() > 3 && text[3] == '-') text[3] = ' ';
         return text;
       }),
       "email/dialogue/replies_of_lines", ""},
      {"pieces_are_lost", "a piece without an end of line is lost",
       hears([](std::string text, Module&) { return text.ends_with('\n') ? text : std::string(); }),
       "email/dialogue/replies_in_pieces", ""},
      {"pieces_are_replies", "each piece is taken for a reply",
       hears([](std::string text, Module&) { return text.ends_with('\n') ? text : text + "\r\n"; }),
       "email/dialogue/replies_in_pieces", ""},
      {"only_250", "251 is taken for a refusal", hears([](std::string text, Module&) {
         return text.starts_with("251") ? with_code(text, "551") : text;
       }),
       "email/dialogue/first_digit/c251", "QUIT"},
      {"needs_words", "a code without words is no reply", hears([](std::string text, Module&) {
         return text.size() == 5 ? std::string("x\r\n") : text;
       }),
       "email/dialogue/code_alone", ""},
      {"no_greeting_is_good", "a greeting that says no is none",
       hears([](std::string text, Module&) {
         return text.starts_with("554") ? with_code(text, "220") : text;
       }),
       "email/status/refused_greeting/c5", "command"},
      {"hello_is_good", "a refusal of HELO is overlooked", takes_no_for_yes("HELO", "250"),
       "email/status/refused_hello/c4", "command"},
      {"sender_is_good", "a refusal of the sender is overlooked", takes_no_for_yes("MAIL", "250"),
       "email/status/refused_sender/c5", "command"},
      {"recipient_is_good", "a refusal of a recipient is overlooked",
       takes_no_for_yes("RCPT", "250"), "email/status/refused_recipient/c5", "command"},
      {"data_is_good", "the text is sent although DATA was refused",
       takes_no_for_yes("DATA", "354"), "email/status/refused_data/c4", ""},
      {"text_is_good", "a refusal of the text is overlooked", takes_no_for_yes("From", "250"),
       "email/status/refused_text/c4", "0002"},
      {"text_after_250", "the text is sent after 250", hears([](std::string text, Module& module) {
         return module.last_said.starts_with("DATA") && text.starts_with("250")
                    ? with_code(text, "354")
                    : text;
       }),
       "email/status/data_without_354", ""},
      {"all_or_none", "a refused member keeps the mail from the others",
       [] {
         auto refused = std::make_shared<bool>(false);
         return Behaviour{.hears = [refused](std::string text, Module& module) {
           const bool recipient = module.last_said.starts_with("RCPT");
           *refused = *refused || (recipient && text.starts_with('5'));
           return *refused && recipient ? std::string("550 no\r\n") : text;
         }};
       },
       "email/status/one_member_refused/first", "command"},
  };
}

}  // namespace

std::vector<Fault> dialogue_faults() {
  return broken::gather<Fault>({command_faults, reply_faults});
}

}  // namespace fieldproof::email_broken
