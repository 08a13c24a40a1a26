// Every command of README.md, run as it stands there but for what the list below says.
#include <gmock/gmock.h>

#include <algorithm>
#include <list>
#include <map>

#include "harness/system/sockets/test_sockets.hpp"
#include "suites/tool/readme_commands.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ReadmeCommands, stand_in_blocks_recipes_prose_and_tables) {
  EXPECT_THAT(commands_of("Text, `./run.sh list`, `run` and `fieldproof`.\n"
                          "```\n"
                          "./run.sh     # all\n"
                          "$ ./run.sh\n"
                          "socat a \\\n"
                          "      b &\n"
                          "6466 cases\n"
                          "  replay    fieldproof run --filter 'x'\n"
                          "```\n"
                          "| command | what |\n"
                          "|---|---|\n"
                          "| `merge A B` | `cmake not here` |\n"
                          "\n"
                          "| folder | what |\n"
                          "| `run x` | |\n"
                          "```yaml\n"
                          "  script: ./run.sh run\n"
                          "  - run: ./run.sh lint\n"
                          "  stage { sh './run.sh run --endpoint \"x\"' }\n"
                          "```\n"),
              ElementsAre("./run.sh list", "./run.sh", "socat a b &", "fieldproof run --filter 'x'",
                          "fieldproof merge A B", "./run.sh run", "./run.sh lint",
                          "./run.sh run --endpoint \"x\""));
}

/// How a command differs from what README prints, and from one that ends with 0.
struct Special {
  std::string replaced = "", by = "";  // a placeholder, or what a test must not use
  int code = 0;
  const char* shows = nullptr;    // it goes on until it is ended; this, when it is ready
  const char* not_run = nullptr;  // why
};

/// What the recipes of a gate select takes a minute each; Readme.RecipesPassAsPrinted runs it.
constexpr const char* all_of_a_gate = "*:-xgt_cnet/line/*:-*/timing/*:-*/status_by_service/*";
constexpr const char* a_few = "xgt_cnet/rs*/*refused/*";

