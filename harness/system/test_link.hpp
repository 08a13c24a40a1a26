// What tests of links share: waiting for text, or for an error.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "harness/system/fd_link.hpp"

namespace fieldproof::os::test {

/// Collects from an Endpoint or an FdLink until `wanted` has come, or 5 s are over, or an error,
/// which is returned.
template <typename Link>
std::string receive_text(Link& link, const std::string& wanted) {
  std::string text;
  const Time deadline = link.now() + 5s;
  while (text.find(wanted) == std::string::npos) {
    const Result<Burst> burst = link.receive(deadline);
    if (!burst) return text + '!' + burst.error().message;
    if (burst->bytes.empty()) return text + "!time-out";
    text += to_text(burst->bytes);
  }
  return text;
}

/// Waits for the error of `receive`.
template <typename Link>
Error receive_error(Link& link) {
  const Time deadline = link.now() + 5s;
  while (link.now() < deadline) {
    if (const Result<Burst> burst = link.receive(deadline); !burst) return burst.error();
  }
  return fail("no error came");
}

}  // namespace fieldproof::os::test
