#include "reports/results/sink.hpp"

#include <gmock/gmock.h>

#include "reports/results/result_json.hpp"

namespace fieldproof::results {
namespace {

using testing::ElementsAre;

/// Notes what comes, and fails where it is told to.
class Notes final : public Sink {
 public:
  explicit Notes(std::vector<std::string>& notes, std::string fails_at = "")
      : notes_(notes), fails_at_(std::move(fails_at)) {}
  Status begin(const RunInfo& run) override { return note("run " + run.endpoint); }
  Status add(const Delivery& one) override { return note(one->id); }
  Status end(const RunLog& log) override { return note(log.end ? "end" : "killed"); }

 private:
  Status note(const std::string& what) {
    notes_.push_back(what);
    if (what == throws_at) throw std::runtime_error("a bug");
    if (what == fails_at_) return fail("cannot write " + what);
    return ok();
  }
  std::vector<std::string>& notes_;
  std::string fails_at_;

 public:
  std::string throws_at;
};

void run_through(Sink& sink) {
  RunInfo run;
  run.endpoint = "x";
  CaseResult result;
  ASSERT_TRUE(sink.begin(run));
  result.id = "a/one";
  ASSERT_TRUE(sink.add(Delivery(result)));
  result.id = "a/two";
  ASSERT_TRUE(sink.add(Delivery(result)));
  ASSERT_TRUE(sink.end({}));
}

TEST(Sinks, EachGetsAllOfIt) {
  std::vector<std::string> a, b;
  Sinks sinks;
  sinks.attach(std::make_unique<Notes>(a));
  sinks.attach(std::make_unique<Notes>(b));
  run_through(sinks);
  EXPECT_THAT(a, ElementsAre("run x", "a/one", "a/two", "killed"));
  EXPECT_EQ(a, b);
  EXPECT_THAT(sinks.troubles(), ElementsAre());
}

TEST(Sinks, OneThatFailsStopsAlone) {
  std::vector<std::string> a, b, c;
  Sinks sinks;
  sinks.attach(std::make_unique<Notes>(a, "a/one"));
  sinks.attach(std::make_unique<Notes>(b));
  sinks.attach(std::make_unique<Notes>(c, "killed"));
  run_through(sinks);
  EXPECT_THAT(a, ElementsAre("run x", "a/one"));
  EXPECT_EQ(4u, b.size());
  EXPECT_THAT(sinks.troubles(), ElementsAre("cannot write a/one", "cannot write killed"));
}

TEST(Sinks, OneThatThrowsStopsAloneAndIsTold) {
  std::vector<std::string> a, b;
  auto thrower = std::make_unique<Notes>(a);
  thrower->throws_at = "a/one";
  Sinks sinks;
  sinks.attach(std::move(thrower));
  sinks.attach(std::make_unique<Notes>(b));
  run_through(sinks);
  EXPECT_EQ(2u, a.size());
  EXPECT_EQ(4u, b.size());
  EXPECT_THAT(sinks.troubles(), ElementsAre("internal error in a report: a bug; please report it"));
}

TEST(Sinks, TheLastIsToldWhatOthersCouldNotWrite) {
  struct Told final : Sink {
    explicit Told(RunEnd& end) : end_(end) {}
    Status begin(const RunInfo&) override { return ok(); }
    Status add(const Delivery&) override { return ok(); }
    Status end(const RunLog& log) override { return end_ = *log.end, ok(); }
    RunEnd& end_;
  };
  std::vector<std::string> a;
  RunEnd told;
  Sinks sinks;
  sinks.attach(std::make_unique<Notes>(a, "end"));
  sinks.attach(std::make_unique<Told>(told));
  RunLog log;
  log.end.emplace();
  ASSERT_TRUE(sinks.end(log));
  EXPECT_EQ(3, told.exit_code);
  ASSERT_EQ(1u, told.reasons.size());
  EXPECT_EQ("cannot write end", told.reasons.front().message);
}

TEST(Delivery, ItsTextIsMadeOnce) {
  CaseResult result;
  result.id = "a/one";
  const Delivery one(result);
  const std::string& text = one.json();
  std::string expected;
  append_json(expected, result);
  EXPECT_EQ(expected, text);
  result.id = "a/two";
  EXPECT_EQ(&text, &one.json());
  EXPECT_EQ(expected, one.json());
}

}  // namespace
}  // namespace fieldproof::results
