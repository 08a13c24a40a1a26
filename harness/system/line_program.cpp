#include "harness/system/line_program.hpp"

#include "harness/system/line_pipe.hpp"

namespace fieldproof::os {

Result<std::unique_ptr<LineProgram>> LineProgram::start(const std::string& option,
                                                        const std::string& command) {
  auto program = std::make_unique<LineProgram>();
  program->name_ = option + " '" + command + "'";
  program->command_ = command;
  if (const Status started = program->restart(); !started) return started.error();
  return program;
}

Status LineProgram::restart() {
  Result<LinePipe> pipe = open_line_pipe();
  if (!pipe) return pipe.error();
  ChildOptions options;
  options.arguments = shell(command_);
  options.standard_input = pipe->child.get();
  Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start(options);
  if (!child) return fail("cannot start " + name_ + ": " + child.error().message);
  input_ = std::move(pipe->bench);
  child_ = std::move(*child);
  return ok();
}

Status LineProgram::tell(const std::string& line) {
  if (write_line(input_.get(), line)) return ok();
  return fail("cannot tell " + name_ + " anything: " + child_->how());
}

}  // namespace fieldproof::os
