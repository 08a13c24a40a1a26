// Over any bad line memory is what it was after a run and its restoration, or the tool says which
// words it could not put back, or which write without a check nobody can answer for. Seeded: a
// group of runs on one device is named by its number.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "harness/bench/bench.hpp"
#include "harness/vectors/loader.hpp"
#include "src/ls_bus/parameters.hpp"
#include "src/plc/model.hpp"
#include "suites/noise/noisy_endpoint.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::noise {
namespace {

/// A run of words of the device, or a contact.
struct Block {
  std::string address;
  std::size_t digits = 0;
};

using Words = std::vector<harness::Protocol::Written>;

struct Setup {
  const char* protocol;
  const char* model;
  const char* filter;  // cases that write
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
  static constexpr int runs_of_group = 10;

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
    EXPECT_TRUE(begin());
    for (Block& block : blocks_of_model())
      if (device_->get(block.address, block.digits)) blocks_.push_back(std::move(block));
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

  Status begin() { return device_->begin({{"station", 1}, {"model", GetParam().model}}); }

  /// All that the device has; what nobody may write, too.
  static std::vector<Block> blocks_of_model() {
    std::vector<Block> blocks;
    const plc::PlcModel* model = plc::find_plc_model(GetParam().model);
    if (!model)
      for (const ls_bus::ParameterRange& range : ls_bus::inverter_ranges())
        blocks.push_back({hex_number(range.first, 4), (range.last - range.first + 1u) * 4});
    for (const plc::DeviceArea& area : model ? model->areas : std::span<const plc::DeviceArea>()) {
      blocks.push_back({fmt::format("%{}W0", area.letter), area.words * 4});
      for (std::uint32_t contact = 0; contact < area.contacts; ++contact)
        blocks.push_back({fmt::format("%{}X{}", area.letter, contact), 2});
    }
    return blocks;
  }

  /// Digits of each block.
  std::vector<std::string> memory() const {
    std::vector<std::string> all;
    for (const Block& block : blocks_) all.push_back(*device_->get(block.address, block.digits));
    return all;
  }
  void fill(std::mt19937_64& random) {
    EXPECT_TRUE(begin());
    for (const Block& block : blocks_) {
      std::string digits;
      while (digits.size() < block.digits) digits += hex_number(random() & 0xFFFF, 4);
      if (block.digits == 2) digits = digits[0] < '8' ? "00" : "01";
      [[maybe_unused]] const Status set = device_->set(block.address, digits);
    }
  }

  /// "%MW100" and so many digits from there on, as words.
  harness::Protocol::Written words_at(const std::string& address, std::size_t digits) const {
    if (protocol().named(address, digits)) return *protocol().named(address, digits);
    return {"?", 0, 0, address};
  }
  /// What the tool says that it could not put back: "%MW100 = 00E2, %MW101 = 0000".
  void add_named(const std::string& places, Words& words) const {
    for (std::size_t at = 0; at < places.size();) {
      const std::size_t equals = places.find(" = ", at), value = equals + 3;
      const std::size_t end = std::min(places.find(", ", at), places.size());
      words.push_back(words_at(places.substr(at, equals - at), end - value));
      at = end + 2;
    }
  }
  /// Words that differ and are not among the named ones.
  std::string unnamed_changes(const std::vector<std::string>& before, const Words& named) const {
    std::string changed;
    const std::vector<std::string> after = memory();
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      if (before[i] == after[i]) continue;
      const Block& block = blocks_[i];
      harness::Protocol::Written word =
          words_at(block.address, std::min<std::size_t>(4, block.digits));
      for (std::size_t at = 0; at < block.digits; at += 4, ++word.first_word, ++word.last_word)
        if (before[i].compare(at, 4, after[i], at, 4) != 0 &&
            std::ranges::none_of(named, [&](const auto& one) { return one.overlaps(word); }))
          changed += fmt::format(" {}{}: {} was {}", block.address,
                                 at == 0 ? "" : fmt::format(" + {}", at / 4),
                                 after[i].substr(at, 4), before[i].substr(at, 4));
    }
    return changed;
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

