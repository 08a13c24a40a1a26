#include "harness/cli/usage_commands.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>
#include <algorithm>

#include "harness/cli/completion_values.hpp"
#include "harness/run/exit_code.hpp"
#include "harness/run/run_report.hpp"
#include "harness/system/terminal.hpp"
#include "harness/usage/completion_scripts.hpp"
#include "harness/usage/help.hpp"
#include "harness/usage/man_page.hpp"

namespace fieldproof::cli {

namespace {

/// Prose: as wide as the terminal, up to a width that reads well.
std::size_t help_width() {
  const int columns = os::terminal_columns(STDOUT_FILENO);
  return columns == 0 ? 80 : static_cast<std::size_t>(std::clamp(columns, 40, 100));
}

int printed(const std::string& text) {
  run::print(text);
  return run::exit_code::ok;
}

}  // namespace

void format_help(CLI::App& app) {
  app.formatter_fn([](const CLI::App* one, const std::string&, CLI::AppFormatMode) {
    std::string above;
    for (const CLI::App* parent = one->get_parent(); parent; parent = parent->get_parent())
      above.insert(0, parent->get_name() + (above.empty() ? "" : " "));
    return usage::help_text(usage::usage_of(*one, above), help_width());
  });
}

int man_command(const CLI::App& app) {
  return printed(usage::man_page(usage::usage_of(app), {FIELDPROOF_VERSION, FIELDPROOF_RELEASED}));
}

int completion_command(const CLI::App& app, const std::string& shell) {
  return printed(usage::completion_script(shell, app.get_name()));
}

int complete_command(const CLI::App& app, const std::vector<std::string>& words,
                     const harness::Protocols& protocols) {
  return printed(
      usage::to_string(usage::complete(usage::usage_of(app), words, completion_values(protocols))));
}

}  // namespace fieldproof::cli
