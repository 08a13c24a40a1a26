#include "harness/bench/fingerprint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/exchange/scripted_endpoint.hpp"
#include "harness/test_protocol.hpp"

namespace fieldproof::bench {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

/// Areas M and D, as two models declare them.
struct AreaProtocol : harness::TestProtocol {
  std::vector<Area> areas() const override { return {{"M", {99, 199}}, {"D", {9}}, {"R", {9}}}; }
  Result<std::string> digits_in(ByteView reply) const override {
    if (to_text(reply) == "<no>") return fail("refused");
    return harness::TestProtocol::digits_in(reply);
  }
};

/// A device with so many words of each area.
struct AreaDevice : exchange::ScriptedEndpoint {
  std::map<char, std::uint32_t> words;
  std::string refusal = "<no>";

  using endpoints::Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId link) override {
    const std::string request = to_text(bytes);  // <r%MW12>
    const bool has = std::stoul(request.substr(5)) < words[request[3]];
    answers[request] = {{1ms, has ? "<0000>" : refusal}};
    return exchange::ScriptedEndpoint::send(bytes, link);
  }
};

struct Look {
  Result<Fingerprint> found;
  std::vector<std::string> sent;
};

Look look(std::map<char, std::uint32_t> words, const std::string& refusal = "<no>") {
  AreaDevice device;
  device.words = std::move(words);
  device.refusal = refusal;
  Result<Fingerprint> found = read_fingerprint(device, AreaProtocol(), 1, 100ms);
  return {std::move(found), device.sent};
}

TEST(Fingerprint, FindsDeclaredEndsInFewReads) {
  const Look one = look({{'M', 200}, {'D', 10}});
  ASSERT_TRUE(one.found) << one.found.error().message;
  EXPECT_EQ(*one.found, (Fingerprint{{"areas", "MD"}, {"M", "0-199"}, {"D", "0-9"}}));
  EXPECT_THAT(one.sent, SizeIs(5 + 3 + 1))
      << "the first word, the ends and one past, and the first word of R";
  EXPECT_THAT(one.sent, Each(StartsWith("<r")));
}

TEST(Fingerprint, FindsEveryOtherEnd) {
  for (const std::uint32_t words :
       {1u, 2u, 9u, 99u, 100u, 101u, 150u, 199u, 201u, 5000u, 65'536u}) {
    const Look one = look({{'M', words}});
    ASSERT_TRUE(one.found) << one.found.error().message;
    EXPECT_EQ(one.found->at("M"), "0-" + std::to_string(words - 1));
    EXPECT_LT(one.sent.size(), 50u) << words;
  }
}

TEST(Fingerprint, SilenceAndRubbishAreNoRefusal) {
  EXPECT_EQ(look({{'M', 200}}, "").found.error().message,
            "cannot take the fingerprint: a read of %MW200 gets no answer");
  EXPECT_THAT(look({{'M', 200}}, "<<").found.error().message,
              HasSubstr("a read of %MW200 gets what is no reply: '<<'"));
  AreaDevice gone;
  gone.fails_after = 2;
  gone.words = {{'M', 200}};
  EXPECT_EQ(read_fingerprint(gone, AreaProtocol(), 1, 100ms).error().message, "the port is gone");
}

TEST(Fingerprint, DifferencesNameTheArea) {
  const Fingerprint found{{"areas", "MD"}, {"M", "0-199"}, {"D", "0-9"}};
  EXPECT_EQ(fingerprint_difference({}, found), "");
  EXPECT_EQ(fingerprint_difference({{"M", "0-199"}}, found), "")
      << "what is not declared is not compared";
  EXPECT_EQ(fingerprint_difference({{"areas", "MDR"}, {"M", "0-99"}, {"R", "0-9"}}, found),
            "area M: 0-99 declared, 0-199 found; area R: 0-9 declared, none found; areas MDR "
            "declared, MD found");
}

TEST(Fingerprint, OnlyWhatCanBeFoundMayBeDeclared) {
  EXPECT_TRUE(check_fingerprint({{"areas", "M"}, {"D", "0-9"}}, AreaProtocol()));
  EXPECT_THAT(
      check_fingerprint({{"area", "M"}}, AreaProtocol()).error().message,
      HasSubstr("fingerprint.area is nothing that reads by xgt-cnet find; did you mean 'areas'?"));
  EXPECT_THAT(
      check_fingerprint({{"areas", "M"}, {"M", ""}}, harness::TestProtocol()).error().message,
      HasSubstr("this protocol has none"));
}

}  // namespace
}  // namespace fieldproof::bench
