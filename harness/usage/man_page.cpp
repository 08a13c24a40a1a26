#include "harness/usage/man_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "reports/text/fold.hpp"

namespace fieldproof::usage {

namespace {

constexpr std::size_t source_width = 60;  // of lines that escapes make longer

/// Text that roff takes as such: hyphens that can be copied, no request at the begin of a line.
std::string roff(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    const bool begins = escaped.empty() || escaped.back() == '\n';
    if (begins && (c == '.' || c == '\'')) escaped += "\\&";
    switch (c) {
      case '\\': escaped += "\\e"; break;
      case '-': escaped += "\\-"; break;
      case '\'': escaped += "\\(aq"; break;
      case '`': escaped += "\\(ga"; break;
      case '^': escaped += "\\(ha"; break;
      case '~': escaped += "\\(ti"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

std::string heading(const Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names)
    names.push_back(option.positional ? italic(name) : bold(name));
  std::string text = fmt::format("{}", fmt::join(names, ", "));
  if (option.positional) return text + (option.repeated ? "..." : "");
  return option.value.empty() ? text : text + ' ' + italic(option.value);
}

std::string entry(const std::string& head, const std::string& description) {
  return fmt::format(".TP\n{}\n{}\n", head,
                     description.empty() ? "\\&" : roff(text::fold(description, source_width)));
}

std::string paragraph(const std::string& text) {
  return roff(text::fold(text, source_width)) + '\n';
}

std::string options(const Command& command) {
  std::string text;
  for (const Option* one : command.positionals()) text += entry(heading(*one), one->description);
  for (const std::string& group : command.groups) {
    if (command.groups.size() > 1) text += fmt::format(".PP\n{}:\n", roff(group));
    for (const Option* one : command.of_group(group))
      text += entry(heading(*one), one->description);
  }
  return text;
}

/// Of a command, and of those below it.
std::string section(const Command& command) {
  std::string text = fmt::format(".SS \"{}\"\n{}", roff(command.synopsis()),
                                 paragraph(command.description + ".")) +
                     options(command);
  for (const Command& one : command.commands) text += section(one);
  return text;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

}  // namespace

std::string man_page(const Command& tool, const Release& release) {
  std::string text = fmt::format(
      ".TH {0} 1 {1} \"{2} {3}\" \"User Commands\"\n.SH NAME\n{2} \\- {4}\n.SH SYNOPSIS\n{5}\n"
      ".SH DESCRIPTION\n{6}",
      upper(tool.name), release.date, tool.name, release.version,
      "conformance bench for PLC communication", roff(tool.synopsis()),
      paragraph(tool.description));
  text += ".SH OPTIONS\n" + options(tool) + ".SH COMMANDS\n";
  for (const Command& one : tool.commands) text += section(one);
  std::string status = tool.footer;
  if (constexpr std::string_view label = "Exit codes: "; status.starts_with(label))
    status.erase(0, label.size());
  text += ".SH \"EXIT STATUS\"\n" + paragraph(status);
  text += ".SH ENVIRONMENT\n";
  text += entry(bold("COLUMNS"), "How wide lines may be, on a terminal or not.");
  text += entry(bold("NO_COLOR"), "Set: no colours.");
  text += entry(bold("FIELDPROOF_DATA"), "Folder of vectors, profiles and definitions.");
  text += entry(bold("GTEST_TOTAL_SHARDS") + ", " + bold("GTEST_SHARD_INDEX"),
                "Which part of the cases is run, from 0.");
  return text;
}

}  // namespace fieldproof::usage
