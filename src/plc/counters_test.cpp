#include "src/plc/counters.hpp"

#include <gmock/gmock.h>

namespace fieldproof::plc {
namespace {

using ::testing::HasSubstr;

TEST(ServiceCounters, AnswerClearsTheStatusAlone) {
  ServiceCounters counters;
  counters.count_error(service_status::not_hex);
  counters.count_error(service_status::station);
  EXPECT_EQ(counters.status, 9);
  counters.count_service();
  EXPECT_EQ(counters.status, 0);
  EXPECT_EQ(counters.services, 1u);
  EXPECT_EQ(counters.errors, 2u);
}

TEST(ServiceCounters, BackDoorDigits) {
  const ServiceCounters counters{0x0D, 0x12345, 7};
  EXPECT_EQ(*get_counter(counters, "@status", 0), "0D");
  EXPECT_EQ(*get_counter(counters, "@status", 4), "000D");
  EXPECT_EQ(*get_counter(counters, "@errors", 0), "0007");
  EXPECT_EQ(*get_counter(counters, "@errors", 1), "7");
  EXPECT_EQ(*get_counter(counters, "@services", 2), "12345");  // as many as it needs
  EXPECT_EQ(get_counter(counters, "@error", 0).error().message,
            "cannot get @error: there is no such counter; use @status, @errors or @services; did "
            "you mean '@errors'?");
}

}  // namespace
}  // namespace fieldproof::plc
