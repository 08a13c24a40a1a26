// Which device of a history the user means.
#pragma once

#include <string>
#include <vector>

#include "reports/history/history.hpp"

namespace fieldproof::history {

/// Each once, that of the last run at the end.
std::vector<std::string> devices_of(const std::vector<RunEntry>& runs);

/// `text`: its name, or a part that only one has. The error says which there are.
Result<std::string> find_device(const std::vector<RunEntry>& runs, const std::string& text);

}  // namespace fieldproof::history