const std::map<std::string, Special> specials{
    {"./test.sh", {.not_run = "it is what runs this test"}},
    {"./fuzz.sh 1", {.not_run = "it builds with another compiler and takes twenty minutes"}},
    {"cmake --preset tsan && cmake --build --preset tsan && ctest --preset tsan",
     {.not_run = "it builds all of the tests anew"}},
    {"cmake --build --preset plain && build/plain/fieldproof_bench",
     {.not_run = "fieldproof_bench is a test itself"}},
    {"cmake --preset plain -DFIELDPROOF_MUTANTS=ON && cmake --build --preset plain --target "
     "mutants",
     {.not_run =
          "it takes too long; suites_mutants_tests and suites_mutants_rules test its parts"}},
    {"./run.sh lint --manuals DIR --lock",
     {.not_run = "the text of the manuals is not ours to ship, and vectors would be locked"}},
    {"fieldproof emulate", {.not_run = "the name of a command, in a sentence"}},
    {"sbatch --array=0-3 --gres=plc:xbc:1 -C xbl-c41a "
     "/usr/share/fieldproof/farm/fieldproof-array.sbatch '/shared/benches/{node}.json' OUT --role "
     "server",
     {.not_run = "it wants a farm; suites/farm/slurm_test.py makes one"}},
    {"./run.sh emulate 'xbc-h?line=38400-8E1' --tty /dev/ttyUSB1",
     {.not_run = "it wants a real port; suites/uart/uart_test.py has two"}},
    {"fieldproof init",
     {.replaced = "init", .by = "init --yes --endpoint emulator:xbc-h --no-run"}},
    {"./run.sh init",
     {.replaced = "init", .by = "init --yes --endpoint emulator:xbc-h --name mine --no-run"}},
    {"cpack --config build/tool/CPackConfig.cmake", {.not_run = "Package makes one"}},
    {"./run.sh ARGUMENTS", {.replaced = "ARGUMENTS", .by = "list"}},
    {"./run.sh explore --endpoint 'exec:./my_plc {tty}' --profile xbc-dxxxh --requests 500 --seed "
     "7",
     {.replaced = "--requests 500", .by = "--requests 30"}},
    {"fieldproof run --derived",
     {.replaced = "--derived", .by = "--derived --filter 'ls_bus/read/*'"}},
    {"fieldproof explore --requests 100000", {.replaced = "100000", .by = "300"}},
    {"./run.sh run --derived --filter 'modbus_rtu/*/derived/*'",
     {.replaced = "modbus_rtu/*/derived/*", .by = "modbus_rtu/examples/*/derived/cut"}},
    {"./run.sh explore --protocol modbus-rtu --seed 7 --requests 20000",
     {.replaced = "20000", .by = "500"}},
    {"./run.sh run --filter 'YOUR/ID'", {.replaced = "YOUR/ID", .by = "xgt_cnet/rss/two_words/*"}},
    {"./run.sh run --endpoint 'serial:/dev/serial/by-id/usb-FTDI...?baud=38400&frame=8N1&rs485=1"
     "&station=1' --profile xbc-dxxxh --allow-write M100-M199,D0-D99",
     // A pty stands in for the adapter; it knows no RS-485.
     {.replaced = "/dev/serial/by-id/usb-FTDI...?baud=38400&frame=8N1&rs485=1",
      .by = "adapter?baud=38400&frame=8N1"}},
    {"socat pty,raw,echo=0,link=/tmp/bench pty,raw,echo=0,link=/tmp/plc &",
     {.replaced = "socat ", .by = "socat -d -d ", .shows = "starting data transfer loop"}},
    {"./run.sh emulate xbc-h --pty /tmp/plc -v &", {.shows = "plc"}},
    {"./run.sh run --endpoint 'tcp:192.168.1.10?protocol=modbus-tcp' --profile xbc-dxxxh "
     "--role server --allow-write M0-M199 --min-judged 80%",
     // An emulator of this test stands in for the PLC at that address.
     {.replaced = "192.168.1.10", .by = "127.0.0.1:$PORT"}},
    {"./run.sh emulate 'xbc-h?protocol=modbus-tcp' --tcp 1502 -v",
     {.replaced = "1502", .by = "0", .shows = "tcp 127.0.0.1:"}},
    {"./run.sh emulate 'xbc-h?protocol=xgt-fenet' --tcp 2004 --udp 2005 -v",
     {.replaced = "2004 --udp 2005", .by = "0 --udp 0", .shows = "tcp 127.0.0.1:"}},
    {"./run.sh emulate suites/user_frames/examples/balance.json --tcp 127.0.0.1:2000",
     {.replaced = ":2000", .by = ":0", .shows = "127.0.0.1:"}},
    {"./run.sh run --endpoint serial:/dev/ttyUSB0?baud=19200 --aux tcp:192.168.6.7 --profile "
     "xinje-xd --filter 'xnet/*' --allow-write D,M,SD",
     {.not_run = "it wants two PLCs; TwoPlcs runs it on emulated ones"}},
    {"./run.sh emulate 'xd3?protocol=modbus-tcp' --config suites/xnet/examples/plc-a.json --tcp "
     "1502 "
     "--bus 7001 &",
     {.replaced = "1502 --bus 7001", .by = "0 --bus 0", .shows = "bus 127.0.0.1"}},
    {"./run.sh emulate 'xd5?protocol=modbus-rtu' --config suites/xnet/examples/plc-b.json --tcp "
     "1503 "
     "--bus 7001 &",
     {.replaced = "1503 --bus 7001", .by = "0 --bus 0", .shows = "bus 127.0.0.1"}},
    {"./run.sh emulate 'xbc-h?protocol=email' --p2p suites/email/examples/mail.json -v",
     {.shows = "a network, where it connects to others"}},
    {"fieldproof emulate xbc-h --tcp 127.0.0.1:2000",
     {.replaced = ":2000", .by = ":0", .shows = "127.0.0.1:"}},
    {"fieldproof run --endpoint 'exec:build/plain/xgt_cnet_broken_server 0011_for_1132 {tty}' "
     "--profile 'xbc-h' --filter 'xgt_cnet/rss/refused/lower'",
     {.code = 1}},
    {"fieldproof run --endpoint 'exec:python3 suites/example/inverter.py {tty} {station} "
     "{write_order}' --control - --profile inverter --filter 'ls_bus/*' --role server --min-judged "
     "97%",
     // ReadmeTable runs all of it.
     {.replaced = "ls_bus/*", .by = "ls_bus/read/*"}},
    // Hostile devices: whatever they do, the run ends by itself, and the bench says that it is
    // trouble.
    {"fieldproof run --endpoint 'exec:python3 suites/tool/testdata/device.py flood {tty} 30' "
     "--profile xbc-h --filter 'xgt_cnet/*' --role server",
     {.not_run = "HostileDevices runs it"}},
    {"fieldproof run --endpoint 'exec:python3 suites/tool/testdata/device.py flood {port} "
     "30?protocol=modbus-tcp' --profile xbc-h --filter 'modbus_tcp/*' --role server",
     {.not_run = "HostileDevices runs it"}},
    {"fieldproof run --max-failures N", {.replaced = " N", .by = " 2"}},
    {"fieldproof run --duration 8h", {.replaced = "8h", .by = "1s"}},
    {"fieldproof run --waivers FILE", {.replaced = "FILE", .by = "waivers.json"}},
    {"fieldproof compare OLD NEW...", {.replaced = "NEW...", .by = "NEW"}},
    {"fieldproof history add RESULT...", {.replaced = "RESULT...", .by = "OLD RESULT"}},
    {"fieldproof probe ENDPOINT", {.replaced = "ENDPOINT", .by = "serial:adapter"}},
    {"fieldproof report results.ndjson --junit F --html F",
     {.replaced = "--html F", .by = "--html F.html"}},
};

