// The outcome of work that may fail as part of the job (I/O, parsing).
// Programmer errors and broken start-up files are exceptions instead.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace fieldproof {

struct Error {
  /// Verb, object, cause and what to do: "cannot open /dev/ttyUSB0: permission denied; add yourself
  /// to the group dialout"
  std::string message;
  /// The user pressed Ctrl-C.
  bool interrupted = false;
  /// The hardware is not there (`run --skip-absent`).
  bool absent = false;
  /// The other side says no, or cannot do it; nothing is wrong with the way to it.
  bool refused = false;
};

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}
  Result(Error error) : state_(std::move(error)) {}

  explicit operator bool() const { return std::holds_alternative<T>(state_); }
  T& operator*() { return std::get<T>(state_); }
  const T& operator*() const { return std::get<T>(state_); }
  T* operator->() { return &std::get<T>(state_); }
  const T* operator->() const { return &std::get<T>(state_); }
  const Error& error() const { return std::get<Error>(state_); }

 private:
  std::variant<T, Error> state_;
};

/// Success without a value: `return ok();`
using Status = Result<std::monostate>;
inline Status ok() { return Status(std::monostate{}); }
inline Error fail(std::string message) { return Error{std::move(message)}; }
inline Error refuse(std::string message) { return Error{std::move(message), false, false, true}; }

}  // namespace fieldproof
