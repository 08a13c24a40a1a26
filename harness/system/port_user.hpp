// Who has a port open, for the message that says it is in use.
#pragma once

#include <string>

namespace fieldproof::os {

/// " by process 1234 (minicom)" for a process that holds the lock (flock) of `path`, or else has it
/// open; empty when /proc does not tell (another user's process).
std::string port_user(const std::string& path);

/// The same for a process other than this one that has `path` open, as root or its owner may: each
/// of them takes bytes that the other waits for.
std::string other_port_user(const std::string& path);

/// "process 1234 (minicom)"
std::string process_name(const std::string& process);

}  // namespace fieldproof::os
