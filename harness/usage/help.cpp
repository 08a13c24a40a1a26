#include "harness/usage/help.hpp"

#include <fmt/format.h>

#include "reports/text/case_text.hpp"
#include "reports/text/fold.hpp"

namespace fieldproof::usage {

namespace {

constexpr std::size_t column = 26;  // of descriptions

/// What is named, and what it is: beside it, or below it where the name is long.
std::string entry(const std::string& name, const std::string& description, std::size_t width) {
  const std::string text = "  " + name;
  if (description.empty()) return text + '\n';
  const std::string lines = text::indent(text::fold(description, width - column), column);
  if (text.size() + 2 > column) return text::fold(text, width) + '\n' + lines;
  return text + lines.substr(text.size());
}

}  // namespace

std::string help_text(const Command& command, std::size_t width) {
  std::string text = text::fold(command.description, width) + "\n\n" +
                     text::fold("Usage: " + command.synopsis(), width) + '\n';
  if (!command.positionals().empty()) text += '\n';
  for (const Option* one : command.positionals())
    text += entry(one->heading(), one->description, width);
  for (const std::string& group : command.groups) {
    text += fmt::format("\n{}:\n", group);
    for (const Option* one : command.of_group(group))
      text += entry(one->heading(), one->description, width);
  }
  if (!command.commands.empty()) text += "\nCommands:\n";
  for (const Command& one : command.commands)
    text += entry(one.name.substr(command.name.size() + 1), one.description, width);
  if (!command.footer.empty()) text += '\n' + text::fold(command.footer, width) + '\n';
  return text;
}

}  // namespace fieldproof::usage
