// Questions of `init`: each has an option that answers it, and is asked on a terminal alone.
#pragma once

#include <string>
#include <vector>

#include "src/base/result.hpp"

namespace fieldproof::cli {

class Questions {
 public:
  /// `ask`: there is somebody to ask.
  explicit Questions(bool ask) : ask_(ask) {}

  struct Question {
    std::string option;                   // "--endpoint", that answers it, too
    std::string text;                     // "Where is the device?"
    std::vector<std::string> hints = {};  // a line each
    std::string usual = {};               // what an empty line stands for
    bool may_be_empty = false;
  };
  /// `given` by the option, else by the user, else the usual. Errors: nobody can be asked and
  /// nothing is usual; or the end of the input.
  Result<std::string> answer(const Question& question, const std::string& given) const;

 private:
  bool ask_;
};

}  // namespace fieldproof::cli
