#include "src/base/spelling.hpp"

#include <gtest/gtest.h>

#include <array>

namespace fieldproof {
namespace {

constexpr std::array<std::string_view, 5> kinds{"emulator", "pty", "serial", "exec", "tcp"};

TEST(Spelling, OneSlipOfEachKindIsForgiven) {
  for (const std::string_view word : {"emulater", "emulatr", "emullator", "emulatro", "Emulator"}) {
    EXPECT_EQ(suggestion(word, kinds), "; did you mean 'emulator'?") << word;
  }
  EXPECT_EQ(suggestion("pyt", kinds), "; did you mean 'pty'?");
}

TEST(Spelling, LongWordsMayHoldMoreSlips) {
  EXPECT_EQ(suggestion("emmulater", kinds), "; did you mean 'emulator'?");
  EXPECT_EQ(suggestion("cereal", kinds), "; did you mean 'serial'?");
}

TEST(Spelling, TheClosestWins) {
  constexpr std::array<std::string_view, 3> words{"station", "stations", "stamina"};
  EXPECT_EQ(suggestion("statoins", words), "; did you mean 'stations'?");
}

TEST(Spelling, WhatIsFarFromAllGetsNoSuggestion) {
  EXPECT_EQ(suggestion("bluetooth", kinds), "");
  EXPECT_EQ(suggestion("xyz", kinds), "");
  EXPECT_EQ(suggestion("", kinds), "");
  EXPECT_EQ(suggestion("serial", {}), "");
}

TEST(Spelling, AShortCandidateIsNotReplacedWhole) {
  constexpr std::array<std::string_view, 1> words{"x"};
  EXPECT_EQ(suggestion("y", words), "");
}

}  // namespace
}  // namespace fieldproof
