// The built tool and a server on a network: an emulator in another process, runs against it, and
// what such a run may leave out.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "harness/system/sockets/test_sockets.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {

/// That nobody listens on, a moment ago.
inline std::uint16_t free_port(int type = SOCK_STREAM) {
  return os::test::port_of(os::test::bound(type));
}

/// `emulate` of an xbc-h in a process of its own.
class EmulatedServer {
 public:
  explicit EmulatedServer(std::string protocol, const std::vector<std::string>& more = {})
      : protocol_(std::move(protocol)), port_(free_port()) {
    std::vector<std::string> arguments{"emulate", "xbc-h?protocol=" + protocol_, "--tcp",
                                       std::to_string(port_)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    process_.emplace(tool_arguments(arguments));
    EXPECT_TRUE(process_->wait_for("tcp 127.0.0.1:" + std::to_string(port_)));
  }
  std::string endpoint() const {
    return "tcp:127.0.0.1:" + std::to_string(port_) + "?protocol=" + protocol_;
  }
  std::uint16_t port() const { return port_; }
  Process& process() { return *process_; }

 private:
  std::string protocol_;
  std::uint16_t port_;
  std::optional<Process> process_;
};

inline Finished run_on(const TestFolder& folder, const std::string& endpoint,
                       const std::string& out, const std::string& filter,
                       const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"run",        "--endpoint",    endpoint,   "--profile",
                                     "xbc-h",      "--filter",      filter,     "--out",
                                     folder / out, "--allow-write", "all,P,Q,U"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_tool(arguments);
}

/// Why a case cannot be run where there is no back door: ids that begin so, and the reason that the
/// report gives.
struct NotThere {
  std::string ids, reason;
};

/// All other cases have the verdict that they have in process, each reason is given, and more than
/// `enough` pass.
inline void expect_same_verdicts(const Results& in_process, const Results& over_sockets,
                                 const std::vector<NotThere>& reasons, std::size_t enough) {
  // Those of one start of the device are together.
  const auto sorted = [](std::vector<std::string> ids) {
    std::ranges::sort(ids);
    return ids;
  };
  ASSERT_EQ(sorted(in_process.ids()), sorted(over_sockets.ids()));
  std::vector<int> used(reasons.size());
  std::size_t judged = 0;
  for (const nlohmann::json& one : over_sockets.cases) {
    const std::string id = one.at("id");
    if (one.at("verdict") != "BLOCKED") {
      EXPECT_EQ(one.at("verdict"), in_process.verdict(id))
          << id << ": " << one.value("message", "");
      judged += one.at("verdict") == "PASS";
      continue;
    }
    const std::string message = one.at("message");
    const auto why = std::ranges::find_if(reasons, [&](const NotThere& reason) {
      return id.starts_with(reason.ids) && message.find(reason.reason) != std::string::npos;
    });
    EXPECT_NE(why, reasons.end()) << id << ": " << message;
    if (why != reasons.end()) ++used[static_cast<std::size_t>(why - reasons.begin())];
  }
  for (std::size_t i = 0; i < reasons.size(); ++i)
    EXPECT_GT(used[i], 0) << reasons[i].ids << ": " << reasons[i].reason;
  EXPECT_GT(judged, enough);
}

}  // namespace fieldproof::tool_tests
