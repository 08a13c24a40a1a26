// What the command line takes, as plain values: one source of help, man page and completion.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace fieldproof::usage {

struct Option {
  std::vector<std::string> names;    // "-v", "--verbose"; of a positional its name
  std::string value;                 // "TEXT", "{client,server}"; empty: a flag
  std::vector<std::string> choices;  // of which the value is one; empty: free
  std::string description;           // with the default, where there is one
  std::string group;
  bool positional = false, required = false, repeated = false;

  /// "-v, --verbose", "--role {client,server}", "results...".
  std::string heading() const;
};

struct Command {
  std::string name;  // "fieldproof run"
  std::string description, footer;
  std::vector<std::string> groups;  // of options, in their order
  std::vector<Option> options;      // that help shows
  std::vector<Command> commands;

  /// "fieldproof run [OPTIONS] results...".
  std::string synopsis() const;
  const Command* command(std::string_view word) const;
  /// The option of that name; nullptr: there is none.
  const Option* option(std::string_view name) const;
  std::vector<const Option*> positionals() const;
  std::vector<const Option*> of_group(std::string_view group) const;
};

/// Of a command and those below it. `parent`: the words in front of its name.
Command usage_of(const CLI::App& app, const std::string& parent = "");

}  // namespace fieldproof::usage
