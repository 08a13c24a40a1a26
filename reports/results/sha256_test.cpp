#include "reports/results/sha256.hpp"

#include <gmock/gmock.h>

#include <fstream>

namespace fieldproof::results {
namespace {

namespace fs = std::filesystem;

class Sha256 : public testing::Test {
 protected:
  Sha256() : folder_(fs::path(testing::TempDir()) / "Sha256") {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "sub");
  }
  ~Sha256() override { fs::remove_all(folder_); }

  void store(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  fs::path folder_;
};

// FIPS 180-4, example "abc".
TEST_F(Sha256, OfAFileIsThePublishedOne) {
  store("abc", "abc");
  EXPECT_EQ("ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
            *sha256_of_file(folder_ / "abc"));
  EXPECT_EQ("ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
            *sha256_of_tree(folder_ / "abc"));
}

// By the command that the header gives.
TEST_F(Sha256, OfATreeIsThatOfItsList) {
  store("b", "abc");
  store("sub/a", "");
  EXPECT_EQ("721533a004a6d7ecee0fdf4e2c315407a97b5cdc906c56f7362187aee96ae544",
            *sha256_of_tree(folder_));
}

TEST_F(Sha256, ATreeDiffersWhenANameOrAByteDoes) {
  store("b", "abc");
  const std::string before = *sha256_of_tree(folder_);
  store("b", "abd");
  const std::string other_byte = *sha256_of_tree(folder_);
  fs::rename(folder_ / "b", folder_ / "c");
  EXPECT_NE(before, other_byte);
  EXPECT_NE(other_byte, *sha256_of_tree(folder_));
}

TEST_F(Sha256, WhatCannotBeReadIsNamed) {
  auto none = sha256_of_file(folder_ / "none");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, testing::HasSubstr("none: no such file or directory"));
}

}  // namespace
}  // namespace fieldproof::results
