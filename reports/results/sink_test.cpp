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
  Status add(const SoakSample&) override { return note("sample"); }
  Status add(const SoakSummary&) override { return note("soak"); }
  Status end(const RunLog& log) override { return note(log.end ? "end" : "killed"); }

 private:
  Status note(const std::string& what) {
    notes_.push_back(what);
    if (what == fails_at_) return fail("cannot write " + what);
    return ok();
  }
  std::vector<std::string>& notes_;
  std::string fails_at_;
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
  ASSERT_TRUE(sink.add(SoakSample{}));
  ASSERT_TRUE(sink.add(SoakSummary{}));
  ASSERT_TRUE(sink.end({}));
}

TEST(Sinks, EachGetsAllOfIt) {
  std::vector<std::string> a, b;
  Sinks sinks;
  sinks.attach(std::make_unique<Notes>(a));
  sinks.attach(std::make_unique<Notes>(b));
  run_through(sinks);
  EXPECT_THAT(a, ElementsAre("run x", "a/one", "a/two", "sample", "soak", "killed"));
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
  EXPECT_EQ(6u, b.size());
  EXPECT_THAT(sinks.troubles(), ElementsAre("cannot write a/one", "cannot write killed"));
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
