#include "harness/run/line_matrix.hpp"

#include <gmock/gmock.h>

namespace fieldproof::run {
namespace {

std::string steps(std::string_view text) {
  const Result<std::vector<line::LineSettings>> read = parse_line_matrix(text);
  if (!read) return read.error().message;
  std::string result;
  for (const line::LineSettings& one : *read) result += line::to_string(one) + ' ';
  return result;
}

TEST(LineMatrix, SpeedBySpeed) {
  EXPECT_EQ("38400-8N1 38400-8E1 115200-8N1 115200-8E1 ", steps("38400,115200 x 8N1,8E1"));
  EXPECT_EQ("9600-8N1 ", steps("9600x8N1"));
  EXPECT_EQ("9600-7O2 19200-7O2 ", steps(" 9600 , 19200 x 7o2 "));
}

TEST(LineMatrix, AllIsWhatTheManualLists) {
  EXPECT_EQ(96u, parse_line_matrix("all")->size());
  EXPECT_EQ(8u, parse_line_matrix("all x 8N1")->size());
  EXPECT_EQ(12u, parse_line_matrix("9600 x all")->size());
}

TEST(LineMatrix, ErrorsNameThePart) {
  for (const char* text : {"", "9600", "9600 x", "x 8N1", "9600,, x 8N1", "300 x 8N1", "9600 x 9N1",
                           "9600 x 8N1,8N1", "8N1 x 9600"})
    EXPECT_THAT(steps(text),
                testing::StartsWith("cannot read --matrix '" + std::string(text) + "': "));
  EXPECT_THAT(steps("9600 x 8N1,8n1"), testing::HasSubstr("9600-8N1 stands there twice"));
}

TEST(LineMatrix, AStepIsAMatrixOfItsOwn) {
  EXPECT_EQ("38400 x 7E2", matrix_text({38400, 7, 'E', 2}));
}

}  // namespace
}  // namespace fieldproof::run
