// Where a user's runs keep what must outlast them.
#pragma once

#include <filesystem>
#include <string_view>

namespace fieldproof::os {

/// "fieldproof/NAME" in XDG_STATE_HOME, else in ~/.local/state. Empty: without a home there is
/// none.
std::filesystem::path state_folder(std::string_view name);

}  // namespace fieldproof::os
