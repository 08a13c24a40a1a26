// The Debian package, made by cpack from the tool that was built.
#include <gmock/gmock.h>

#include <memory>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Finished in_shell(const std::string& command) { return run_program({"sh", "-c", command}); }

class Package : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TestFolder>();
    if (in_shell("command -v dpkg-shlibdeps && command -v gzip").code != 0) return;
    const Finished finished =
        run_program({"cpack", "--config", FIELDPROOF_BINARY_DIR "/CPackConfig.cmake", "-D",
                     "CPACK_DEBIAN_COMPRESSION_TYPE=gzip", "-B", folder_->path()});
    ASSERT_EQ(finished.code, 0) << finished.out << finished.err;
    for (const auto& entry : std::filesystem::directory_iterator(folder_->path()))
      if (entry.path().extension() == ".deb") file_ = entry.path();
    ASSERT_FALSE(file_.empty()) << finished.out;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  void SetUp() override {
    if (file_.empty()) GTEST_SKIP() << "dpkg-shlibdeps (package dpkg-dev) is not installed";
  }

  static std::string field(const std::string& name) {
    return run_program({"dpkg-deb", "--field", file_, name}).out;
  }

  /// Package manager of a root of its own, in which nothing is installed but what the package says
  /// that it needs, in the versions of this computer.
  static Finished dpkg(const std::string& arguments) {
    const std::string as_root = ::getuid() == 0 ? "" : "unshare --map-root-user ";
    return in_shell(as_root + "dpkg --root=" + (*folder_ / "root") +
                    " --force-not-root --log=" + (*folder_ / "dpkg.log") + ' ' + arguments);
  }

  static void make_root() {
    for (const char* part : {"info", "updates", "triggers"})
      std::filesystem::create_directories(*folder_ / (std::string("root/var/lib/dpkg/") + part));
    folder_->write("root/var/lib/dpkg/status",
                   in_shell("for one in $(dpkg-deb --field " + file_ +
                            " Depends | sed 's/([^)]*)//g; s/,/ /g'); do dpkg-query --status "
                            "$one; echo; done")
                       .out);
  }

  static inline std::unique_ptr<TestFolder> folder_;
  static inline std::string file_;
};

TEST_F(Package, says_what_it_is) {
  EXPECT_EQ(field("Package"), "fieldproof\n");
  EXPECT_EQ(field("Version"), std::string(FIELDPROOF_VERSION) + '\n');
  EXPECT_THAT(field("Depends"), AllOf(HasSubstr("libc6 (>= "), HasSubstr("libstdc++6"),
                                      HasSubstr("libssl3"), HasSubstr("libpugixml1v5")));
  for (const char* name : {"Maintainer", "Section", "Description", "Architecture"})
    EXPECT_THAT(field(name), Not(IsEmpty())) << name;
}

TEST_F(Package, holds_all_that_is_installed) {
  const std::string list = run_program({"dpkg-deb", "--contents", file_}).out;
  for (const char* path :
       {"/usr/bin/fieldproof", "/usr/share/fieldproof/vectors/schema.json",
        "/usr/share/fieldproof/profiles/xbc-h.json", "/usr/share/man/man1/fieldproof.1.gz",
        "/usr/share/bash-completion/completions/fieldproof",
        "/usr/share/zsh/vendor-completions/_fieldproof",
        "/usr/share/fish/vendor_completions.d/fieldproof.fish",
        "/usr/include/fieldproof/src/base/bytes.hpp",
        "/usr/lib/cmake/fieldproof/fieldproof-config.cmake", "/usr/share/doc/fieldproof/copyright",
        "/usr/share/doc/fieldproof/changelog.gz"})
    EXPECT_THAT(list, HasSubstr(std::string(path) + '\n'));
  EXPECT_THAT(list, testing::AnyOf(HasSubstr("/usr/lib/fieldproof/libsrc_base.a\n"),
                                   HasSubstr("/usr/lib/fieldproof/libwing_src.a\n")))
      << "of each room, or of all in one piece";
}

/// The libraries are those of this computer: the root has none.
TEST_F(Package, is_installed_runs_and_is_removed) {
  make_root();
  const Finished installed = dpkg("--install " + file_);
  ASSERT_EQ(installed.code, 0) << installed.out << installed.err;
  EXPECT_THAT(dpkg("--status fieldproof").out, HasSubstr("Status: install ok installed\n"));

  const std::string tool = *folder_ / "root/usr/bin/fieldproof";
  const ProcessOptions elsewhere{.environment = {}, .folder = folder_->path()};
  EXPECT_EQ(run_program({tool, "--version"}, elsewhere).out, run_tool({"--version"}).out);
  const Finished run = run_program({tool, "run", "--filter", "*/examples/*"}, elsewhere);
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  expect_reports(*folder_ / "fieldproof-out");
  EXPECT_THAT(in_shell("gzip -dc " + (*folder_ / "root/usr/share/man/man1/fieldproof.1.gz")).out,
              testing::Eq(run_tool({"man"}).out));

  const Finished removed = dpkg("--purge fieldproof");
  EXPECT_EQ(removed.code, 0) << removed.err;
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "root/usr/share/fieldproof"));
  EXPECT_FALSE(std::filesystem::exists(tool));
}

TEST_F(Package, lintian_finds_no_error) {
  if (in_shell("command -v lintian").code != 0) GTEST_SKIP() << "lintian is not installed";
#ifdef FIELDPROOF_SANITIZED
  GTEST_SKIP() << "nobody ships what sanitizers instrument";
#endif
  const Finished lint = run_program({"lintian", "--allow-root", "--fail-on", "error", file_});
  EXPECT_EQ(lint.code, 0) << lint.out << lint.err;
}

}  // namespace
}  // namespace fieldproof::tool_tests
