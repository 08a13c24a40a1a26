#include "harness/usage/usage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <algorithm>

namespace fieldproof::usage {

namespace {

/// Of CLI11's "TEXT:{client,server}" the type, and the choices.
void read_type(const std::string& type, Option& option) {
  const std::size_t colon = type.find(':');
  option.value = type.substr(0, colon);
  if (colon == std::string::npos || type.compare(colon + 1, 1, "{") != 0) return;
  option.value = type.substr(colon + 1);
  for (std::size_t at = 1; at < option.value.size();) {
    const std::size_t end = option.value.find_first_of(",}", at);
    option.choices.push_back(option.value.substr(at, end - at));
    at = end + 1;
  }
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

Option read_option(const CLI::Option& source) {
  Option option;
  option.names = names_of(source);
  option.description = source.get_description();
  option.group = source.get_group();
  option.required = source.get_required();
  option.repeated = source.get_expected_max() > 1;
  if (source.get_type_size() != 0 || source.get_items_expected_max() > 0)
    read_type(source.get_type_name(), option);
  if (!source.get_default_str().empty() && !option.value.empty())
    option.description += fmt::format("{}(default {})", option.description.empty() ? "" : " ",
                                      source.get_default_str());
  return option;
}

}  // namespace

std::string Option::heading() const {
  std::string text = fmt::format("{}", fmt::join(names, ", "));
  if (positional) return text + (repeated ? "..." : "");
  return value.empty() ? text : text + ' ' + value;
}

std::string Command::synopsis() const {
  std::string text = name + " [OPTIONS]";
  for (const Option* one : positionals())
    text += fmt::format(" {}", one->required ? one->heading() : '[' + one->heading() + ']');
  return commands.empty() ? text : text + " COMMAND";
}

const Command* Command::command(std::string_view word) const {
  const auto found = std::ranges::find_if(commands, [&](const Command& one) {
    return std::string_view(one.name).substr(one.name.rfind(' ') + 1) == word;
  });
  return found == commands.end() ? nullptr : &*found;
}

const Option* Command::option(std::string_view wanted) const {
  const auto found = std::ranges::find_if(options, [&](const Option& one) {
    return !one.positional && std::ranges::count(one.names, wanted) > 0;
  });
  return found == options.end() ? nullptr : &*found;
}

std::vector<const Option*> Command::positionals() const {
  std::vector<const Option*> found;
  for (const Option& one : options)
    if (one.positional) found.push_back(&one);
  return found;
}

std::vector<const Option*> Command::of_group(std::string_view group) const {
  std::vector<const Option*> found;
  for (const Option& one : options)
    if (!one.positional && one.group == group) found.push_back(&one);
  return found;
}

Command usage_of(const CLI::App& app, const std::string& parent) {
  Command command;
  command.name = parent.empty() ? app.get_name() : parent + ' ' + app.get_name();
  command.description = app.get_description();
  command.footer = app.get_footer();
  for (const CLI::Option* source : app.get_options()) {
    if (source->get_group().empty()) continue;  // hidden
    const Option option = read_option(*source);
    if (!option.names.empty()) command.options.push_back(option);
    if (!source->get_positional()) continue;
    Option& positional = command.options.emplace_back(option);
    positional.positional = true;
    positional.names = {source->get_name(true, false)};
  }
  command.groups = app.get_groups();
  std::erase_if(command.groups,
                [&](const std::string& group) { return command.of_group(group).empty(); });
  if (const CLI::Option* help = app.get_help_ptr())  // it is the first one, and the least
    std::ranges::stable_partition(
        command.groups, [&](const std::string& group) { return group != help->get_group(); });
  for (const CLI::App* one : app.get_subcommands({}))
    if (!one->get_group().empty()) command.commands.push_back(usage_of(*one, command.name));
  return command;
}

}  // namespace fieldproof::usage
