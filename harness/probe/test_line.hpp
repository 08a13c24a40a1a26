// Lines for the tests of the search: an emulated device whose settings the search does not know,
// and what can be wrong with the wiring between.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "harness/endpoints/emulator.hpp"
#include "harness/probe/conclusion.hpp"
#include "src/line/faults.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::probe::test {

inline const harness::Protocol& protocol_named(std::string_view name) {
  return *suites::protocols().find(name);
}

/// The device that is searched.
struct Hidden {
  std::string protocol = "xgt-cnet", model = "xbc-h";
  nlohmann::json config{{"station", 1}, {"line", "9600-8N1"}};
  endpoints::Decorator decorate{};
};

inline LineOpener opener(const Hidden& hidden) {
  return [hidden](const line::LineSettings& bench) -> Result<std::unique_ptr<endpoints::Endpoint>> {
    const harness::Protocol* protocol = suites::protocols().find(hidden.protocol);
    auto endpoint = std::make_unique<endpoints::EmulatorEndpoint>(
        endpoints::EndpointName{"emulator", hidden.model, {}},
        [protocol](std::string_view model, const nlohmann::json& config) {
          return protocol->make_device(model, config);
        },
        hidden.decorate);
    nlohmann::json config = hidden.config;
    config["bench_line"] = line::to_string(bench);
    if (const Status begun = endpoint->begin(config); !begun) return begun.error();
    return std::unique_ptr<endpoints::Endpoint>(std::move(endpoint));
  };
}

/// Puts line faults between the line and the device.
inline endpoints::Decorator with_faults(const line::LineFaults& faults) {
  return [faults](line::Device& device, const line::LineSettings& line) {
    return std::make_unique<line::FaultyDevice>(device, faults, line.character_time());
  };
}

/// Between the bench and its endpoint: what happens on the way.
class Wire : public endpoints::Endpoint {
 public:
  explicit Wire(std::unique_ptr<endpoints::Endpoint> inner) : inner_(std::move(inner)) {}

  const endpoints::Capabilities& capabilities() const override { return inner_->capabilities(); }
  std::string describe() const override { return inner_->describe(); }
  Time now() const override { return inner_->now(); }
  Duration character_time() const override { return inner_->character_time(); }
  Status begin(const nlohmann::json& config) override { return inner_->begin(config); }
  using endpoints::Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId) override { return inner_->send(bytes); }
  Result<Burst> receive(Time deadline) override { return inner_->receive(deadline); }
  std::string line_errors() override { return inner_->line_errors(); }

 protected:
  std::unique_ptr<endpoints::Endpoint> inner_;
};

template <typename OneWire, typename... Arguments>
LineOpener behind(LineOpener inner, Arguments... arguments) {
  return [=](const line::LineSettings& line) -> Result<std::unique_ptr<endpoints::Endpoint>> {
    Result<std::unique_ptr<endpoints::Endpoint>> opened = inner(line);
    if (!opened) return opened;
    return std::unique_ptr<endpoints::Endpoint>(
        std::make_unique<OneWire>(std::move(*opened), line, arguments...));
  };
}

inline Search run_search(const LineOpener& open, const SearchSpace& space = {}, bool all = false) {
  Prober prober(open, suites::protocols(), {}, [](std::size_t, std::size_t, const Observation&) {});
  Result<Search> search = prober.run(make_plan(space, suites::protocols()), all);
  return search ? *search : Search{};
}

inline std::vector<Finding> find(const LineOpener& open, const SearchSpace& space = {}) {
  return conclude(run_search(open, space), {});
}

inline std::vector<Finding::Kind> kinds(const std::vector<Finding>& findings) {
  std::vector<Finding::Kind> result;
  for (const Finding& one : findings) result.push_back(one.kind);
  return result;
}

/// One speed, one frame, stations 0 to 3: enough where the search is not what is tested.
inline SearchSpace small_space() {
  return {
      .speeds = {9600}, .frames = {line::LineSettings{}}, .stations = {1, 2, 3}, .protocols = {}};
}

}  // namespace fieldproof::probe::test
