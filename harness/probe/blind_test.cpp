// Devices of unknown settings on a simulated line, found blind.
#include <gmock/gmock.h>

#include <random>
#include <set>

#include "harness/probe/test_line.hpp"

namespace fieldproof::probe::test {

using endpoints::Endpoint;
using line::LineSettings;

namespace {

struct Setting {
  Hidden hidden;
  LineSettings line;
  int station = 0;
};

template <typename T>
T one_of(std::mt19937& random, const std::vector<T>& all) {
  return all[random() % all.size()];
}

/// The same for the same seed, on every machine: no standard distribution.
Setting random_setting(unsigned seed) {
  std::mt19937 random(seed);
  Setting setting;
  const harness::Protocol& protocol = *one_of(random, filled({}, suites::protocols()).protocols);
  setting.hidden.protocol = protocol.name();
  setting.hidden.model = one_of(random, protocol.models());
  setting.station = static_cast<int>(random() % 31) + 1;
  setting.line.baud = one_of<int>(random, {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200});
  setting.line.data_bits = protocol.name() == "modbus-rtu" ? 8 : one_of<int>(random, {7, 8});
  setting.line.parity = one_of<char>(random, {'N', 'E', 'O'});
  setting.line.stop_bits = one_of<int>(random, {1, 2});
  setting.hidden.config = {{"station", setting.station}, {"line", line::to_string(setting.line)}};
  if (random() % 2)
    setting.hidden.config.update({{"rs485", true}, {"delay_ms", 10 * (random() % 40)}});
  return setting;
}

class Blind : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Blind, testing::Range(0u, 50u));

TEST_P(Blind, IsFound) {
  const Setting setting = random_setting(GetParam());
  SCOPED_TRACE(setting.hidden.protocol + ' ' + setting.hidden.model + ' ' +
               setting.hidden.config.dump());
  const std::vector<Finding> findings = find(opener(setting.hidden));
  ASSERT_THAT(kinds(findings), testing::ElementsAre(Finding::Kind::device))
      << findings.front().text;
  const Trial& found = findings.front().trial;
  EXPECT_EQ(found.protocol->name(), setting.hidden.protocol);
  EXPECT_EQ(found.station, setting.station);
  EXPECT_EQ(found.line.baud, setting.line.baud);
  EXPECT_EQ(found.line.data_bits, setting.line.data_bits);
  EXPECT_EQ(found.line.parity, setting.line.parity);
}

TEST(Search, AFactoryNewDeviceIsFoundAtOnce) {
  const Search search = run_search(opener({}));
  EXPECT_EQ(search.trials, 1u + 3u);  // listening, the question, twice more
  const std::vector<Finding> findings = conclude(search, {});
  EXPECT_THAT(findings.front().text, testing::HasSubstr("xgt-cnet, station 1, answers in "));
}

TEST(Search, AllFindsEveryStationOfTheLine) {
  Hidden hidden;
  hidden.config["neighbours"] = {2, 3};
  EXPECT_EQ(kinds(conclude(run_search(opener(hidden), small_space(), true), {})),
            std::vector(3, Finding::Kind::device));
  EXPECT_EQ(kinds(conclude(run_search(opener(hidden), small_space(), false), {})),
            std::vector(1, Finding::Kind::device));
}

TEST(Search, SendsProbesAlone) {
  struct Recorder final : Wire {
    Recorder(std::unique_ptr<Endpoint> inner, const LineSettings&, std::set<Bytes>* all)
        : Wire(std::move(inner)), sent(all) {}
    using endpoints::Endpoint::send;
    Result<Sent> send(ByteView bytes, LinkId) override {
      sent->emplace(bytes.begin(), bytes.end());
      return inner_->send(bytes);
    }
    std::set<Bytes>* sent;
  };
  std::set<Bytes> sent, probes;
  run_search(behind<Recorder>(opener({.config = {{"station", 200}}}), &sent), small_space());
  for (const Trial& trial : make_plan(small_space(), suites::protocols()))
    probes.insert(trial.protocol->probe(trial.station, {}));
  EXPECT_EQ(sent, probes);
}

TEST(Search, WaitsForADelayedReply) {
  Hidden hidden;
  hidden.config.update({{"rs485", true}, {"delay_ms", 480}});
  const std::vector<Finding> findings = find(opener(hidden), small_space());
  ASSERT_THAT(kinds(findings), testing::ElementsAre(Finding::Kind::device));
  EXPECT_THAT(findings.front().text, testing::HasSubstr("answers in 480."))
      << findings.front().text;
}

/// The delay time may be 2550 ms (table 4.3.1): the reply comes when another question has been
/// asked, and shows who is late.
TEST(Search, FindsADeviceThatAnswersAfterTheWait) {
  Hidden hidden;
  hidden.config.update({{"rs485", true}, {"delay_ms", 1700}});
  const std::vector<Finding> findings = find(opener(hidden), small_space());
  ASSERT_THAT(kinds(findings), testing::ElementsAre(Finding::Kind::device))
      << findings.front().text;
  EXPECT_EQ(findings.front().trial.station, 1);
}

/// A program that the bench starts takes a while to open its port.
TEST(Search, AsksAgainWhatADeviceThatWasStartingDidNotHear) {
  struct Starting final : Wire {
    Starting(std::unique_ptr<Endpoint> inner, const LineSettings&) : Wire(std::move(inner)) {}
    unsigned starts() const override { return 1; }
    using endpoints::Endpoint::send;
    Result<Sent> send(ByteView bytes, LinkId link) override {
      return now() < up ? Sent{now(), now()} : inner_->send(bytes, link);
    }
    const Time up = now() + 3s;
  };
  const std::vector<Finding> findings = find(behind<Starting>(opener({})), small_space());
  ASSERT_THAT(kinds(findings), testing::ElementsAre(Finding::Kind::device));
  EXPECT_EQ(findings.front().trial.station, 1);
}

TEST(Search, SettingsThatThePortRefusesAreLeftOut) {
  const LineOpener inner = opener({.config = {{"station", 2}, {"line", "19200-8N1"}}});
  const LineOpener picky = [&](const LineSettings& line) -> Result<std::unique_ptr<Endpoint>> {
    if (line.baud == 9600) return fail("the adapter does not offer 9600");
    return inner(line);
  };
  const Search search = run_search(picky);
  EXPECT_FALSE(search.not_offered.empty());
  EXPECT_EQ(conclude(search, {}).front().kind, Finding::Kind::device);
}

TEST(Search, TroubleOfThePortEndsIt) {
  const auto run = [](const LineOpener& open) {
    Prober prober(open, suites::protocols(), {},
                  [](std::size_t, std::size_t, const Observation&) {});
    return prober.run(make_plan(small_space(), suites::protocols()), false);
  };
  const Result<Search> never =
      run([](const LineSettings&) -> Result<std::unique_ptr<Endpoint>> { return fail("in use"); });
  ASSERT_FALSE(never);
  EXPECT_EQ(never.error().message, "in use");

  struct Unplugged final : Wire {
    Unplugged(std::unique_ptr<Endpoint> inner, const LineSettings&) : Wire(std::move(inner)) {}
    using endpoints::Endpoint::send;
    Result<Sent> send(ByteView, LinkId) override { return fail("the far end is gone"); }
  };
  const Result<Search> gone = run(behind<Unplugged>(opener({})));
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().message, "the far end is gone");
}

TEST(Search, AnInterruptKeepsWhatWasHeard) {
  struct Stopped final : Wire {
    Stopped(std::unique_ptr<Endpoint> inner, const LineSettings&) : Wire(std::move(inner)) {}
    using endpoints::Endpoint::send;
    Result<Sent> send(ByteView bytes, LinkId) override {
      return ++sent > 2 ? Result<Sent>(Error{"interrupted", true}) : inner_->send(bytes);
    }
    int sent = 0;
  };
  Prober prober(behind<Stopped>(opener({.config = {{"station", 9}}})), suites::protocols(), {},
                [](std::size_t, std::size_t, const Observation&) {});
  const Result<Search> search = prober.run(make_plan(small_space(), suites::protocols()), false);
  ASSERT_TRUE(search);
  EXPECT_TRUE(search->interrupted);
  EXPECT_EQ(search->trials, 3u);
}

}  // namespace
}  // namespace fieldproof::probe::test
