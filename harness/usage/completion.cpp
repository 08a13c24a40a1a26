#include "harness/usage/completion.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace fieldproof::usage {

namespace {

class Completion {
 public:
  Completion(const Command& tool, const Values& values) : command_(&tool), values_(values) {}

  /// A word in front of the last one.
  void pass(const std::string& word) {
    if (const Option* awaited = std::exchange(awaited_, nullptr);
        awaited && !awaited->value.empty())
      return;
    if (word.starts_with("-")) {
      awaited_ = command_->option(word);
    } else if (const Command* command = command_->command(word)) {
      command_ = command;
    } else {
      ++positionals_;
    }
  }

  std::vector<Candidate> last(const std::string& word) {
    if (awaited_ && !awaited_->value.empty()) return values_of(*awaited_, "", word);
    const std::size_t equals = word.find('=');
    if (word.starts_with("--") && equals != std::string::npos) {
      const Option* option = command_->option(word.substr(0, equals));
      return option ? values_of(*option, word.substr(0, equals + 1), word.substr(equals + 1))
                    : std::vector<Candidate>{};
    }
    if (word.starts_with("-")) return options(word);
    std::vector<Candidate> found;
    for (const Command& one : command_->commands)
      add(found, one.name.substr(one.name.rfind(' ') + 1), one.description, word);
    const std::vector<const Option*> positionals = command_->positionals();
    if (!positionals.empty())
      for (Candidate& one :
           values_of(*positionals[std::min(positionals_, positionals.size() - 1)], "", word))
        found.push_back(std::move(one));
    return found;
  }

 private:
  static void add(std::vector<Candidate>& found, const std::string& word,
                  const std::string& description, const std::string& beginning) {
    if (word.starts_with(beginning)) found.push_back({word, description});
  }

  std::vector<Candidate> options(const std::string& beginning) const {
    std::vector<Candidate> found;
    for (const Option& one : command_->options)
      if (!one.positional)
        for (const std::string& name : one.names)
          if (name.size() > 2) add(found, name, one.description, beginning);
    return found;
  }

  std::vector<Candidate> values_of(const Option& option, const std::string& before,
                                   const std::string& beginning) const {
    std::vector<Candidate> found;
    for (const std::string& one :
         option.choices.empty() ? values_(*command_, option, beginning) : option.choices)
      if (one.starts_with(beginning)) found.push_back({before + one, ""});
    return found;
  }

  const Command* command_;
  const Values& values_;
  const Option* awaited_ = nullptr;  // its value comes next
  std::size_t positionals_ = 0;
};

}  // namespace

std::vector<Candidate> complete(const Command& tool, const std::vector<std::string>& words,
                                const Values& values) {
  if (words.empty()) return {};
  Completion completion(tool, values);
  for (std::size_t i = 0; i + 1 < words.size(); ++i) completion.pass(words[i]);
  return completion.last(words.back());
}

std::string to_string(const std::vector<Candidate>& candidates) {
  std::string text;
  for (const Candidate& one : candidates)
    text += one.word + (one.description.empty() ? "" : '\t' + one.description) + '\n';
  return text;
}

}  // namespace fieldproof::usage