/// A folder that has what the commands name: the tool, a program that is a PLC, an adapter, a bench
/// file, results of earlier runs under the names that README gives them.
class ReadmeRuns : public testing::Test {
 protected:
  ReadmeRuns() {
    namespace fs = std::filesystem;
    fs::create_directories(folder_ / "build/plain");
    fs::create_directories(folder_ / "DIR");
    fs::create_directory_symlink(FIELDPROOF_SOURCE_DIR "/suites", folder_ / "suites");
    fs::create_directory_symlink(FIELDPROOF_BINARY_DIR, folder_ / "build/tool");
    fs::create_symlink(BROKEN_SERVER, folder_ / "build/plain/xgt_cnet_broken_server");
    // What is not about a selection runs a few cases: a real line takes its time for each, and the
    // default run has a test of its own.
    script("bin/fieldproof",
           "case \"$1 $* \" in\n"
           "  *' --filter '*|*' --vectors '*|*--help*) ;;\n"
           "  'run run '*modbus-tcp*) set -- \"$@\" --filter 'modbus_tcp/examples/read_h*' ;;\n"
           "  'run run '*) set -- \"$@\" --filter 'xgt_cnet/rs*/*refused/*:xgt_cnet/client/run/*' "
           ";;\n"
           "esac\n"
           "exec " FIELDPROOF_TOOL " \"$@\"");
    script("run.sh", "[ $# -gt 0 ] || set -- run\nexec fieldproof \"$@\"");
    script("my_plc", "exec " FIELDPROOF_TOOL " emulate xbc-h --pty \"$1\"");
    script("bin/srun",
           "shift\n"
           "for i in 0 1 2 3; do SLURM_NTASKS=4 SLURM_PROCID=$i \"$@\" & all=\"$all $!\"; done\n"
           "for one in $all; do wait $one || exit; done");
    make_bench_file();
    make_results();
  }

  void script(const std::string& name, const std::string& text) {
    std::filesystem::permissions(folder_.write(name, "#!/bin/sh\n" + text + "\n"),
                                 std::filesystem::perms::owner_all);
  }

  void make_bench_file() {
    nlohmann::ordered_json devices;
    for (const char* name : {"NAME", "A", "B"})
      devices[name] = {{"endpoint", "exec:" + (folder_ / "my_plc") + " {tty}"},
                       {"profile", "xbc-h"},
                       {"identity", {{"maker", "LS"}, {"serial", name}}}};
    folder_.write("FILE", nlohmann::ordered_json{{"devices", devices}}.dump());
    folder_.write("waivers.json", "[]");
  }

