#include "harness/usage/option_groups.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <utility>
#include <vector>

namespace fieldproof::usage {

namespace {

const std::array<std::pair<const char*, std::vector<const char*>>, 7> groups{{
    {"The device",
     {"--endpoint", "--bench", "--dut", "--profile", "--protocol", "--role", "--stimulus", "--aux",
      "--control", "--wait-port"}},
    {"The cases",
     {"--filter", "--vectors", "--derived", "--requests", "--seed", "--repeat", "--matrix",
      "--reconfigure", "--duration", "--dry-run"}},
    {"What a real device allows",
     {"--allow-write", "--allow-motion", "--read-only", "--journal", "--discard-journal",
      "--power-cycle"}},
    {"What the link can show", {"--floor", "--loop"}},
    {"The gate",
     {"--strict", "--fail-on", "--qualify", "--min-judged", "--waivers", "--baseline",
      "--skip-absent"}},
    {"When to stop", {"--fail-fast", "--max-failures", "--max-restarts"}},
    {"Reports",
     {"--out", "--junit", "--json", "--html", "--capture", "--csv", "--history", "--verbose"}},
}};

}  // namespace

void group_options(CLI::App& app) {
  for (const auto& [group, names] : groups)
    for (const char* name : names)
      if (CLI::Option* option = app.get_option_no_throw(name)) option->group(group);
}

}  // namespace fieldproof::usage
