#include "harness/safety/journal.hpp"

#include <gmock/gmock.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
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
    // Each line is to be on the disk: in memory that takes no time.
    const bool memory = ::access("/dev/shm", W_OK) == 0;
    std::string pattern = (memory ? "/dev/shm/" : testing::TempDir()) + "fieldproof_journal_XXXXXX";
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

/// Files may not grow beyond `bytes` while it lives.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

/// The disk had room for half of the lines: what was saved before is still known, and what is
/// written behind it, too.
TEST_F(JournalTest, AFullDiskTakesAllLinesOrNone) {
  std::vector<OpenEntry> first = two(), second = two();
  Result<Journal> journal = Journal::open(path_);
  ASSERT_TRUE(journal->save(first));
  const auto size = std::filesystem::file_size(path_);
  {
    const FullDisk full(size + size / 4 * 3);
    EXPECT_THAT(journal->save(second).error().message, HasSubstr("cannot write " + path_));
  }
  EXPECT_EQ(std::filesystem::file_size(path_), size);
  ASSERT_TRUE(journal->restored(first[0]));
  const Result<std::vector<OpenEntry>> open = read_journal(path_);
  ASSERT_TRUE(open) << open.error().message;
  ASSERT_THAT(*open, SizeIs(1));
  EXPECT_EQ((*open)[0].address, "%MW101");
}

TEST_F(JournalTest, OtherDamageIsNamedByItsLine) {
  std::vector<OpenEntry> entries = two();
  { ASSERT_TRUE(Journal::open(path_)->save(entries)); }
  append("{}\n");
  EXPECT_THAT(read_journal(path_).error().message, HasSubstr("journal.ndjson, line 3"));
}

