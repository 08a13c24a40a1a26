// One mail as it is handed to a server: envelope and text (FEnet EN 7.4.2; DECISIONS.md
// email/header, email/text).
//
//   From: PLC <plc@plant.example>
//   Reply-To: plc@plant.example
//   To: Tony <tony@plant.example>,
//    Peter <peter@plant.example>
//   Subject: Pump 3
//
//   Pressure 0123......
#pragma once

#include <string>
#include <vector>

#include "src/base/bytes.hpp"
#include "src/email/settings.hpp"

namespace fieldproof::email {

struct Mail {
  std::string greeting{};                 // what HELO says: the domain of the sender's address
  std::string sender{};                   // "plc@plant.example"
  std::vector<std::string> recipients{};  // 1 to 10 of the same
  std::string content{};  // header and text as DATA carries them: CR LF, dots doubled, its end
};

/// `numbers` are of a message and an address that there are. `data` has the bytes of each part of
/// the form MB, in their order; one that cannot be printed is written as '.'.
Mail make_mail(const EmailSettings& settings, const EventMail& numbers,
               const std::vector<Bytes>& data = {});

}  // namespace fieldproof::email
