// A bench for tests, whose device is scripted.
#pragma once

#include <gmock/gmock.h>
#include <unistd.h>

#include <deque>
#include <filesystem>

#include "harness/bench/bench.hpp"
#include "harness/exchange/scripted_endpoint.hpp"
#include "harness/test_protocol.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::bench::test {

using Pieces = std::vector<exchange::ScriptedEndpoint::Piece>;

class ScriptedBench : public testing::Test {
 protected:
  ScriptedBench() {
    options.profile.name = "test";
    options.profile.model = "xbc-h";
    options.profile.protocols = {"xgt-cnet"};
    endpoint.answers["<probe>"] = Pieces{{1ms, "<alive>"}};
    endpoint.answers["<ask>"] = Pieces{{1ms, "<answer>"}};
    options.device.endpoint = "serial:/dev/scripted";
    const std::string path =
        testing::TempDir() + "fieldproof_bench_test_" + std::to_string(::getpid()) + ".ndjson";
    Result<safety::Journal> journal = safety::Journal::open(path);
    options.journal = std::make_shared<safety::Journal>(std::move(*journal));
    std::filesystem::remove(path);  // the open file stays
  }

  static std::string vector(const std::string& steps, const std::string& more = "") {
    return R"j({"id": "xgt_cnet/a/b", "rev": 1, "title": "what is tested", "level": "must", "basis": "printed rule", )j" +
           more +
           R"j("statement": "m/1", "source": {"manual": "m", "section": "1", "quote": "as printed"}, "steps": [)j" +
           steps + "]}";
  }
  static std::string ask() { return R"({"send": "'<ask>'"}, {"expect": "'<answer>'"})"; }

  results::CaseResult run(const std::string& text) {
    vectors::VectorSet& set = sets_.emplace_back();
    vectors::load_vector_text(text, "f.json", set);
    EXPECT_THAT(set.problems, testing::IsEmpty());
    if (!bench_) bench_.emplace(endpoint, protocol_, options);
    return bench_->run(set.cases.at(0));
  }
  Bench& bench() {
    if (!bench_) bench_.emplace(endpoint, protocol_, options);
    return *bench_;
  }
  void on_real_device() {
    endpoint.can = {};
    endpoint.can.wire = true;
    endpoint.can.real_device = true;
  }

  exchange::ScriptedEndpoint endpoint;
  BenchOptions options;

 private:
  harness::TestProtocol protocol_;
  std::deque<vectors::VectorSet> sets_;  // cases outlive the bench
  std::optional<Bench> bench_;
};

}  // namespace fieldproof::bench::test