/// A slip on the command line must not empty somebody's file.
TEST_F(JournalTest, AnotherFileStaysAsItIs) {
  std::filesystem::create_directories(folder_ + "/out");
  for (const char* text : {"hello", "hello\n", "{\"seed\": 1}", "{\"saved\": 1}\n"}) {
    std::ofstream(path_) << text;
    EXPECT_THAT(Journal::open(path_).error().message, HasSubstr("journal")) << text;
    EXPECT_EQ(std::filesystem::file_size(path_), std::string_view(text).size());
  }
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

/// A soak saves and puts back for hours.
TEST_F(JournalTest, StaysSmallHoweverMuchIsClosed) {
  Result<Journal> journal = Journal::open(path_);
  std::vector<OpenEntry> lasting{two()[1]};
  ASSERT_TRUE(journal->save(lasting));
  std::uintmax_t largest = 0;
  for (int round = 0; round < 5000; ++round) {
    std::vector<OpenEntry> entries(20, two()[0]);
    ASSERT_TRUE(journal->save(entries));
    for (const OpenEntry& one : entries) ASSERT_TRUE(journal->restored(one));
    largest = std::max(largest, std::filesystem::file_size(path_));
  }
  EXPECT_LT(largest, 1'000'000u);
  EXPECT_THAT(Journal::open(path_).error().message, HasSubstr("another run writes it"))
      << "the new file is locked, too";
  const Result<std::vector<OpenEntry>> open = read_journal(path_);
  ASSERT_THAT(*open, SizeIs(1));
  EXPECT_EQ((*open)[0].address, "%MW101");
  std::vector<OpenEntry> next{two()[0]};
  ASSERT_TRUE(journal->save(next));
  EXPECT_EQ(next[0].number, 100'002u) << "no number comes twice";
}

/// From now on this process dies where it asks the system for that.
void die_at(int system_call) {
  const auto number = static_cast<std::uint32_t>(system_call);
  sock_filter code[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog program{4, code};
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
    ::_exit(2);
}

/// A step of compacting at which the process is killed; 0: at some moment or other.
struct Death {
  const char* name;
  int system_call = 0;
  bool leaves_beside = false;
};
void PrintTo(const Death& death, std::ostream* out) { *out << death.name; }

class KilledWhileItIsCompacted : public JournalTest, public testing::WithParamInterface<Death> {
 protected:
  /// One value stays open, others are put back for ever.
  [[noreturn]] void live(int ready) const {
    Result<Journal> journal = Journal::open(path_);
    std::vector<OpenEntry> lasting{two()[1]}, others(most_others, two()[0]);
    if (!journal || !journal->save(lasting) || ::write(ready, "!", 1) != 1) ::_exit(1);
    if (GetParam().system_call != 0) die_at(GetParam().system_call);
    for (;;) {
      if (!journal->save(others)) ::_exit(1);
      for (const OpenEntry& one : others)
        if (!journal->restored(one)) ::_exit(1);
    }
  }
  /// Its end.
  int die(int round) const {
    int ready[2]{}, status = 0;
    EXPECT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) live(ready[1]);
    ::close(ready[1]);
    char said = 0;
    EXPECT_EQ(::read(ready[0], &said, 1), 1);
    ::close(ready[0]);
    if (GetParam().system_call == 0) {
      ::usleep(static_cast<useconds_t>(40'000 + 27'777 * round));
      ::kill(child, SIGKILL);
    }
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }
  static constexpr int most_others = 100;
};

/// All that was saved and not restored is in the file of that name, and the next run goes on with
/// it.
TEST_P(KilledWhileItIsCompacted, LosesNothing) {
  const auto is_lasting = [](const OpenEntry& one) { return one.address == "%MW101"; };
  { ASSERT_TRUE(Journal::open(path_)); }
  for (int round = 1; round <= 4; ++round) {
    EXPECT_EQ(die(round), GetParam().system_call == 0 ? SIGKILL : SIGSYS);
    if (GetParam().system_call != 0) {
      EXPECT_EQ(std::filesystem::exists(path_ + ".new"), GetParam().leaves_beside);
    }
    EXPECT_LT(std::filesystem::file_size(path_), 1'000'000u);
    const Result<std::vector<OpenEntry>> open = read_journal(path_);
    ASSERT_TRUE(open) << open.error().message;
    EXPECT_EQ(std::ranges::count_if(*open, is_lasting), round);
    Result<Journal> next = Journal::open(path_);
    ASSERT_TRUE(next) << next.error().message;
    EXPECT_EQ(next->open_entries().size(), open->size());
    for (const OpenEntry& one : *open) {
      ASSERT_TRUE(is_lasting(one) || next->restored(one));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(At, KilledWhileItIsCompacted,
                         testing::Values(Death{"any_moment"}, Death{"its_beginning", SYS_openat},
                                         Death{"the_lock_of_the_empty_file", SYS_flock, true},
                                         Death{"the_name_of_the_whole_file", SYS_rename, true},
                                         Death{"the_folder_after_the_name", SYS_fsync}),
                         [](const auto& one) { return std::string(one.param.name); });

/// As a kill leaves it in the middle of the file beside, and before the new one has the name.
TEST_F(JournalTest, WhatIsLeftBesideItIsOfNoAccount) {
  std::vector<OpenEntry> entries = two();
  { ASSERT_TRUE(Journal::open(path_)->save(entries)); }
  for (const char* beside : {"", R"({"saved":{"number":1,"addr)", "{}\n"}) {
    std::ofstream(path_ + ".new") << beside;
    EXPECT_THAT(*read_journal(path_), SizeIs(2));
    Result<Journal> journal = Journal::open(path_);
    ASSERT_TRUE(journal) << journal.error().message;
    std::vector<OpenEntry> more(1100, two()[0]);
    ASSERT_TRUE(journal->save(more));
    for (const OpenEntry& one : more) ASSERT_TRUE(journal->restored(one));
    EXPECT_THAT(*read_journal(path_), SizeIs(2));
    EXPECT_FALSE(std::filesystem::exists(path_ + ".new"));
  }
}

/// A folder in which nothing can be made any more: the journal goes on as it is.
TEST_F(JournalTest, WithoutRoomBesideItGrows) {
  Result<Journal> journal = Journal::open(path_);
  std::filesystem::create_directory(path_ + ".new");
  std::vector<OpenEntry> entries(1100, two()[0]);
  ASSERT_TRUE(journal->save(entries));
  for (std::size_t i = 1; i < entries.size(); ++i) ASSERT_TRUE(journal->restored(entries[i]));
  EXPECT_THAT(*read_journal(path_), SizeIs(1));
}

TEST_F(JournalTest, NoFileIsNothingOpen) { EXPECT_THAT(*read_journal(path_), IsEmpty()); }

}  // namespace
}  // namespace fieldproof::safety
