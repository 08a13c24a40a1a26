#include "suites/tool/readme_commands.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace fieldproof::tool_tests {
namespace {

constexpr std::array<std::string_view, 9> programs{"./run.sh",   "./test.sh", "./fuzz.sh",
                                                   "fieldproof", "cpack",     "cmake",
                                                   "socat",      "srun",      "sbatch"};

bool is_command(std::string_view text) {
  const std::string_view program = text.substr(0, text.find(' '));
  return std::ranges::find(programs, program) != programs.end();
}

void drop_blanks(std::string& text) {
  text.erase(0, text.find_first_not_of(' '));
  text.erase(text.find_last_not_of(' ') + 1);
}

/// Without what leads to the command on this line, and what follows it.
std::optional<std::string> command_in(std::string line) {
  drop_blanks(line);
  for (std::string_view before : {"$ ", "replay ", "script: ", "- run: "})
    if (line.starts_with(before)) line.erase(0, before.size());
  if (const std::size_t step = line.find("sh './"); step != std::string::npos)  // of Jenkins
    line = line.substr(step + 4, line.rfind('\'') - step - 4);
  line.erase(std::min(line.find("  # "), line.size()));
  drop_blanks(line);
  return is_command(line) ? std::optional(line) : std::nullopt;
}

/// Between its first bars.
std::string first_cell(const std::string& row) { return row.substr(1, row.find('|', 1) - 1); }

class Reader {
 public:
  void read(std::string line) {
    if (line.starts_with("```")) {
      in_block_ = !in_block_;
    } else if (in_block_) {
      read_code(std::move(line));
    } else {
      in_table_ = line.starts_with("|") && (in_table_ || first_cell(line) == " command ");
      read_prose(in_table_ ? first_cell(line) : line);
    }
  }

  std::vector<std::string> take() { return std::move(commands_); }

 private:
  void read_code(std::string line) {
    drop_blanks(line);
    const bool goes_on = line.ends_with(" \\");
    if (goes_on) line.pop_back();
    begun_ += line;
    if (goes_on) return;
    if (const auto command = command_in(std::exchange(begun_, ""))) add(*command);
  }

  void read_prose(const std::string& line) {
    std::size_t begin = 0;
    while ((begin = line.find('`', begin)) != std::string::npos) {
      const std::size_t end = line.find('`', begin + 1);
      if (end == std::string::npos) return;
      std::string span = line.substr(begin + 1, end - begin - 1);
      if (in_table_) span.insert(0, "fieldproof ");
      if (span.find(' ') != std::string::npos && is_command(span)) add(span);
      begin = end + 1;
    }
  }

  void add(const std::string& command) {
    if (std::ranges::find(commands_, command) == commands_.end()) commands_.push_back(command);
  }

  std::vector<std::string> commands_;
  bool in_block_ = false, in_table_ = false;
  std::string begun_;  // a command that goes on in the next line
};

}  // namespace

std::vector<std::string> commands_of(const std::string& markdown) {
  Reader reader;
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);) reader.read(line);
  return reader.take();
}

}  // namespace fieldproof::tool_tests
