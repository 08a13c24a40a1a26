// Faults of the address book and of the text of a mail (DECISIONS.md email/header, email/text).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "suites/email/broken/faults.hpp"

namespace fieldproof::email_broken {

namespace {

using nlohmann::json;

MakeBehaviour each_part(void (*change)(json& part)) {
  return email([change](json& email) {
    for (json& message : email["messages"])
      if (message.contains("parts"))
        for (json& part : message["parts"]) change(part);
  });
}

/// Groups lose their members behind so many.
MakeBehaviour groups_of(std::size_t most) {
  return email([most](json& email) {
    for (json& entry : email["addresses"])
      if (entry.contains("group") && entry["group"].size() > most)
        entry["group"].erase(entry["group"].begin() + static_cast<std::ptrdiff_t>(most),
                             entry["group"].end());
  });
}

/// Of the text alone, behind the header and before its end.
MakeBehaviour body(std::string from, std::string to) {
  return says([=](std::string text, Module&) {
    if (!is_content(text)) return text;
    const std::size_t begin = text.find("\r\n\r\n") + 4, end = text.size() - 3;
    return text.substr(0, begin) + replaced(text.substr(begin, end - begin), from, to) +
           text.substr(end);
  });
}

MakeBehaviour exchanges_numbers(const char* list) {
  return email(
      [list](json& email) { std::swap(email[list][0]["number"], email[list][1]["number"]); });
}

std::vector<Fault> header_faults() {
  return {
      {"no_reply_to", "there is no Reply-To", says_instead("Reply-To: plc@plant.example\r\n", ""),
       "email/dialogue/one_address", "Reply-To"},
      {"from_without_name", "the user name is left out", says_instead("From: PLC ", "From: "),
       "email/dialogue/one_address", "From"},
      {"from_is_plc", "the user name is always PLC", email([](json& one) { one["user"] = "PLC"; }),
       "email/address/user_name/line", "From"},
      {"name_without_quotes", "a name with a dot stands without quotes", says_instead("\"", ""),
       "email/address/user_name/dot", "From"},
      {"to_first_alone", "the header has the first recipient alone",
       says_instead(",\r\n Peter <peter@plant.example>", ""), "email/address/group_of_two", "To"},
      {"no_subject", "the title is left out", says_instead("Subject: Pump 3", "Subject: "),
       "email/dialogue/one_address", "Subject"},
      {"title_is_text", "the title stands as text",
       says_instead("Subject: Pump 3\r\n\r\n", "\r\nPump 3\r\n"), "email/dialogue/one_address", ""},
      {"first_member", "a group is its first member", groups_of(1), "email/address/group_of_two",
       "command"},
      {"nine_members", "a group has nine members at most", groups_of(9),
       "email/address/group_of_ten", "command"},
      {"group_upside_down", "a group is mailed to from its last member on", email([](json& one) {
         for (json& entry : one["addresses"])
           if (entry.contains("group")) std::reverse(entry["group"].begin(), entry["group"].end());
       }),
       "email/address/group_of_ten", ""},
      {"other_address", "the number is that of the next address", exchanges_numbers("addresses"),
       "email/address/by_number/n3", "argument"},
      {"other_message", "the number is that of the next message", exchanges_numbers("messages"),
       "email/address/message_by_number/m5", "Subject"},
  };
}

std::vector<Fault> text_faults() {
  return {
      {"dots_alone", "a dot that begins a line is sent once", says([](std::string text, Module&) {
         return is_content(text) ? replaced(std::move(text), "\r\n..", "\r\n.") : text;
       }),
       "email/text/dot_line", ""},
      {"dots_everywhere", "each dot is sent twice", body(".", ".."), "email/text/not_printable",
       "line"},
      {"question_marks", "what cannot be printed is sent as ?", body(".", "?"),
       "email/text/not_printable", "line"},
      {"left_out", "what cannot be printed is left out", body(".", ""), "email/text/not_printable",
       "line"},
      {"blank_is_not_printable", "a blank is sent as a dot", body(" ~", ".~"),
       "email/text/not_printable", "line"},
      {"tilde_is_not_printable", "~ is sent as a dot", body("~", "."), "email/text/not_printable",
       "line"},
      {"no_change", "change is overlooked", each_part([](json& part) { part["change"] = false; }),
       "email/text/strings_and_change", "line"},
      {"always_change", "each part is a line", each_part([](json& part) { part["change"] = true; }),
       "email/text/strings_and_change", "line"},
      {"empty_lines_lost", "empty lines are left out", body("\r\n\r\n", "\r\n"),
       "email/text/empty_lines", "line"},
      {"one_byte_less", "MB sends a byte less", each_part([](json& part) {
         if (part.contains("mb") && part["mb"] == 10) part["mb"] = 9;
       }),
       "email/text/ten_bytes", "line"},
      {"ten_always", "MB sends ten bytes, whatever its size", each_part([](json& part) {
         if (part.contains("mb")) part["mb"] = 10;
       }),
       "email/text/size/three", "line"},
      {"one_byte_further", "MB begins a byte further", p2p([](json& p2p) {
         for (json& block : p2p["blocks"])
           if (block.value("data", json()) == "%MB100") block["data"] = "%MB101";
       }),
       "email/text/ten_bytes", "line"},
      {"first_area_alone", "all parts take their bytes from the first area", p2p([](json& p2p) {
         for (json& block : p2p["blocks"])
           if (block.contains("data") && block["data"].is_array())
             for (json& area : block["data"]) area = block["data"][0];
       }),
       "email/text/two_areas", "line"},
      {"bytes_swapped", "the bytes of a word change places", body("ABCDEFGHIJ", "BADCFEHGJI"),
       "email/text/ten_bytes", "line"},
  };
}

}  // namespace

std::vector<Fault> mail_faults() { return broken::gather<Fault>({header_faults, text_faults}); }

}  // namespace fieldproof::email_broken
