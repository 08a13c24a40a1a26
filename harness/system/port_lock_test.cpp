#include "harness/system/port_lock.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

namespace fieldproof::os {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::SizeIs;

/// A process that does nothing until it is ended, and has ended when the object is gone.
class Bystander {
 public:
  Bystander() : pid_(::fork()) {
    if (pid_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (;;) ::pause();
  }
  ~Bystander() { end(); }
  void end() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(std::exchange(pid_, 0), nullptr, 0);
  }
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_;
};

class PortLocks : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "port_lock_XXXXXX";
    ASSERT_TRUE(::mkdtemp(pattern.data()));
    folder = pattern;
    port = folder + "/ttyX";
    std::ofstream(port) << "";
    lock_name = "LCK.." + folder + "_ttyX";
    std::ranges::replace(lock_name, '/', '_');
    lock_path = folder + '/' + lock_name;
  }
  void TearDown() override { fs::remove_all(folder); }

  Result<PortLock> acquire() { return PortLock::acquire(port, {folder}); }
  std::string refusal() {
    const Result<PortLock> lock = acquire();
    return lock ? "acquired" : lock.error().message;
  }
  std::string content() const {
    std::ifstream in(lock_path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write_lock(const std::string& text) const { std::ofstream(lock_path) << text; }

  std::string folder, port, lock_name, lock_path;
};

TEST_F(PortLocks, AFileWithOurProcessIdAsOtherProgramsReadIt) {
  {
    const Result<PortLock> lock = acquire();
    ASSERT_TRUE(lock) << lock.error().message;
    EXPECT_THAT(lock->paths(), ElementsAre(lock_path));
    EXPECT_EQ(lock->notice(), "");
    EXPECT_EQ(std::stol(content().substr(0, 10)), ::getpid()) << content();
    EXPECT_THAT(content(), MatchesRegex(" *[0-9]+ fieldproof\n"));
    struct stat status {};
    ASSERT_EQ(::stat(lock_path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, 0644u) << "others must be able to read whose it is";
  }
  EXPECT_FALSE(fs::exists(lock_path));
  EXPECT_THAT(std::vector<fs::path>(fs::directory_iterator(folder), {}), SizeIs(1))
      << "the port alone is left";
}

TEST_F(PortLocks, ASecondUserIsToldWhoHasIt) {
  const Result<PortLock> first = acquire();
  ASSERT_TRUE(first);
  EXPECT_THAT(refusal(), HasSubstr("cannot open " + port + ": the port is in use by process " +
                                   std::to_string(::getpid()) + " ("));
  EXPECT_EQ(std::stol(content()), ::getpid()) << "the refused one leaves the lock alone";
}

TEST_F(PortLocks, ALinkIsTheSamePort) {
  const Result<PortLock> first = acquire();
  ASSERT_TRUE(first);
  fs::create_symlink(port, folder + "/by-id");
  EXPECT_THAT(PortLock::acquire(folder + "/by-id", {folder}).error().message,
              HasSubstr("the port is in use by process"));
}

TEST_F(PortLocks, AProgramThatLocksTheLinkIsRespected) {
  fs::create_symlink(port, folder + "/by-id");
  Bystander other;
  std::string of_link = "LCK.." + folder + "_by-id";
  std::ranges::replace(of_link, '/', '_');
  std::ofstream(folder + '/' + of_link) << other.pid() << '\n';
  EXPECT_THAT(PortLock::acquire(folder + "/by-id", {folder}).error().message,
              HasSubstr("in use by process " + std::to_string(other.pid())));
  EXPECT_FALSE(fs::exists(lock_path)) << "what was taken before is given back";
}

TEST_F(PortLocks, ADeviceHasASecondNameByItsNumbers) {
  const Result<PortLock> lock = PortLock::acquire("/dev/null", {folder});
  ASSERT_TRUE(lock);
  EXPECT_THAT(lock->paths(), ElementsAre(folder + "/LCK..null", folder + "/LCK.001.003"));
  EXPECT_TRUE(fs::exists(folder + "/LCK.001.003"));
}

TEST_F(PortLocks, AnotherNameThatIsTakenTakesNothing) {
  Bystander other;
  std::ofstream(folder + "/LCK.001.003") << other.pid() << '\n';
  const Result<PortLock> lock = PortLock::acquire("/dev/null", {folder});
  ASSERT_FALSE(lock);
  EXPECT_FALSE(fs::exists(folder + "/LCK..null"));
  EXPECT_TRUE(fs::exists(folder + "/LCK.001.003"));
}

TEST_F(PortLocks, AnotherProgramsLockIsRespected) {
  ::setenv("TZ", "UTC", 1);
  ::tzset();
  Bystander other;
  write_lock("  " + std::to_string(other.pid()) + " minicom root\n");
  const std::array<timespec, 2> when{timespec{1'774'000'000, 0}, timespec{1'774'000'000, 0}};
  ASSERT_EQ(::utimensat(AT_FDCWD, lock_path.c_str(), when.data(), 0), 0);
  std::string name;
  std::ifstream("/proc/self/comm") >> name;  // it is our child
  EXPECT_EQ(refusal(), "cannot open " + port + ": the port is in use by process " +
                           std::to_string(other.pid()) + " (" + name +
                           ") since 2026-03-20 09:46; end that process or choose another port (if "
                           "it does not use the port, delete " +
                           lock_path + ")");
}

TEST_F(PortLocks, ALockOfADeadProcessIsTakenOverWithANotice) {
  Bystander other;
  write_lock(std::to_string(other.pid()) + "\n");
  EXPECT_THAT(refusal(), HasSubstr("in use"));
  const pid_t dead = other.pid();
  other.end();
  const Result<PortLock> lock = acquire();
  ASSERT_TRUE(lock) << lock.error().message;
  EXPECT_THAT(lock->notice(), HasSubstr("took over the lock of " + port + ": process " +
                                        std::to_string(dead) + ", which locked it on 20"));
  EXPECT_EQ(std::stol(content()), ::getpid());
}

TEST_F(PortLocks, ALockOfOursThatNobodyHoldsIsStaleThoughItsProcessIdLives) {
  Bystander other;
  write_lock("      " + std::to_string(other.pid()) + " fieldproof\n");
  const Result<PortLock> lock = acquire();
  ASSERT_TRUE(lock) << lock.error().message;
  EXPECT_THAT(lock->notice(), HasSubstr("took over"));
}

TEST_F(PortLocks, AFileThatSaysNothingIsLeftAlone) {
  write_lock("?");
  EXPECT_THAT(refusal(), HasSubstr("the port is in use since 20"));
  EXPECT_EQ(content(), "?");
}

TEST_F(PortLocks, WhatSomebodyElseMadeMeanwhileStays) {
  {
    const Result<PortLock> lock = acquire();
    ASSERT_TRUE(lock);
    fs::remove(lock_path);
    write_lock("1\n");
  }
  EXPECT_EQ(content(), "1\n");
}

TEST_F(PortLocks, TheNextFolderIsTakenWhereTheFirstCannotBeWritten) {
  const Result<PortLock> lock = PortLock::acquire(port, {"/proc", "/no/such/folder", folder});
  ASSERT_TRUE(lock);
  EXPECT_THAT(lock->paths(), ElementsAre(lock_path));
}

TEST_F(PortLocks, WithoutAPortOrAFolderNothingIsHeld) {
  const Result<PortLock> no_port = PortLock::acquire("/dev/no_such_port", {folder});
  ASSERT_TRUE(no_port);
  EXPECT_THAT(no_port->paths(), IsEmpty());
  const Result<PortLock> no_folder = PortLock::acquire(port, {"/no/such/folder"});
  ASSERT_TRUE(no_folder);
  EXPECT_THAT(no_folder->paths(), IsEmpty());
}

TEST_F(PortLocks, TheUsersOwnFolderComesSecond) {
  ::setenv("XDG_RUNTIME_DIR", "/run/user/1000", 1);
  EXPECT_THAT(lock_folders(), ElementsAre("/var/lock", "/run/user/1000"));
  ::unsetenv("XDG_RUNTIME_DIR");
  EXPECT_THAT(lock_folders(), ElementsAre("/var/lock"));
}

}  // namespace
}  // namespace fieldproof::os
