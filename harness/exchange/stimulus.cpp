#include "harness/exchange/stimulus.hpp"

#include <cerrno>

#include "harness/system/line_pipe.hpp"

namespace fieldproof::exchange {

Result<std::unique_ptr<Stimulus>> Stimulus::start(const std::string& command) {
  Result<os::LinePipe> pipe = os::open_line_pipe();
  if (!pipe) return pipe.error();
  os::ChildOptions options;
  options.arguments = os::shell(command);
  options.standard_input = pipe->child.get();
  Result<std::unique_ptr<os::ChildProcess>> child = os::ChildProcess::start(options);
  if (!child) return fail("cannot start --stimulus '" + command + "': " + child.error().message);
  auto stimulus = std::make_unique<Stimulus>();
  stimulus->command_ = command;
  stimulus->child_ = std::move(*child);
  stimulus->input_ = std::move(pipe->bench);
  return stimulus;
}

Status Stimulus::tell(const std::string& line) {
  if (os::write_line(input_.get(), line)) return ok();
  return fail("cannot tell --stimulus '" + command_ + "' what to request: " + child_->how());
}

}  // namespace fieldproof::exchange
