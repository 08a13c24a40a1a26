#include "harness/safety/journal_note.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace fieldproof::safety {
namespace {

class Notes : public testing::Test {
 protected:
  Notes() {
    std::string pattern = testing::TempDir() + "fieldproof_notes_XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
    ::setenv("XDG_STATE_HOME", folder_.c_str(), 1);
  }
  ~Notes() override {
    ::unsetenv("XDG_STATE_HOME");
    std::filesystem::remove_all(folder_);
  }
  static JournalDevice device(const std::string& endpoint, int station = 1) {
    return {endpoint, station, "xgt-cnet", "xbc-h"};
  }

  std::filesystem::path folder_;
};

TEST_F(Notes, AreOfADeviceWhateverItsOptions) {
  JournalNote(device("serial:/dev/ttyS7?baud=9600")).keep("/runs/a/journal.ndjson");
  EXPECT_EQ(JournalNote(device("serial:/dev/ttyS7?baud=38400&frame=8E1")).journal(),
            "/runs/a/journal.ndjson");
  EXPECT_EQ(JournalNote(device("serial:/dev/ttyS7", 2)).journal(), "") << "another station";
  EXPECT_EQ(JournalNote(device("serial:/dev/ttyS8")).journal(), "");
  EXPECT_EQ(JournalNote(device("tcp:127.0.0.1:502")).journal(), "");
}

TEST_F(Notes, EndWithTheirJournal) {
  const JournalNote note(device("tcp:127.0.0.1:502"));
  note.keep("a/journal.ndjson");
  EXPECT_EQ(note.journal(), (std::filesystem::current_path() / "a/journal.ndjson").string());
  note.keep("/b");
  note.drop("a/journal.ndjson");
  EXPECT_EQ(note.journal(), "/b") << "a later run's";
  note.drop("/b");
  EXPECT_EQ(note.journal(), "");
  note.keep("/b");
  JournalNote::drop_all("/a");
  EXPECT_EQ(note.journal(), "/b");
  JournalNote::drop_all("/b");
  EXPECT_EQ(note.journal(), "");
}

TEST_F(Notes, WithoutAHomeThereAreNone) {
  ::setenv("XDG_STATE_HOME", "", 1);
  const std::string home = ::getenv("HOME") ? ::getenv("HOME") : "";
  ::unsetenv("HOME");
  const JournalNote note(device("tcp:127.0.0.1:502"));
  note.keep("/b");
  EXPECT_EQ(note.journal(), "");
  if (!home.empty()) ::setenv("HOME", home.c_str(), 1);
}

}  // namespace
}  // namespace fieldproof::safety
