// Over any bad line memory is what it was after a run and its restoration, or the tool says which
// words it could not put back. Seeded: a run is named by its number.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "harness/bench/bench.hpp"
#include "harness/vectors/loader.hpp"
#include "suites/noise/noisy_endpoint.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::noise {
namespace {

using Memory = std::map<std::string, std::string>;

struct Setup {
  const char* protocol;
  const char* model;
  const char* filter;  // cases that write
  std::vector<std::string> areas;
  const char* allowed;
  bool damages;  // a network has checks of its own: there answers are late, and links are cut
};

void PrintTo(const Setup& one, std::ostream* out) { *out << one.protocol; }

/// Journals stay in memory: what is on a disk is another test.
std::string journal_path() {
  const bool fast = std::filesystem::is_directory("/dev/shm");
  return fmt::format("{}/fieldproof_noise_{}.ndjson",
                     fast ? "/dev/shm" : std::filesystem::temp_directory_path().string(),
                     ::getpid());
}

class NoisyLine : public testing::TestWithParam<Setup> {
 protected:
  static constexpr int words = 128;

  NoisyLine() : protocol_(*suites::protocols().find(GetParam().protocol)) {
    vectors::VectorSet all = vectors::load_vectors(FIELDPROOF_SOURCE_DIR "/vectors",
                                                   {suites::protocols(), GetParam().filter});
    for (vectors::Case& one : all.cases)
      if (writes(one)) cases_.push_back(std::move(one));
    endpoints::EndpointName name;
    name.kind = "emulator";
    name.target = GetParam().model;
    configured_ = std::move(*protocol_.configured(GetParam().model, nlohmann::json::object()));
    device_ = std::move(*endpoints::open_emulator(name, protocol_));
  }
  ~NoisyLine() override { std::filesystem::remove(journal_path()); }

  const harness::Protocol& protocol() const { return configured_ ? *configured_ : protocol_; }

  Result<exchange::PreparedCase> prepare(const vectors::Case& one) const {
    return exchange::prepare(one, 1, protocol_, {suites::protocols(), {}});
  }

  /// By a frame of its own, not by what it is given: it may do so without a check (upper case).
  bool writes(const vectors::Case& one) const {
    const Result<exchange::PreparedCase> prepared = prepare(one);
    return prepared && !prepared->is_client() &&
           one.config.size() == one.config.count("station") + one.config.count("write_order") &&
           std::ranges::any_of(prepared->steps, [&](const exchange::PreparedStep& step) {
             return step.step->kind == vectors::Step::Kind::send &&
                    !protocol_.written_by(step.frames.front().frame.bytes).empty();
           });
  }

  std::string address(const std::string& area, int word) const {
    return area == "h" ? hex_number(0x1200 + static_cast<unsigned>(word), 4)
                       : fmt::format("%{}W{}", area, word);
  }
  Memory memory() const {
    Memory all;
    for (const std::string& area : GetParam().areas)
      for (int i = 0; i < words; ++i)
        if (const Result<std::string> held = device_->get(address(area, i), 4))
          all[address(area, i)] = *held;
    return all;
  }
  void fill(std::mt19937_64& random) {
    EXPECT_TRUE(device_->begin({{"station", 1}, {"model", GetParam().model}}));
    for (const std::string& area : GetParam().areas)
      for (int i = 0; i < words; ++i)
        [[maybe_unused]] const Status set =
            device_->set(address(area, i), hex_number(random() & 0xFFFF, 4));
  }

  Badness badness(std::mt19937_64& random) const {
    Badness bad;
    if (GetParam().damages) bad.replies = random() % 20;
    if (GetParam().damages) bad.requests = random() % 20;
    bad.late = random() % 10;
    bad.lateness = 900ms;
    if (random() % 4 == 0) bad.cut_after = static_cast<int>(random() % 40);
    return bad;
  }

  bench::BenchOptions options(std::shared_ptr<safety::Journal> journal) const {
    bench::BenchOptions options;
    options.profile.name = "noise";
    options.profile.model = GetParam().model;
    options.profile.protocols = {GetParam().protocol};
    options.profile.config = {{"write_order", "address_first"}};
    options.known = suites::protocols();
    options.device = {"serial:/dev/noise", 1, GetParam().protocol, GetParam().model,
                      nlohmann::json::object()};
    options.journal = std::move(journal);
    EXPECT_TRUE(options.fence.allow(GetParam().allowed, [](std::string_view text) {
      return suites::protocols().read_word(text);
    }));
    return options;
  }

