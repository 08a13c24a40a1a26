#include "harness/bench/bench.hpp"

#include "harness/bench/test_bench.hpp"
#include "harness/device_names.hpp"

namespace fieldproof::bench {

using results::CaseResult;
using results::Verdict;

namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using BenchTest = test::ScriptedBench;
using test::Pieces;

TEST_F(BenchTest, TheFloorIsMeasuredOnRealTimeAlone) {
  endpoint.answers["<probe>"] = Pieces{{30ms, "<alive>"}};
  ASSERT_TRUE(bench().start());
  EXPECT_FALSE(*bench().measure_floor()) << "simulated time has none";
  on_real_device();
  endpoint.can.timing_floor = 20ms;
  EXPECT_EQ(bench().floor(), 20ms);
  const Result<std::optional<AdapterFloor>> measured = bench().measure_floor();
  ASSERT_TRUE(measured && *measured);
  EXPECT_EQ((*measured)->times.count(), static_cast<std::uint64_t>(floor_probes));
  bench().use_floor(**measured);
  EXPECT_EQ(bench().floor(), 30ms);
}

TEST_F(BenchTest, AnswersBeforeTheEndOfTheirRequestsAreOfNoWire) {
  on_real_device();
  endpoint.can.paced = true;
  endpoint.answers["<probe>"] = Pieces{{-5ms, "<alive>"}};
  ASSERT_TRUE(bench().start());
  const Result<std::optional<AdapterFloor>> measured = bench().measure_floor();
  ASSERT_TRUE(measured && *measured);
  EXPECT_EQ(
      (*measured)->remark,
      "no wire: answers came up to 5.0 ms before the request can have been sent over scripted");
  EXPECT_FALSE(endpoint.can.paced);
}

TEST_F(BenchTest, ALimitBelowTheMeasuredFloorIsInconclusive) {
  on_real_device();
  endpoint.answers["<probe>"] = Pieces{{30ms, "<alive>"}};
  ASSERT_TRUE(bench().start());
  bench().use_floor(**bench().measure_floor());
  EXPECT_EQ(
      run(vector(R"({"send": "'<ask>'"}, {"expect": "'<answer>'", "within": "29ms"})")).verdict,
      Verdict::inconclusive);
  EXPECT_EQ(
      run(vector(R"({"send": "'<ask>'"}, {"expect": "'<answer>'", "within": "31ms"})")).verdict,
      Verdict::pass);
}

TEST_F(BenchTest, StartAsksOnlyWhetherAnythingAnswers) {
  endpoint.answers["<probe>"] = Pieces{{1ms, "utter nonsense"}};
  EXPECT_TRUE(bench().start());
}

TEST_F(BenchTest, SilenceAtTheStartSaysWhatToCheck) {
  endpoint.answers.clear();
  const Status started = bench().start();
  ASSERT_FALSE(started);
  EXPECT_THAT(
      started.error().message,
      HasSubstr("nothing answers on scripted at station 1: check that the device has power"));
  EXPECT_GT(endpoint.sent.size(), 3u)
      << "a device that is still starting gets more than one chance";
}

TEST_F(BenchTest, WhatTheProfileDoesNotDeclareIsSkipped) {
  EXPECT_EQ(run(vector(ask(), R"("models": ["xec-h"], )")).verdict, Verdict::skip);
  EXPECT_EQ(run(vector(ask(), R"("models": ["xbm-s", "xbc-h"], )")).verdict, Verdict::pass);
}

TEST_F(BenchTest, AnExclusionNamesItsReason) {
  options.profile.exclude = {{"xgt_cnet/a/*", "no such command"}};
  EXPECT_THAT(run(vector(ask())).message, HasSubstr("no such command"));
}

TEST_F(BenchTest, NothingIsWrittenWithoutAJournal) {
  on_real_device();
  options.journal = nullptr;
  ASSERT_TRUE(options.fence.allow("M", harness::read_word_name));
  const CaseResult write = run(vector(R"({"send": "'<w>'"}, {"expect": "'<ok>'"})"));
  EXPECT_EQ(write.verdict, Verdict::blocked);
  EXPECT_THAT(write.message, HasSubstr("no journal is open"));
  EXPECT_THAT(endpoint.sent, IsEmpty());
  EXPECT_EQ(run(vector(ask())).verdict, Verdict::pass) << "a read is no write";
}

TEST_F(BenchTest, WhatACaseWritesIsReadBeforeAndPutBackAfter) {
  on_real_device();
  ASSERT_TRUE(options.fence.allow("M", harness::read_word_name));
  endpoint.answers["<r%MW1>"] = Pieces{{1ms, "<00E2>"}};
  endpoint.answers["<w%MW1=1234>"] = Pieces{{1ms, "<ok>"}};
  const std::string text = vector(ask(), R"("given": {"memory": {"%MW1": "1234"}}, )");
  EXPECT_EQ(run(text).verdict, Verdict::pass);
  EXPECT_THAT(endpoint.sent, testing::ElementsAre("<r%MW1>", "<r%MW1>", "<w%MW1=1234>", "<ask>",
                                                  "<probe>", "<r%MW1>"));
  EXPECT_THAT(options.journal->open_entries(), IsEmpty());
  endpoint.sent.clear();
  EXPECT_EQ(run(text).verdict, Verdict::pass);
  EXPECT_THAT(endpoint.sent, testing::ElementsAre("<w%MW1=1234>", "<ask>", "<probe>", "<r%MW1>"))
      << "each place is read surely, once a run, before it is written";
}

/// Words that follow each other are one request; a device that takes one word alone gets them so.
TEST_F(BenchTest, WordsAreSetInOneRequestWhereTheDeviceTakesIt) {
  on_real_device();
  ASSERT_TRUE(options.fence.allow("M", harness::read_word_name));
  endpoint.answers["<r%MW1>"] = Pieces{{1ms, "<00E200E3>"}};
  endpoint.answers["<w%MW1=12345678>"] = Pieces{{1ms, "<ok>"}};
  endpoint.answers["<w%MW1=00E200E3>"] = Pieces{{1ms, "<ok>"}};
  const std::string text =
      vector(ask(), R"("given": {"memory": {"%MW1": "1234", "%MW2": "5678"}}, )");
  const CaseResult one = run(text);
  EXPECT_EQ(one.verdict, Verdict::pass) << one.message;
  EXPECT_THAT(endpoint.sent,
              testing::AllOf(Contains("<w%MW1=12345678>"), testing::Not(Contains("<w%MW2=5678>"))));
  std::vector<std::string> told;
  for (const results::Event& event : one.exchange) told.push_back(event.text);
  EXPECT_THAT(told, testing::AllOf(Contains("given %MW1 = 1234"), Contains("given %MW2 = 5678")));

  endpoint.answers["<w%MW1=12345678>"] = Pieces{{1ms, "<no>"}};
  endpoint.answers["<w%MW1=1234>"] = endpoint.answers["<w%MW2=5678>"] = Pieces{{1ms, "<ok>"}};
  EXPECT_EQ(run(text).verdict, Verdict::pass);
  EXPECT_THAT(endpoint.sent, testing::IsSupersetOf({"<w%MW1=1234>", "<w%MW2=5678>"}));
  endpoint.answers["<w%MW2=5678>"] = Pieces{{1ms, "<no>"}};
  EXPECT_THAT(run(text).message, HasSubstr("cannot set %MW2"));
}

TEST_F(BenchTest, WhatCannotBePutBackStaysInTheJournal) {
  on_real_device();
  ASSERT_TRUE(options.fence.allow("M", harness::read_word_name));
  endpoint.answers["<r%MW1>"] = Pieces{{1ms, "<00E2>"}};
  endpoint.answers["<w%MW1=1234>"] = Pieces{{1ms, "<ok>"}};
  endpoint.answers["<ask>"] = Pieces{{1ms, "<answer>"}};
  endpoint.forgets = "<r%MW1>";
  endpoint.forgets_after = 2;
  const CaseResult result = run(vector(ask(), R"("given": {"memory": {"%MW1": "1234"}}, )"));
  EXPECT_EQ(result.verdict, Verdict::pass);
  EXPECT_THAT(result.notes, Contains(HasSubstr("not put back what it wrote: cannot read %MW1")));
  EXPECT_EQ(bench().put_back(), "%MW1 = 00E2");
}

TEST_F(BenchTest, WhatCannotBeReadIsNotWritten) {
  on_real_device();
  ASSERT_TRUE(options.fence.allow("M", harness::read_word_name));
  const CaseResult result = run(vector(ask(), R"("given": {"memory": {"%MW1": "1234"}}, )"));
  EXPECT_EQ(result.verdict, Verdict::blocked);
  EXPECT_THAT(result.message, HasSubstr("cannot save what it writes: cannot read %MW1"));
  EXPECT_THAT(endpoint.sent, testing::ElementsAre("<r%MW1>", "<r%MW1>", "<probe>"))
      << "silence: is it still there?";
}

/// It answers the reads that save the word, and then nothing: neither the write nor the probe.
TEST_F(BenchTest, ADeviceThatFallsSilentBeforeACaseEndsTheRun) {
  on_real_device();
  ASSERT_TRUE(options.fence.allow("M", harness::read_word_name));
  endpoint.answers["<r%MW1>"] = Pieces{{1ms, "<00E2>"}};
  endpoint.forgets = "<r%MW1>";
  endpoint.forgets_after = 2;
  endpoint.answers.erase("<probe>");
  const CaseResult result = run(vector(ask(), R"("given": {"memory": {"%MW1": "1234"}}, )"));
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_THAT(result.message, HasSubstr("not <ok>; nothing answers any more"));
  EXPECT_THAT(bench().stopped(), HasSubstr("the link is dead since xgt_cnet/a/b"));
  EXPECT_EQ(bench().put_back(), "%MW1 = 00E2");
}

TEST_F(BenchTest, EmulatorsBecomeWhatACaseGives) {
  endpoint.can.back_door = true;
  EXPECT_EQ(
      run(vector(ask(), R"("given": {"config": {"station": 32}, "memory": {"%MW1": "1234"}}, )"))
          .verdict,
      Verdict::pass);
  EXPECT_EQ(endpoint.begun.back().at("station"), 32);
  EXPECT_EQ(endpoint.begun.back().at("model"), "xbc-h");
  EXPECT_EQ(endpoint.memory.at("%MW1"), "1234");
}

TEST_F(BenchTest, OnARealDeviceTheStationIsTransposedAndTheReportSaysSo) {
  on_real_device();
  options.station = 5;
  endpoint.answers["05"] = Pieces{{1ms, "<05>"}};
  const CaseResult result = run(vector(R"({"send": "st"}, {"expect": "'<' st '>'"})",
                                       R"("given": {"config": {"station": 32}}, )"));
  EXPECT_EQ(result.verdict, Verdict::pass) << result.message;
  EXPECT_THAT(result.notes, Contains("transposed: station 32 to 5"));
}

TEST_F(BenchTest, WhereTheStationIsWhatIsTestedItIsBlocked) {
  on_real_device();
  EXPECT_EQ(
      run(vector(ask(), R"("transpose": false, "given": {"config": {"station": 32}}, )")).verdict,
      Verdict::blocked);
}

TEST_F(BenchTest, OnARealDeviceTheConfigurationMustBeDeclared) {
  on_real_device();
  const std::string delay = vector(ask(), R"("given": {"config": {"delay_ms": 50}}, )");
  EXPECT_THAT(run(delay).message, HasSubstr("needs delay_ms = 50; the profile declares 0"));
}

TEST_F(BenchTest, ADeclaredConfigurationRuns) {
  on_real_device();
  options.profile.config["delay_ms"] = "50";
  EXPECT_EQ(run(vector(ask(), R"("given": {"config": {"delay_ms": 50}}, )")).verdict,
            Verdict::pass);
}

TEST_F(BenchTest, NothingIsWrittenOutsideTheFence) {
  on_real_device();
  const std::string writes = vector(R"({"send": "'<write>'"}, {"expect": "'<ok>'"})");
  endpoint.answers["<write>"] = Pieces{{1ms, "<ok>"}};
  const CaseResult result = run(writes);
  EXPECT_EQ(result.verdict, Verdict::blocked);
  EXPECT_EQ(result.message, "writes %MW1; allow it with --allow-write M1");
  EXPECT_THAT(endpoint.sent, IsEmpty());
}

TEST_F(BenchTest, GivenMemoryIsBehindTheFenceToo) {
  on_real_device();
  EXPECT_EQ(run(vector(ask(), R"("given": {"memory": {"%MW1": "1234"}}, )")).verdict,
            Verdict::blocked);
}

TEST_F(BenchTest, InsideTheFenceItIsWrittenThroughTheProtocol) {
  on_real_device();
  ASSERT_TRUE(options.fence.allow("M", harness::read_word_name));
  endpoint.answers["<r%MW1>"] = Pieces{{1ms, "<0000>"}};
  endpoint.answers["<w%MW1=1234>"] = Pieces{{1ms, "<ok>"}};
  EXPECT_EQ(run(vector(ask(), R"("given": {"memory": {"%MW1": "1234"}}, )")).verdict,
            Verdict::pass);
}

TEST_F(BenchTest, AFreshStateNeedsAPowerCycle) {
  on_real_device();
  const std::string fresh = vector(ask(), R"("given": {"fresh": true}, )");
  EXPECT_EQ(run(fresh).verdict, Verdict::blocked);
}

TEST_F(BenchTest, AnEndpointThatCanPowerCyclesForAFreshState) {
  on_real_device();
  endpoint.can.can_power_cycle = true;
  EXPECT_EQ(run(vector(ask(), R"("given": {"fresh": true}, )")).verdict, Verdict::pass);
  EXPECT_EQ(endpoint.power_cycles, 1);
}

TEST_F(BenchTest, BehindAPtyShortTimesAndFormatsAreInconclusive) {
  endpoint.can = {.back_door = true};
  EXPECT_EQ(run(vector(R"({"send": "'<a' ~50ms 'sk>'"}, {"silence": true})")).verdict,
            Verdict::inconclusive);
  EXPECT_EQ(
      run(vector(R"({"send": "'<ask>'"}, {"wait": "9ms"}, {"expect": "'<answer>'"})")).verdict,
      Verdict::inconclusive);
  EXPECT_EQ(run(vector(ask(), R"("given": {"config": {"line": "1200-7E1"}}, )")).verdict,
            Verdict::inconclusive);
  EXPECT_EQ(run(vector(ask())).verdict, Verdict::pass);
}

TEST_F(BenchTest, AfterANegativeCaseSomethingMustStillAnswer) {
  endpoint.answers.clear();
  const CaseResult result = run(vector(R"({"send": "'<bad>'"}, {"silence": true})"));
  EXPECT_EQ(result.verdict, Verdict::fail);
  EXPECT_THAT(result.message, HasSubstr("link dead after this frame"));
}

TEST_F(BenchTest, OnARealDeviceADeadLinkBlocksTheRest) {
  on_real_device();
  endpoint.answers.erase("<probe>");
  EXPECT_EQ(run(vector(ask())).verdict, Verdict::fail);
  const CaseResult next = run(vector(ask()));
  EXPECT_EQ(next.verdict, Verdict::blocked);
  EXPECT_THAT(next.message, HasSubstr("the link is dead since xgt_cnet/a/b"));
}

TEST_F(BenchTest, AFailedPortIsAnErrorAndStopsTheBench) {
  endpoint.fails_after = 0;
  EXPECT_EQ(run(vector(ask())).verdict, Verdict::error);
  EXPECT_TRUE(bench().port_failed());
  EXPECT_EQ(run(vector(ask())).verdict, Verdict::blocked);
}

TEST_F(BenchTest, MixedReadingsAreNonStrict) {
  const std::string steps =
      R"({"send": "'<ask>'"}, {"expect": {"reading": "echo", "lower": "'<ss>'", "upper": "'<SS>'"}})";
  endpoint.answers["<ask>"] = Pieces{{1ms, "<SS>"}};
  EXPECT_EQ(run(vector(steps)).verdict, Verdict::non_strict);
  endpoint.answers["<ask>"] = Pieces{{1ms, "<ss>"}};
  const CaseResult second = run(vector(steps));
  EXPECT_EQ(second.verdict, Verdict::non_strict);
  EXPECT_THAT(second.message,
              HasSubstr("mixes readings: echo = lower here, upper in xgt_cnet/a/b"));
}

TEST_F(BenchTest, TheResultCarriesWhatAReportNeeds) {
  options.replay = "fieldproof run --filter ";
  endpoint.answers["<ask>"] = Pieces{{1ms, "<no>"}};
  const CaseResult result = run(vector(ask()));
  EXPECT_EQ(result.replay, "fieldproof run --filter 'xgt_cnet/a/b'");
  EXPECT_EQ(result.expected, "'<answer>'");
  EXPECT_EQ(result.received, "'<no>'");
  EXPECT_EQ(result.quote, "as printed");
  EXPECT_FALSE(result.differences.empty());
  ASSERT_GE(result.exchange.size(), 2u);
  EXPECT_EQ(result.exchange[0].text, "'<ask>'");
}

// ---- fence, profile

struct FenceProtocol : harness::TestProtocol {
  std::vector<std::string_view> output_areas() const override { return {"P", "Q", "U"}; }
};

std::string objection(const std::string& allowed, const harness::Protocol::Written& written) {
  safety::WriteFence fence;
  EXPECT_TRUE(fence.allow(allowed, harness::read_word_name)) << allowed;
  return fence.objection({written}, FenceProtocol());
}

TEST(WriteFence, RangesAreaAndAll) {
  const harness::Protocol::Written m100{"M", 100, 101, "%MD50"};
  EXPECT_EQ(objection("M100-M101", m100), "");
  EXPECT_EQ(objection("%MW0-%MW101", m100), "");
  EXPECT_EQ(objection("D,M", m100), "");
  EXPECT_EQ(objection("all", m100), "");
  EXPECT_EQ(objection("M100", m100), "writes %MD50; allow it with --allow-write M100-M101");
  EXPECT_NE(objection("D", m100), "");
}

TEST(WriteFence, OutputsOnlyWhenNamed) {
  EXPECT_NE(objection("all", {"P", 0, 0, "%PW0"}), "");
  EXPECT_EQ(objection("all,P", {"P", 0, 0, "%PW0"}), "");
}

/// An area is an output by its whole name: QD is one, and D is none.
TEST(WriteFence, AreasAreNamedWhole) {
  safety::WriteFence fence;
  ASSERT_TRUE(fence.allow("all", harness::read_word_name));
  EXPECT_EQ(fence.allowed("QD", {"Y", "QD"}).size(), 0u);
  EXPECT_EQ(fence.allowed("D", {"Y", "QD"}).size(), 1u);
}

TEST(WriteFence, AnAxisOfAnotherPlcIsAnotherAxis) {
  safety::WriteFence fence;
  ASSERT_TRUE(fence.allow_motion("1,B:3-4", 20));
  EXPECT_EQ(fence.motion_objection("1", "x"), "");
  EXPECT_EQ(fence.motion_objection("B:1", "sets B:SM2010"),
            "moves axis B:1 (sets B:SM2010); allow it with --allow-motion B:1, when nobody stands "
            "near");
  EXPECT_EQ(fence.motion_objection("B:4", "x"), "");
  EXPECT_NE(fence.motion_objection("4", "x"), "");
  EXPECT_THAT(fence.motion_objection("B:?", "x"), HasSubstr("--allow-motion B:all"));
  ASSERT_TRUE(fence.allow_motion("B:all", 20));
  EXPECT_EQ(fence.motion_objection("B:?", "x"), "");
  EXPECT_NE(fence.motion_objection("?", "x"), "");
  ASSERT_TRUE(fence.allow_motion("all", 20));
  EXPECT_EQ(fence.motion_objection("C:7", "x"), "");
}

TEST(WriteFence, AxesEndWithTheLastOne) {
  safety::WriteFence fence;
  EXPECT_TRUE(fence.allow_motion("20", 20));
  EXPECT_THAT(fence.allow_motion("21", 20).error().message, HasSubstr("axes are 1 to 20"));
  EXPECT_THAT(fence.allow_motion("B:0", 20).error().message, HasSubstr("write an axis (1)"));
}

TEST(WriteFence, RangesThatMeetAreOne) {
  EXPECT_EQ(objection("M100,M101-M102", {"M", 100, 102, "%MW100"}), "");
  safety::WriteFence fence;
  ASSERT_TRUE(fence.allow("M110-M119,M100-M105,M106,D3", harness::read_word_name));
  const std::vector<safety::WriteFence::Words> words = fence.allowed("M", {"P"});
  ASSERT_EQ(words.size(), 2u);
  EXPECT_EQ(words[0].last, 106u);
  EXPECT_EQ(words[1].first, 110u);
}

TEST(WriteFence, ADamagedRequestNeedsAll) {
  EXPECT_THAT(objection("M,D,K,L,R", {"?", 0, ~0u, ""}), HasSubstr("--allow-write all"));
  EXPECT_EQ(objection("all", {"?", 0, ~0u, ""}), "");
}

TEST(WriteFence, NonsenseIsRefusedByItsName) {
  for (const char* text : {"M-", "M5-M1", "M1-D2", "%MX1", "5", "M1x", "-", "Z", "Z1-Z9"}) {
    safety::WriteFence fence;
    const Status allowed = fence.allow(text, harness::read_word_name);
    ASSERT_FALSE(allowed) << text;
    EXPECT_THAT(allowed.error().message, HasSubstr("cannot read --allow-write '"));
  }
}

}  // namespace
}  // namespace fieldproof::bench
