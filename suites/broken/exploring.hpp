// `explore` against one device in this process, as long as it finds nothing.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/explore/explorer.hpp"
#include "harness/explore/server_sequences.hpp"

namespace fieldproof::broken {

class Exploring {
 public:
  using Run = std::function<results::CaseResult(const vectors::Case&)>;

  /// On the first model of `protocol`, by what `cases` ask it; nothing: there is nothing to ask.
  static std::optional<Exploring> of(const harness::Protocol& protocol,
                                     const std::vector<vectors::Case>& cases) {
    std::string model = protocol.models().front();
    const auto configured = protocol.configured(model, nlohmann::json::object());
    if (!configured) return std::nullopt;
    std::vector<explore::Request> requests = explore::requests_of(cases, protocol, model);
    if (requests.empty()) return std::nullopt;
    return Exploring(protocol, std::move(model), std::move(requests));
  }

  /// Does a device that `run` runs cases on differ from our model within `most` requests?
  bool finds(const Run& run, std::uint64_t most) const {
    Result<explore::Oracle> oracle = explore::Oracle::open(*protocol_, model_, 1);
    if (!oracle) return false;
    const auto configured = protocol_->configured(model_, nlohmann::json::object());
    const harness::Protocol& own = *configured ? **configured : *protocol_;
    explore::Explorer explorer(
        {&own, run}, std::make_unique<explore::ServerSequences>(explore::Server{.protocol = &own},
                                                                std::move(*oracle), requests_, 1));
    while (explorer.requests_sent() < most && explorer.findings().empty()) explorer.step();
    return !explorer.findings().empty();
  }

 private:
  Exploring(const harness::Protocol& protocol, std::string model,
            std::vector<explore::Request> requests)
      : protocol_(&protocol), model_(std::move(model)), requests_(std::move(requests)) {}

  const harness::Protocol* protocol_;
  std::string model_;
  std::vector<explore::Request> requests_;
};

}  // namespace fieldproof::broken
