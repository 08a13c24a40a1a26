#include "harness/cli/version.hpp"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <sqlite3.h>
#include <CLI/Version.hpp>
#include <boost/version.hpp>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <string_view>

#include "harness/run/tool_vectors.hpp"
#include "reports/text/fold.hpp"

namespace fieldproof::cli {

namespace {

constexpr std::string_view compiler =
#ifdef __clang__
    "clang " __clang_version__;
#else
    "g++ " __VERSION__;
#endif

std::string dotted(int major, int minor, int patch) {
  return fmt::format("{}.{}.{}", major, minor, patch);
}

/// The second word of "OpenSSL 3.0.17 1 Jul 2025".
std::string openssl_version() {
  const std::string_view text = OpenSSL_version(OPENSSL_VERSION);
  const std::size_t begin = text.find(' ') + 1;
  return std::string(text.substr(begin, text.find(' ', begin) - begin));
}

}  // namespace

std::string version_text(const harness::Protocols& protocols) {
  const std::string hash =
      vectors::load_vectors(run::vectors_path(""), {protocols, "none", {}}).hash;
  return text::fold(
      fmt::format("fieldproof {} ({})\nvectors     {}\ncompiler    {}\nlibraries   Boost {}, CLI11 "
                  "{}, fmt {}, "
                  "GoogleTest {}, nlohmann-json {}, OpenSSL {}, pugixml {}, SQLite {}",
                  FIELDPROOF_VERSION, FIELDPROOF_RELEASED, hash, compiler,
                  dotted(BOOST_VERSION / 100'000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100),
                  CLI11_VERSION,
                  dotted(FMT_VERSION / 10'000, FMT_VERSION / 100 % 100, FMT_VERSION % 100),
                  FIELDPROOF_GTEST_VERSION,
                  dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                         NLOHMANN_JSON_VERSION_PATCH),
                  openssl_version(),
                  fmt::format("{}.{}", PUGIXML_VERSION / 1000, PUGIXML_VERSION / 10 % 100),
                  sqlite3_libversion()),
      80);
}

}  // namespace fieldproof::cli
