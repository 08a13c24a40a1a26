#include "reports/results/file_error.hpp"

#include <gtest/gtest.h>

#include <cerrno>

namespace fieldproof::results {
namespace {

TEST(FileError, SaysVerbObjectCauseAndWhatToDo) {
  EXPECT_EQ("cannot write a/b: no space left on device; free some space",
            file_error("write", "a/b", ENOSPC).message);
  EXPECT_EQ(
      "cannot open a/b: no such file or directory; check the path, and that its folder exists",
      file_error("open", "a/b", ENOENT).message);
  EXPECT_EQ("cannot write a/b: another run writes it; wait for that run, or choose another --out",
            file_error("write", "a/b", EWOULDBLOCK).message);
  EXPECT_EQ("cannot read a/b: input/output error", file_error("read", "a/b", EIO).message);
}

}  // namespace
}  // namespace fieldproof::results
