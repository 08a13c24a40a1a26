// One case for a benchmark: exchanged again and again, and judged each time.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "harness/bench/bench.hpp"
#include "harness/vectors/loader.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::suites {

/// Its value; a benchmark ends at an error.
template <typename T>
T value_of(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

/// Ready for the first exchange.
inline std::unique_ptr<endpoints::Endpoint> open(const std::string& text,
                                                 const harness::Protocol& protocol) {
  std::unique_ptr<endpoints::Endpoint> endpoint =
      value_of(endpoints::open_endpoint(*endpoints::parse_endpoint(text), protocol));
  if (!endpoint->begin(nlohmann::json::object())) throw std::runtime_error("cannot begin");
  return endpoint;
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
