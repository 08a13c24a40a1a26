#include "harness/safety/journal.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace fieldproof::safety {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class JournalTest : public testing::Test {
 protected:
  JournalTest() {
    std::string pattern = testing::TempDir() + "fieldproof_journal_XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
    path_ = folder_ + "/out/journal.ndjson";
  }
  ~JournalTest() override { std::filesystem::remove_all(folder_); }

  static std::vector<OpenEntry> two() {
    const JournalDevice device{
        "serial:/dev/ttyUSB0?station=3", 3, "modbus-rtu", "xbc-h", {{"word_write_base", "D100"}}};
    return {{0, device, "%MW100", "00E2"}, {0, device, "%MW101", "1234"}};
  }
  void append(const std::string& text) const { std::ofstream(path_, std::ios::app) << text; }

  std::string folder_, path_;
};

TEST_F(JournalTest, WhatIsSavedIsOpenUntilItIsRestored) {
  std::vector<OpenEntry> entries = two();
  {
    Result<Journal> journal = Journal::open(path_);
    ASSERT_TRUE(journal) << journal.error().message;
    ASSERT_TRUE(journal->save(entries));
    ASSERT_TRUE(journal->restored(entries[0]));
  }
  const Result<std::vector<OpenEntry>> open = read_journal(path_);
  ASSERT_TRUE(open) << open.error().message;
  ASSERT_THAT(*open, SizeIs(1));
  EXPECT_EQ((*open)[0].address, "%MW101");
  EXPECT_EQ((*open)[0].value, "1234");
  EXPECT_EQ((*open)[0].device, entries[0].device);
}

TEST_F(JournalTest, ALineThatIsCutShortIsNone) {
  std::vector<OpenEntry> entries = two();
  { ASSERT_TRUE(Journal::open(path_)->save(entries)); }
  append(R"({"saved":{"number":3,"addr)");
  EXPECT_THAT(*read_journal(path_), SizeIs(2));
  std::vector<OpenEntry> more{two()[0]};
  { ASSERT_TRUE(Journal::open(path_)->save(more)); }
  EXPECT_THAT(*read_journal(path_), SizeIs(3)) << "the next line is not glued to it";
  EXPECT_EQ(more[0].number, 3u);
}

TEST_F(JournalTest, OtherDamageIsNamedByItsLine) {
  std::vector<OpenEntry> entries = two();
  { ASSERT_TRUE(Journal::open(path_)->save(entries)); }
  append("{}\n");
  EXPECT_THAT(read_journal(path_).error().message, HasSubstr("journal.ndjson, line 3"));
}

TEST_F(JournalTest, WithNothingOpenItBeginsAnew) {
  std::vector<OpenEntry> entries = two();
  {
    Result<Journal> journal = Journal::open(path_);
    ASSERT_TRUE(journal->save(entries));
    ASSERT_TRUE(journal->discard({"serial:/dev/ttyUSB1", 3, "", "", {}}));
    EXPECT_THAT(journal->open_entries(), SizeIs(2)) << "another device";
    ASSERT_TRUE(journal->discard({"serial:/dev/ttyUSB0?baud=9600", 3, "", "", {}}));
    EXPECT_THAT(journal->open_entries(), IsEmpty());
  }
  EXPECT_TRUE(Journal::open(path_));
  EXPECT_EQ(std::filesystem::file_size(path_), 0u);
}

TEST_F(JournalTest, TwoRunsDoNotShareIt) {
  const Result<Journal> first = Journal::open(path_);
  EXPECT_THAT(Journal::open(path_).error().message, HasSubstr("another run writes it"));
}

TEST_F(JournalTest, NoFileIsNothingOpen) { EXPECT_THAT(*read_journal(path_), IsEmpty()); }

}  // namespace
}  // namespace fieldproof::safety
