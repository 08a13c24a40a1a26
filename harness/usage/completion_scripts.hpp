// What makes a shell ask the tool for completion.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace fieldproof::usage {

inline constexpr std::array<std::string_view, 3> shells{"bash", "zsh", "fish"};

/// For one of the shells, of the tool named so.
std::string completion_script(std::string_view shell, std::string_view tool);

}  // namespace fieldproof::usage