  /// What is written without a check can go anywhere when its request is damaged: the tool sees
  /// that the line is bad by the first answer that it reads again, and not before.
  bool is_checked(const vectors::Case& one) const {
    const Result<exchange::PreparedCase> prepared = prepare(one);
    return std::ranges::all_of(prepared->steps, [&](const exchange::PreparedStep& step) {
      return step.step->kind != vectors::Step::Kind::send || protocol_.default_port() != 0 ||
             protocol_.memory()->is_checked(step.frames.front().frame.bytes);
    });
  }

  const harness::Protocol& protocol_;
  std::unique_ptr<harness::Protocol> configured_;
  std::vector<vectors::Case> cases_;
  std::unique_ptr<endpoints::Endpoint> device_;
};

/// FIELDPROOF_NOISE_RUNS=1000 looks longer.
int runs() {
  const char* text = std::getenv("FIELDPROOF_NOISE_RUNS");
  return text ? std::atoi(text) : 200;
}

TEST_P(NoisyLine, LeavesTheMemoryAsItWasOrSaysWhatItIsNot) {
  ASSERT_GT(cases_.size(), 10u);
  std::map<results::Verdict, int> verdicts;
  int left_open = 0, said = 0;
  for (int run = 0; run < runs(); ++run) {
    SCOPED_TRACE(fmt::format("run {}", run));
    std::mt19937_64 random(static_cast<std::uint64_t>(run));
    fill(random);
    const Memory before = memory();
    Badness bad = badness(random);
    std::vector<const vectors::Case*> chosen;
    for (int i = 0; i < 2; ++i) chosen.push_back(&cases_[random() % cases_.size()]);
    if (!std::ranges::all_of(chosen, [&](const auto* one) { return is_checked(*one); }))
      bad.requests = 0;
    NoisyEndpoint line(*device_, bad, random());
    std::filesystem::remove(journal_path());
    Result<safety::Journal> opened = safety::Journal::open(journal_path());
    ASSERT_TRUE(opened) << opened.error().message;
    const auto journal = std::make_shared<safety::Journal>(std::move(*opened));
    {
      bench::Bench bench(line, protocol(), options(journal));
      for (const vectors::Case* one : chosen) ++verdicts[bench.run(*one).verdict];
      [[maybe_unused]] const std::string open = bench.put_back();
    }
    left_open += !journal->open_entries().empty();
    // `fieldproof restore`: with the cable plugged in again, over the same bad line.
    bad.cut_after = -1;
    NoisyEndpoint again(*device_, bad, random());
    safety::SavedMemory restore(again, protocol(), 500ms, options(journal).device, journal);
    const std::string problem = restore.restore();
    std::string changed;
    for (const auto& [address, held] : memory())
      if (before.at(address) != held)
        changed += fmt::format(" {}: {} was {}", address, held, before.at(address));
    if (!problem.empty()) {
      ++said;
      EXPECT_NE(restore.open_places(), "");
      continue;
    }
    ASSERT_EQ(changed, "") << chosen[0]->id << " " << chosen[1]->id;
  }
  fmt::print(
      "{}: {} runs, {} with something to restore, {} in which it was said that it could not "
      "be; {} PASS, {} FAIL, {} BLOCKED, {} ERROR\n",
      GetParam().protocol, runs(), left_open, said, verdicts[results::Verdict::pass],
      verdicts[results::Verdict::fail], verdicts[results::Verdict::blocked],
      verdicts[results::Verdict::error]);
  EXPECT_GT(verdicts[results::Verdict::pass], runs() / 4) << "most lines let the cases through";
  EXPECT_GT(left_open, runs() / 100) << "links were cut in the midst of writing";
  EXPECT_LT(said, runs() / 20);
}

const Setup setups[] = {
    {"xgt-cnet",
     "xbc-h",
     "xgt_cnet/w*:xgt_cnet/errors/*:xgt_cnet/data_types/*",
     {"M", "D", "P"},
     "all,P,Q,U",
     true},
    {"modbus-rtu", "xbc-h", "modbus_rtu/*", {"M", "P"}, "all,P", true},
    {"modbus-ascii", "xbc-h", "modbus_ascii/*", {"M", "P"}, "all,P", true},
    {"modbus-tcp", "xbc-h", "modbus_tcp/*", {"M", "P"}, "all,P", false},
    {"ls-bus", "inverter", "ls_bus/*", {"h"}, "h", true},
};

INSTANTIATE_TEST_SUITE_P(Over, NoisyLine, testing::ValuesIn(setups), [](const auto& one) {
  std::string name = one.param.protocol;
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace fieldproof::noise
