// The harness and the reports know no protocol, no area and no model of a device: they are handed
// in. Here their sources are read for names; what may stay has a reason.
#include <gmock/gmock.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "harness/config_keys.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::suites {
namespace {

namespace fs = std::filesystem;

struct Allowed {
  std::string_view file;  // below the project's folder
  std::string_view name;
  std::string_view reason;
};
constexpr Allowed allowed[] = {
    {"harness/probe/conclusion.cpp", "cnet", "cites the manual on wiring, whatever is wired"},
    {"harness/bench/what_to_check.cpp", "cnet", "cites the manual on what makes a client ask"},
    {"harness/config_keys.hpp", "hs_link", "a key of a configuration, whoever reads it"},
    {"harness/config_keys.hpp", "modem", "a key of a configuration, whoever reads it"},
    {"harness/exchange/client_program.cpp", "email", "a key of p2p, whatever is asked beside it"},
    {"harness/paths.cpp", "user_frames", "a folder of data in the source tree"},
    {"harness/exchange/p2p_blocks.cpp", "esend", "functions of blocks that need no channel"},
    {"harness/exchange/p2p_blocks.cpp", "ereceive", "functions of blocks that need no channel"},
    {"reports/history/bench/main.cpp", "ls", "makes up a device to measure with"},
};

/// Source text with each comment as one blank; what stands in quotes is kept.
std::string without_comments(const std::string& text) {
  std::string code;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t raw = text.compare(i, 2, "R\"") == 0 ? text.find('(', i) : text.npos;
    if (raw != text.npos) {
      const std::string close = ')' + text.substr(i + 2, raw - i - 2) + '"';
      const std::size_t end = std::min(text.find(close, raw), text.size() - close.size());
      code += text.substr(i, end + close.size() - i);
      i = end + close.size();
    } else if (text.compare(i, 2, "//") == 0) {
      i = std::min(text.find('\n', i), text.size());
    } else if (text.compare(i, 2, "/*") == 0) {
      i = std::min(text.find("*/", i), text.size() - 2) + 2;
      code += ' ';
    } else if (text[i] == '"' || (text[i] == '\'' && (i == 0 || !std::isalnum(text[i - 1])))) {
      const char quote = text[i];
      do {
        if (text[i] == '\\') code += text[i++];
        code += text[i++];
      } while (i < text.size() && text[i] != quote);
      if (i < text.size()) code += text[i++];
    } else {
      code += text[i++];
    }
  }
  return code;
}

/// ModbusServer as Modbus_Server: the words of an identifier are words.
std::string with_humps_apart(const std::string& code) {
  static const std::regex hump("([a-z0-9])([A-Z])");
  return std::regex_replace(code, hump, "$1_$2");
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// A model's name that is no word of other meaning, such as emulator.
bool is_telling(const std::string& name) {
  return std::ranges::any_of(name, [](char c) { return c == '-' || (c >= '0' && c <= '9'); });
}

/// In lower case: protocols as options and folders have them, their families, and models.
std::set<std::string> names_of_the_suites() {
  std::set<std::string> names{"xgt",   "modbus", "rtu",   "mbap", "cnet", "fenet",    "xnet",
                              "omms",  "xinje",  "udata", "ls",   "lsis", "inverter", "modem",
                              "email", "smtp",   "xgb",   "xgk",  "xgi",  "xbl",      "xbm",
                              "xbc",   "xec",    "xd",    "xdc",  "px7",  "esend",    "ereceive"};
  for (const harness::Protocol* protocol : protocols()) {
    std::string name(protocol->name());
    names.insert(name);
    std::ranges::replace(name, '-', '_');
    names.insert(name);
    for (const std::string& model : protocol->models())
      if (is_telling(model)) names.insert(lower(model));
  }
  for (const auto& profile :
       fs::directory_iterator(fs::path(FIELDPROOF_SOURCE_DIR) / "suites" / "profiles"))
    if (const std::string name = profile.path().stem().string(); is_telling(name))
      names.insert(lower(name));
  return names;
}

/// Names in code that begin and end as words do, and addresses of PLC memory.
std::set<std::string> names_in(const std::string& code, const std::set<std::string>& names) {
  const std::string text = lower(with_humps_apart(code));
  const auto word = [&](std::size_t at) { return at < text.size() && std::isalnum(text[at]); };
  std::set<std::string> found;
  for (const std::string& name : names)
    for (std::size_t at = text.find(name); at != text.npos; at = text.find(name, at + 1))
      if (!word(at - 1) && !word(at + name.size())) found.insert(name);
  static const std::regex address("%[A-Za-z][XBWDLxbwdl][0-9]");
  for (std::sregex_iterator one(code.begin(), code.end(), address), end; one != end; ++one)
    found.insert(lower(one->str()));
  return found;
}

bool is_product(const fs::path& path) {
  const std::string name = path.filename().string();
  return (path.extension() == ".cpp" || path.extension() == ".hpp") &&
         !path.stem().string().ends_with("_test") && !name.starts_with("test_") &&
         path.string().find("testdata") == std::string::npos;
}

TEST(Names, HarnessAndReportsKnowNoProtocolAreaOrModel) {
  const fs::path root = FIELDPROOF_SOURCE_DIR;
  const std::set<std::string> names = names_of_the_suites();
  std::set<const Allowed*> used;
  std::vector<std::string> problems;
  int files = 0;
  for (const char* room : {"harness", "reports"})
    for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
      if (!entry.is_regular_file() || !is_product(entry.path())) continue;
      ++files;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      const std::string file = entry.path().lexically_relative(root).string();
      for (const std::string& name : names_in(without_comments(text.str()), names)) {
        const auto reason = std::ranges::find_if(
            allowed, [&](const Allowed& one) { return one.file == file && one.name == name; });
        if (reason != std::end(allowed))
          used.insert(&*reason);
        else
          problems.push_back(fmt::format("{} names {}: let the protocol supply it", file, name));
      }
    }
  EXPECT_GT(files, 100);
  EXPECT_THAT(problems, testing::IsEmpty());
  for (const Allowed& one : allowed)
    EXPECT_TRUE(used.contains(&one)) << one.file << " names " << one.name << " no more";
}

