#pragma once

#include <string>

namespace fieldproof::os {

/// A word of a command line as a shell reads it: quoted where it must be.
std::string shell_word(const std::string& word);

}  // namespace fieldproof::os