  /// Two cases over one bad line, and `fieldproof restore` with the cable plugged in again. What
  /// the tool names is added to `named`; true: it says that it cannot answer for a write.
  bool run(std::mt19937_64& random, Words& named) {
    Badness bad = badness(random);
    NoisyEndpoint line(*device_, bad, random());
    std::filesystem::remove(journal_path());
    Result<safety::Journal> opened = safety::Journal::open(journal_path());
    EXPECT_TRUE(opened) << opened.error().message;
    const auto journal = std::make_shared<safety::Journal>(std::move(*opened));
    std::string doubtful;
    {
      bench::Bench bench(line, protocol(), options(journal));
      for (int i = 0; i < 2; ++i) ++verdicts_[bench.run(cases_[random() % cases_.size()]).verdict];
      [[maybe_unused]] const std::string open = bench.put_back();
      doubtful = bench.doubtful_writes();
    }
    left_open_ += !journal->open_entries().empty();
    bad.cut_after = -1;
    NoisyEndpoint again(*device_, bad, random());
    safety::SavedMemory restore(again, protocol(), 500ms, options(journal).device, journal);
    const std::string problem = restore.restore(), open = restore.open_places();
    EXPECT_EQ(problem.empty(), open.empty()) << problem << open;
    add_named(open, named);
    said_ += !open.empty();
    doubtful_ += !doubtful.empty();
    return !doubtful.empty();
  }

  /// A changed word is seen as long as nobody puts it back, so that once a group is often enough to
  /// look at all of the memory. Where a write is among them that nobody can answer for, `each` run
  /// is looked at.
  void run_group(int group, bool each) {
    SCOPED_TRACE(fmt::format("group {}", group));
    std::mt19937_64 random(static_cast<std::uint64_t>(group));
    fill(random);
    std::vector<std::string> before = memory();
    Words named;
    bool doubtful = false;
    for (int i = 1; i <= runs_of_group; ++i) {
      doubtful = run(random, named) || (!each && doubtful);
      const std::string changed =
          each || i == runs_of_group ? unnamed_changes(before, named) : std::string();
      if (changed.empty()) continue;
      if (!doubtful) ADD_FAILURE() << "run " << i << ":" << changed;
      if (!each && doubtful) return run_group(group, true);
      ++astray_;
      before = memory();
    }
  }

  const harness::Protocol& protocol_;
  std::unique_ptr<harness::Protocol> configured_;
  std::vector<vectors::Case> cases_;
  std::unique_ptr<endpoints::Endpoint> device_;
  std::vector<Block> blocks_;
  std::map<results::Verdict, int> verdicts_;
  int left_open_ = 0, said_ = 0, doubtful_ = 0;  // runs
  int astray_ = 0;                               // runs with a change that nobody can name
};

/// FIELDPROOF_NOISE_RUNS=10000 looks longer.
int runs() {
  const char* text = std::getenv("FIELDPROOF_NOISE_RUNS");
  return text ? std::atoi(text) : 1000;
}

TEST_P(NoisyLine, LeavesTheMemoryAsItWasOrSaysWhatItIsNot) {
  ASSERT_GT(cases_.size(), 10u);
  const int groups = (runs() + runs_of_group - 1) / runs_of_group;
  for (int group = 0; group < groups && !HasFailure(); ++group) run_group(group, false);
  const int all = groups * runs_of_group;
  fmt::print(
      "{}: {} runs, {} with something to restore, {} in which it was said that it could not "
      "be, {} with a write that nobody can answer for ({} of them changed another word); {} PASS, "
      "{} "
      "FAIL, {} BLOCKED, {} ERROR\n",
      GetParam().protocol, all, left_open_, said_, doubtful_, astray_,
      verdicts_[results::Verdict::pass], verdicts_[results::Verdict::fail],
      verdicts_[results::Verdict::blocked], verdicts_[results::Verdict::error]);
  EXPECT_GT(verdicts_[results::Verdict::pass], all / 4) << "most lines let the cases through";
  EXPECT_GT(left_open_, all / 100) << "links were cut in the midst of writing";
  EXPECT_LT(said_, all / 20);
  EXPECT_LT(doubtful_, all / 20);
}

const Setup setups[] = {
    {"xgt-cnet", "xbc-h", "xgt_cnet/w*:xgt_cnet/errors/*:xgt_cnet/data_types/*", "all,P,Q,U", true},
    {"modbus-rtu", "xbc-h", "modbus_rtu/*", "all,P", true},
    {"modbus-ascii", "xbc-h", "modbus_ascii/*", "all,P", true},
    {"modbus-tcp", "xbc-h", "modbus_tcp/*", "all,P", false},
    {"ls-bus", "inverter", "ls_bus/*", "h", true},
};

INSTANTIATE_TEST_SUITE_P(Over, NoisyLine, testing::ValuesIn(setups), [](const auto& one) {
  std::string name = one.param.protocol;
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace fieldproof::noise
