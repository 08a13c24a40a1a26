#include "suites/xgt_cnet/keyword_facts.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "suites/xgt_cnet/protocol.hpp"

namespace fieldproof::xgt_cnet {
namespace {

std::string error_of(const char* facts) {
  const Status status = protocol().check_fact(nlohmann::json::parse(facts));
  return status ? "" : status.error().message;
}

TEST(KeywordFacts, AreCheckedAgainstTheTables) {
  EXPECT_EQ(error_of(R"({"model": "xbc-h", "keyword": "_P2P1_NDR00", "address": "%LX05120"})"), "");
  EXPECT_EQ(error_of(R"({"model": "xec-h", "keyword": "_P1B00RD1", "address": "%NW0001", "words": 5})"), "");
  EXPECT_EQ(error_of(R"({"model": "xec-h", "keyword": "_P2P1_ERRCNT01", "address": "%LD264"})"),
            "_P2P1_ERRCNT01 of xec-h: the table has %LD261, the manual %LD264");
  EXPECT_EQ(error_of(R"({"model": "xbc-h", "keyword": "_P1B00RD1", "address": "%NW1", "words": 5})"),
            "_P1B00RD1 of xbc-h: the table has 4 words, the manual 5");
  EXPECT_EQ(error_of(R"({"model": "xbc-h", "keyword": "_P1B00XX", "address": "%NW1"})"),
            "there is no keyword '_P1B00XX'; Appendix 2 has such as _P2P1_NDR00 and _P1B00SN");
  EXPECT_EQ(error_of(R"({"model": "xbc", "keyword": "_P1B00SN", "address": "%NW0"})"),
            "a fact of P2P has model (xbc-h, xbm-s, xec-h), keyword and address");
  EXPECT_NE(error_of(R"({"model": "xbc-h", "keyword": "_P1B00SN", "addres": "%NW0"})").find("did you mean 'address'"), std::string::npos);
}

}  // namespace
}  // namespace fieldproof::xgt_cnet
