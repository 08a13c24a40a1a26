#include "harness/cli/questions.hpp"

#include "harness/run/run_report.hpp"

#include <fmt/format.h>

#include <iostream>

namespace fieldproof::cli {

Result<std::string> Questions::answer(const Question& question, const std::string& given) const {
  if (!given.empty()) return given;
  const bool has_usual = !question.usual.empty() || question.may_be_empty;
  if (!ask_ && has_usual) return question.usual;
  if (!ask_)
    return fail(
        fmt::format("cannot ask '{}' without a terminal; give {}", question.text, question.option));
  for (const std::string& hint : question.hints) run::tell(fmt::format("  {}\n", hint));
  while (true) {
    run::tell(fmt::format("{} ({}){}: ", question.text, question.option,
                          question.usual.empty() ? "" : fmt::format(" [{}]", question.usual)));
    std::string line;
    if (!std::getline(std::cin, line))
      return fail(fmt::format("no answer to '{}'; give {}", question.text, question.option));
    if (line.empty()) line = question.usual;
    if (!line.empty() || question.may_be_empty) return line;
  }
}

}  // namespace fieldproof::cli
