#include "harness/hosting/bus_link.hpp"

#include <gmock/gmock.h>

#include <deque>

#include "harness/system/sockets/test_sockets.hpp"

namespace fieldproof::hosting {
namespace {

using testing::ElementsAre;

/// Keeps what it hears, and tells what it is given.
class Recorder : public plc::BusEnd {
 public:
  explicit Recorder(std::string name) : name_(std::move(name)) {}
  std::string hello() const override { return "I am " + name_; }
  Status hear(std::string_view line) override {
    heard.emplace_back(line);
    return line == "clash" ? Status(fail("they clash")) : ok();
  }
  void part() override { heard.emplace_back("(gone)"); }
  std::vector<std::string> take_lines() override { return std::exchange(to_tell, {}); }

  std::vector<std::string> heard, to_tell;

 private:
  std::string name_;
};

class BusLinkTest : public testing::Test {
 protected:
  /// Until `end` has heard so many lines in all; what `link` says of the last.
  static Status serve(BusLink& link, Recorder& end, std::size_t lines) {
    Status served = ok();
    while (served && end.heard.size() < lines) {
      std::vector<pollfd> fds;
      link.add_to(fds);
      if (::poll(fds.data(), fds.size(), 5000) != 1) return fail("nothing came within 5 s");
      served = link.serve(end);
    }
    return served;
  }
  void meet() {
    second.tell(b);  // its hello
    EXPECT_TRUE(serve(first, a, 1));
    EXPECT_TRUE(serve(second, b, 1));
  }

  const std::string where =
      "127.0.0.1:" + std::to_string(os::test::port_of(os::test::bound(SOCK_STREAM)));
  BusLink first = std::move(*BusLink::open(where)), second = std::move(*BusLink::open(where));
  Recorder a{"a"}, b{"b"};
};

TEST_F(BusLinkTest, TheSecondJoinsTheFirst) {
  meet();
  a.to_tell = {"one", "two"};
  first.tell(a);
  EXPECT_TRUE(serve(second, b, 3));
  EXPECT_THAT(a.heard, ElementsAre("I am b"));
  EXPECT_THAT(b.heard, ElementsAre("I am a", "one", "two"));
}

TEST_F(BusLinkTest, WhoLosesTheOtherWaitsForTheNext) {
  meet();
  first = std::move(*BusLink::open("127.0.0.1:0"));
  EXPECT_TRUE(serve(second, b, 2));
  EXPECT_THAT(b.heard, ElementsAre("I am a", "(gone)"));
  BusLink third = std::move(*BusLink::open(where));
  Recorder c{"c"};
  third.tell(c);
  EXPECT_TRUE(serve(second, b, 3));
  EXPECT_EQ(b.heard.back(), "I am c");
}

TEST_F(BusLinkTest, WhoDoesNotFitIsToldWhy) {
  meet();
  a.to_tell = {"clash"};
  first.tell(a);
  const Status served = serve(second, b, 4);
  ASSERT_FALSE(served);
  EXPECT_EQ(served.error().message, "they clash");
  EXPECT_EQ(b.heard.back(), "(gone)");
}

TEST(BusLink, AddressesThatCannotBeAreRefused) {
  EXPECT_FALSE(BusLink::open("127.0.0.1"));
  EXPECT_FALSE(BusLink::open("127.0.0.1:70000"));
}

}  // namespace
}  // namespace fieldproof::hosting
