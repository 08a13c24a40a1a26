// One case for a benchmark: exchanged again and again, and judged each time.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "harness/bench/bench.hpp"
#include "harness/vectors/loader.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::suites {

/// Ready for the first exchange.
inline std::unique_ptr<endpoints::Endpoint> open(const std::string& text,
                                                 const harness::Protocol& protocol) {
  Result<std::unique_ptr<endpoints::Endpoint>> endpoint =
      endpoints::open_endpoint(*endpoints::parse_endpoint(text), protocol);
  if (!endpoint) throw std::runtime_error(endpoint.error().message);
  if (!(*endpoint)->begin(nlohmann::json::object())) throw std::runtime_error("cannot begin");
  return std::move(*endpoint);
}

struct Example {
  vectors::VectorSet set;
  exchange::PreparedCase prepared;

  /// `steps` in JSON, separated by commas.
  Example(const std::string& steps, const harness::Protocol& protocol) : protocol_(&protocol) {
    vectors::load_vector_text(
        R"([{"id": ")" + vectors::folder_of(protocol) +
            R"(/bench/example", "title": "an example", "level": "must", "basis": "printed rule",
             "statement": "m/1", "source": {"manual": "m", "section": "1", "quote": "as printed"},
             "steps": [)" +
            steps + "]}]",
        "bench", set, {protocols()});
    if (!set.problems.empty()) throw std::runtime_error(set.problems.front());
    prepared = *exchange::prepare(set.cases.at(0), 1, protocol);
  }

  void judge(const exchange::Transcript& transcript) const {
    const judging::Judgement judgement = judging::judge(prepared, transcript, {}, *protocol_);
    if (judgement.verdict != results::Verdict::pass) throw std::runtime_error(judgement.message);
  }

 private:
  const harness::Protocol* protocol_;
};

}  // namespace fieldproof::suites
