// What an SMTP server may say to a module that mails, and the e-mail settings that people write.
#pragma once

#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::fuzz {

/// Whatever is said: the module says whole lines, and at its end it knows how the mail ended.
void feed_replies(ByteView input);
std::vector<Bytes> good_replies();

/// Settings that are taken make a mail for each message and address.
void feed_mail_settings(ByteView input);
std::vector<Bytes> good_mail_settings();

}  // namespace fieldproof::fuzz
