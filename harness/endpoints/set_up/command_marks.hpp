// What the command of exec: is told of a configuration: {station}, {delay_ms}, {config}.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "src/base/result.hpp"

namespace fieldproof::endpoints {

/// A value of a configuration as text: 10 and "10" are the same.
std::string plain(const nlohmann::json& value);

/// A command with marks. A mark is a key of `given.config` (vectors/README.md), `model`,
/// `protocol`, `bases` (the four of Modbus: bit read, bit write, word read, word write) or `config`
/// (all of it, as JSON) in braces. `${station}` is the shell's.
class CommandMarks {
 public:
  /// Errors name a mark that is nearly one.
  static Status check(std::string_view command);

  explicit CommandMarks(std::string command) : command_(std::move(command)) {}

  /// Does the command take this key of `given.config`?
  bool takes(std::string_view key) const;
  /// The command with what stands in `config` for each mark, as a word of the shell; what does not
  /// stand there is an empty word.
  std::string filled(const nlohmann::json& config) const;
  const std::string& text() const { return command_; }

 private:
  std::string command_;
};

}  // namespace fieldproof::endpoints
