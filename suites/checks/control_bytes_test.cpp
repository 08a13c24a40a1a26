#include "suites/checks/control_bytes.hpp"

#include <gtest/gtest.h>

namespace fieldproof::checks {
namespace {

TEST(ControlBytes, HeadersAreNamed) {
  EXPECT_TRUE(is_header(0x05) && is_header(0x06) && is_header(0x15));
  EXPECT_FALSE(is_header(0x04) || is_header(0x02) || is_header('E'));
  EXPECT_EQ(header_name(0x15), "NAK");
  EXPECT_EQ(header_name(0x04), "not ENQ, ACK or NAK");
}

TEST(ControlBytes, WhatNobodyCanReadStandsInHex) {
  EXPECT_EQ(printable(Bytes{' ', 'a', '~', 0x7F, 0x1F, 0x05, 0x00, 0xFF}),
            " a~<7F><1F><05><00><FF>");
}

}  // namespace
}  // namespace fieldproof::checks
