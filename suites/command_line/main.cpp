#include <fmt/format.h>

#include <exception>

#include "harness/run/exit_code.hpp"
#include "harness/run/run_report.hpp"
#include "suites/command_line/command_line.hpp"

int main(int argc, char** argv) {
  using namespace fieldproof;
  try {
    return suites::with_command(argc, argv, [](const suites::Command& run) { return run(); });
  } catch (const std::exception& error) {
    return run::complain(
        fmt::format("internal error: {}; please report it with the command line", error.what()),
        run::exit_code::trouble);
  }
}
