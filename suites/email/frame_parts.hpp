// What of SMTP (RFC 5321) stands between two turns: a line of a command or a reply, or the text of
// a mail as DATA carries it.
#pragma once

#include <optional>
#include <vector>

#include "harness/protocol.hpp"

namespace fieldproof::email_suite {

/// A command or a line of a reply ends with CR LF, a text with a line that is a dot alone. What
/// begins with no command and no reply is a text.
std::optional<std::size_t> frame_length(ByteView bytes);

/// Command and argument; code and words; the header lines of a text by their names, its other
/// lines by their number.
std::vector<harness::Field> explain(ByteView frame);

}  // namespace fieldproof::email_suite
