#include "harness/exchange/stimulus.hpp"

#include <cerrno>

#include "harness/system/line_pipe.hpp"

namespace fieldproof {

Result<std::unique_ptr<Stimulus>> Stimulus::start(const std::string& command) {
  Result<LinePipe> pipe = open_line_pipe();
  if (!pipe) return pipe.error();
  ChildOptions options;
  options.arguments = shell(command);
  options.standard_input = pipe->child.get();
  Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start(options);
  if (!child) return fail("cannot start --stimulus '" + command + "': " + child.error().message);
  auto stimulus = std::make_unique<Stimulus>();
  stimulus->command_ = command;
  stimulus->child_ = std::move(*child);
  stimulus->input_ = std::move(pipe->bench);
  return stimulus;
}

Status Stimulus::tell(const std::string& line) {
  if (write_line(input_.get(), line)) return ok();
  return fail("cannot tell --stimulus '" + command_ + "' what to request: " + child_->how());
}

}  // namespace fieldproof