/// Nobody asks whether a kind of endpoint, a protocol or a model has this name: tables have flags.
std::vector<std::string> questions_for_names(const std::string& code) {
  static const std::regex question(
      R"re((\b(name\(\)|protocol|model)\s*[=!]=\s*"[^"]+"|\bkind\s*[=!]=\s*"(emulator|pty|serial|rfc2217|tcp|udp|listen|exec)"))re");
  std::vector<std::string> found;
  for (std::sregex_iterator one(code.begin(), code.end(), question), end; one != end; ++one)
    found.push_back(one->str());
  return found;
}

TEST(Names, NobodyAsksForThem) {
  const fs::path root = FIELDPROOF_SOURCE_DIR;
  std::vector<std::string> problems;
  for (const char* room : {"harness", "reports"})
    for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
      if (!entry.is_regular_file() || !is_product(entry.path())) continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      for (const std::string& question : questions_for_names(without_comments(text.str())))
        problems.push_back(entry.path().lexically_relative(root).string() + ": " + question);
    }
  EXPECT_THAT(problems, testing::IsEmpty());
  EXPECT_THAT(questions_for_names("if (name.kind == \"tcp\") x(p.name() != \"udata\");"),
              testing::ElementsAre("kind == \"tcp\"", "name() != \"udata\""));
  EXPECT_THAT(questions_for_names(
                  "kinds == \"tcp\" || kind == other || kind == \"damage\" || model == \"\""),
              testing::IsEmpty());
}

TEST(Names, AreFoundInCodeAndInQuotesAndNotInComments) {
  const std::set<std::string> names = names_of_the_suites();
  const auto found = [&](const std::string& text) {
    return names_in(without_comments(text), names);
  };
  using testing::ElementsAre, testing::IsEmpty;
  EXPECT_THAT(found("if (model == \"xbm-s\") x();"), ElementsAre("xbm", "xbm-s"));
  EXPECT_THAT(found("R\"(a // xbm-s)\" // xbc-h\n"), ElementsAre("xbm", "xbm-s"));
  EXPECT_THAT(found("modbus::Server server;"), ElementsAre("modbus"));
  EXPECT_THAT(found("ModbusServer server; isXbcH();"), ElementsAre("modbus", "xbc"));
  EXPECT_THAT(found("\"write %MW100\""), ElementsAre("%mw1"));
  EXPECT_THAT(found("// as xgt-cnet\n/* %MW0 */ int executor = '\"'; // \"xbc\""), IsEmpty());
}

void add_config_keys(const nlohmann::json& value, std::set<std::string>& keys) {
  if (!value.is_structured()) return;
  if (value.is_object() && value.contains("given") && value["given"].contains("config"))
    for (const auto& [key, ignored] : value["given"]["config"].items()) keys.insert(key);
  for (const nlohmann::json& one : value) add_config_keys(one, keys);
}

/// A profile that declares another key has a slip.
TEST(ConfigKeys, AreThoseOfAllVectors) {
  std::set<std::string> keys;
  for (const fs::directory_entry& one :
       fs::recursive_directory_iterator(FIELDPROOF_SOURCE_DIR "/vectors"))
    if (one.path().extension() == ".json")
      add_config_keys(nlohmann::json::parse(std::ifstream(one.path())), keys);
  EXPECT_GT(keys.size(), 40u);
  for (const std::string& key : keys) EXPECT_TRUE(harness::is_config_key(key)) << key;
}

}  // namespace
}  // namespace fieldproof::suites
