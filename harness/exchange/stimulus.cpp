#include "harness/exchange/stimulus.hpp"

#include <cerrno>

#include "harness/system/line_pipe.hpp"

namespace fieldproof::exchange {

Result<std::unique_ptr<Stimulus>> Stimulus::start(const std::string& command) {
  auto stimulus = std::make_unique<Stimulus>();
  stimulus->command_ = command;
  if (const Status started = stimulus->restart(); !started) return started.error();
  return stimulus;
}

Status Stimulus::restart() {
  Result<os::LinePipe> pipe = os::open_line_pipe();
  if (!pipe) return pipe.error();
  os::ChildOptions options;
  options.arguments = os::shell(command_);
  options.standard_input = pipe->child.get();
  Result<std::unique_ptr<os::ChildProcess>> child = os::ChildProcess::start(options);
  if (!child) return fail("cannot start --stimulus '" + command_ + "': " + child.error().message);
  input_ = std::move(pipe->bench);
  child_ = std::move(*child);
  return ok();
}

Status Stimulus::tell(const std::string& line) {
  if (os::write_line(input_.get(), line)) return ok();
  return fail("cannot tell --stimulus '" + command_ + "' what to request: " + child_->how());
}

}  // namespace fieldproof::exchange