  void make_results() {
    for (const std::string name : {"OLD", "NEW", "RESULT", "results.ndjson", "A", "B"}) {
      std::vector<std::pair<std::string, std::string>> shard;
      if (name == "A" || name == "B")
        shard = {{"GTEST_TOTAL_SHARDS", "2"}, {"GTEST_SHARD_INDEX", name == "A" ? "0" : "1"}};
      const std::string out = shard.empty() ? folder_ / ("out_" + name) : folder_ / name;
      EXPECT_EQ(run_tool({"run", "--filter", "xgt_cnet/rss/*", "--out", out},
                         {.environment = shard, .folder = ""})
                    .code,
                0);
      if (shard.empty()) std::filesystem::copy_file(out + "/results.ndjson", folder_ / name);
    }
  }

  /// What an interrupted run has left. A later run on this port that may write would be refused.
  void make_journal(const std::string& name) {
    folder_.write(name, R"({"saved":{"address":"%MW100","config":{},"endpoint":"serial:adapter",)"
                        R"("model":"xbc-h","number":1,"protocol":"xgt-cnet","station":1,)"
                        R"("value":"1234"}})"
                        "\n");
  }

  Process& start(const std::string& command) {
    return processes_.emplace_back(
        std::vector<std::string>{"bash", "-c", command},
        ProcessOptions{.environment = {{"PATH", (folder_ / "bin:") + std::getenv("PATH")},
                                       {"XDG_DATA_HOME", folder_ / "data"}},
                       .folder = folder_.path()});
  }

  void plug_in_adapter() {
    EXPECT_TRUE(start("exec socat -d -d pty,raw,echo=0,link=adapter pty,raw,echo=0,link=far")
                    .wait_for("starting data transfer loop"));
    EXPECT_TRUE(start("exec fieldproof emulate xbc-h --pty far").wait_for("far"));
    EXPECT_TRUE(start("exec fieldproof emulate 'xbc-h?protocol=modbus-tcp' --tcp " + port_)
                    .wait_for("tcp 127.0.0.1:" + port_));
  }

  void run(std::string command, const Special& special) {
    SCOPED_TRACE(command);
    if (special.not_run) return;
    constexpr std::string_view restores = "fieldproof restore ";
    if (command.starts_with(restores)) make_journal(command.substr(restores.size()));
    if (!special.replaced.empty()) {
      const std::size_t at = command.find(special.replaced);
      ASSERT_NE(at, std::string::npos) << special.replaced;
      command.replace(at, special.replaced.size(), special.by);
    }
    if (const std::size_t at = command.find(all_of_a_gate); at != std::string::npos)
      command.replace(at, std::string_view(all_of_a_gate).size(), a_few);
    for (std::size_t at; (at = command.find("/tmp/")) != std::string::npos;) command.erase(at, 5);
    if (const std::size_t at = command.find("$PORT"); at != std::string::npos)
      command.replace(at, 5, port_);
    if (command.ends_with(" &")) command.erase(command.size() - 2);
    Process& process = start(special.shows ? "exec " + command : command);
    if (special.shows) {
      EXPECT_TRUE(process.wait_for(special.shows));
      return;
    }
    const Finished finished = process.wait(Process::Limit(300));
    EXPECT_EQ(finished.code, special.code) << finished.out.substr(0, 4000) << finished.err;
    processes_.pop_back();
  }

  TestFolder folder_;
  const std::string port_ = std::to_string(os::test::port_of(os::test::bound(SOCK_STREAM)));
  std::list<Process> processes_;  // those that go on, until the end
};

std::vector<std::string> readme_commands() {
  return commands_of(read_text(FIELDPROOF_SOURCE_DIR "/README.md"));
}

TEST(ReadmeCommands, each_special_one_is_there) {
  const std::vector<std::string> commands = readme_commands();
  for (const auto& [command, special] : specials) EXPECT_THAT(commands, testing::Contains(command));
}

TEST_F(ReadmeRuns, each_command_runs) {
  plug_in_adapter();
  const std::vector<std::string> commands = readme_commands();
  EXPECT_GT(commands.size(), 30u);
  for (const std::string& command : commands) {
    const auto special = specials.find(command);
    run(command, special == specials.end() ? Special{} : special->second);
  }
}

}  // namespace
}  // namespace fieldproof::tool_tests
