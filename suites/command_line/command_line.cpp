#include "suites/command_line/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>

#include "harness/cli/commands.hpp"
#include "harness/cli/usage_commands.hpp"
#include "harness/cli/version.hpp"
#include "harness/usage/completion_scripts.hpp"
#include "harness/usage/option_groups.hpp"
#include "src/base/spelling.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::suites {

namespace {

/// Appears in every help text, so that a pipeline's author need not open the README.
constexpr const char* exit_codes =
    "Exit codes: 0 gate met, 1 gate not met (conformance failed, or less judged than --qualify or "
    "--min-judged asks), 2 usage or invalid input, 3 bench trouble, 4 nothing selected or "
    "executed, 77 hardware absent (--skip-absent), 130 interrupted.";

/// "90%" or "90".
double percent_of(const std::string& text) {
  const std::string digits = text.substr(0, text.size() - (text.ends_with('%') ? 1 : 0));
  char* end = nullptr;
  const double percent = std::strtod(digits.c_str(), &end);
  if (digits.empty() || *end != '\0' || !(percent > 0 && percent <= 100))
    throw CLI::ValidationError("--min-judged", fmt::format("'{}' is no share; write 90%", text));
  return percent;
}

/// What fails the gate, for commands that judge.
template <typename Options>
void add_gate(CLI::App& app, Options& options) {
  app.add_flag("--strict", options.strict, "NON-STRICT fails the gate");
  app.add_option_function<std::string>(
         "--fail-on", [&options](const std::string&) { options.fail_on_marginal = true; },
         "marginal: MARGINAL fails the gate")
      ->check(CLI::IsMember({"marginal"}));
  app.add_flag("--qualify", options.qualify, "BLOCKED and INCONCLUSIVE fail the gate");
  app.add_option_function<std::string>(
      "--min-judged",
      [&options](const std::string& text) { options.min_judged = percent_of(text); },
      "90%: less judged of what the device declares (all but SKIP) fails the gate");
}

void add_role(CLI::App& app, std::string& role) {
  app.add_option("--role", role, "Only cases of a device that asks (client), or answers (server)")
      ->check(CLI::IsMember({"client", "server"}));
}

void add_judge(CLI::App& app, cli::JudgeOptions& judge) {
  app.add_option("results", judge.file, "OUT/results.ndjson or OUT/results.json")->required();
  app.add_option("--profile", judge.profile, "Judge by another profile than it was recorded with");
  app.add_option("--filter", judge.filter,
                 "Cases by id: globs separated by ':', a leading '-' excludes");
  app.add_option("--vectors", judge.vectors, "Another folder of vectors");
  app.add_option("--waivers", judge.waivers, "JSON file of accepted failures");
  app.add_option("--out", judge.out, "Folder of the reports")->capture_default_str();
  app.add_option("--junit", judge.junit, "JUnit file, instead of OUT/junit.xml");
  app.add_option("--json", judge.json, "JSON file, instead of OUT/results.json");
  app.add_option("--html", judge.html, "HTML file, instead of OUT/report.html");
  add_gate(app, judge);
  app.add_flag("-v,--verbose", judge.verbose, "Show every case with its exchange");
}

void add_run(CLI::App& app, run::RunOptions& run) {
  app.add_option("--endpoint", run.endpoint,
                 "emulator:[MODEL][?option=value&...], pty:MODEL, "
                 "serial:PATH?baud=38400&frame=8N1&station=1, exec:COMMAND ({tty} is the port), "
                 "tcp:HOST:PORT")
      ->default_str("emulator:");
  app.add_option(
      "--bench", run.bench,
      "JSON file of the devices on this bench; --dut names one, and other options override it");
  app.add_option("--dut", run.duts,
                 "Device of the bench file: gives endpoint, profile, --allow-write and identity; "
                 "several (--dut A --dut B) share the cases; model=XBL-C41A (maker=, serial=, "
                 "firmware=) names all that are so")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--profile", run.profile,
                 "What the device declares: a name from the profiles folder, or a JSON file");
  app.add_option("--filter", run.filter,
                 "Cases by id: globs separated by ':', a leading '-' excludes");
  app.add_option("--protocol", run.protocol,
                 "Which protocol of the profile the endpoint speaks (default the one that --filter "
                 "selects, else the first)");
  add_role(app, run.role);
  app.add_option("--stimulus", run.stimulus,
                 "Client role: command that makes the device ask, told by lines of JSON; -: the "
                 "program of exec: itself");
  app.add_option("--control", run.control,
                 "Command that sets the device up as each case needs it (configuration, inputs, "
                 "stop), told by lines of JSON; -: the program of exec: itself");
  app.add_option("--aux", run.aux,
                 "A second port of the same PLC, as server: serial:PATH?station=3; for memory that "
                 "--endpoint cannot reach");
  app.add_flag(
      "--derived", run.derived,
      "Also what a bad line makes of each request: bits flipped, bytes lost, doubled, cut, "
      "paused, noise, frames joined");
  app.add_option("--vectors", run.vectors, "Another folder of vectors");
  app.add_option("--out", run.out, "Folder of the reports")->capture_default_str();
  app.add_option("--junit", run.junit, "JUnit file, instead of OUT/junit.xml");
  app.add_option("--json", run.json, "JSON file, instead of OUT/results.json");
  app.add_option("--html", run.html,
                 "HTML file, instead of OUT/report.html; with --qualify it holds a sheet to sign");
  app.add_option("--capture", run.capture,
                 "The traffic as pcapng for Wireshark; Modbus RTU: tshark -d rtacser.data,mbrtu");
  app.add_option("--csv", run.csv,
                 "Folder of tables of what a model did, a file a case: how axes moved, and who had "
                 "the token");
  app.add_option("--waivers", run.waivers,
                 "JSON file of accepted failures: id, reason, owner, text, expires, firmware");
  app.add_option("--baseline", run.baseline,
                 "Results of an earlier run, or `last`, the last run of this device in the "
                 "history: what got worse since then fails the gate");
  app.add_option("--history", run.history,
                 "Adds this run to the history in this file, for `fieldproof history`; --baseline "
                 "last reads it, too");
  app.add_option("--allow-write", run.allow_write,
                 "Real devices: what may be written: M, M100-M199, h1230-h12FF, all (outputs P, Q, "
                 "U only when named). Of exec: anything, where this is not given");
  app.add_option("--allow-motion", run.allow_motion,
                 "Real devices: axes that may move: 1, 3-5, of a second PLC B:1, all; without it "
                 "nothing that moves an axis is sent");
  app.add_flag("--read-only", run.read_only, "Write nothing, to exec: neither");
  app.add_option(
      "--journal", run.journal,
      "Real devices: what they held before, instead of OUT/journal.ndjson; see fieldproof restore");
  app.add_flag("--discard-journal", run.discard_journal,
               "Forget what an earlier run on this device did not put back");
  app.add_option("--power-cycle", run.power_cycle,
                 "Command that switches a real device off and on");
  app.add_option(
      "--floor", run.floor,
      "The link's own uncertainty, instead of measuring it: 2ms; shorter limits are INCONCLUSIVE");
  app.add_option("--loop", run.loop,
                 "Measure the link's uncertainty here, where `fieldproof emulate` answers over the "
                 "same kind of adapter");
  app.add_option("--matrix", run.matrix,
                 "Repeat the cases for each line setting: \"38400,115200 x 8N1,8E1\", or all");
  app.add_option("--reconfigure", run.reconfigure,
                 "Command that sets the device for a step of --matrix (SPEED FRAME behind it); "
                 "else the engineer is asked");
  app.add_option("--duration", run.duration, "Soak: repeat the cases for so long: 90s, 30m, 8h");
  app.add_option("--wait-port", run.wait_port,
                 "How long a port that is absent or in use is waited for: 10m; of a server on the "
                 "network it is asked once a second");
  app.add_option("--seed", run.seed, "Shuffle the cases by this seed")
      ->check(CLI::Range(0, 99'999));
  app.add_option("--repeat", run.repeat, "Run the selection so many times")
      ->check(CLI::Range(1, 1'000'000));
  add_gate(app, run);
  app.add_flag("--fail-fast", run.fail_fast, "Stop at the first verdict that fails the gate");
  app.add_option("--max-failures", run.max_failures,
                 "After so many results that fail the gate the rest is not run (BLOCKED)")
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--max-restarts", run.max_restarts,
                 "How often a device is started again that ended or fell mute (20)")
      ->check(CLI::Range(0, 1'000'000));
  app.add_flag("--dry-run", run.dry_run, "Print what would run");
  app.add_flag("--skip-absent", run.skip_absent, "Exit 77 when the hardware is not there");
  app.add_flag("-v,--verbose", run.verbose, "Show every case with its exchange");
  app.allow_extras();
  app.prefix_command(false);
}

void add_explore(CLI::App& app, cli::ExploreOptions& explore) {
  run::RunOptions& run = explore.run;
  app.add_option("--endpoint", run.endpoint, "As `run` takes it")->default_str("emulator:");
  app.add_option("--protocol", run.protocol, "Which protocol of the profile (default the first)");
  app.add_option("--profile", run.profile,
                 "What the device declares: a name from the profiles folder, or a JSON file");
  app.add_option("--bench", run.bench, "JSON file of the devices on this bench");
  app.add_option("--dut", run.duts, "Device of the bench file")->expected(1);
  app.add_option("--role", run.role,
                 "client: the device asks, and is answered well or badly; else it answers")
      ->check(CLI::IsMember({"client", "server"}));
  app.add_option("--stimulus", run.stimulus, "Client role: what makes the device ask, as `run`");
  app.add_option("--control", run.control, "What sets the device up, as `run`");
  app.add_option("--aux", run.aux, "A second port of the same PLC, as `run`");
  app.add_option("--wait-port", run.wait_port, "How long for a port that is absent, as `run`");
  app.add_option("--seed", run.seed, "The same seed sends the same requests")
      ->check(CLI::Range(0, 99'999));
  app.add_option("--requests", explore.requests,
                 "How many (100000; where time is real, 10 minutes of them)")
      ->check(CLI::Range(1, 1'000'000'000));
  app.add_option("--duration", run.duration, "Instead, or at most so long: 90s, 10m, 8h");
  app.add_option("--vectors", run.vectors,
                 "Another folder of vectors, whose requests it begins with");
  app.add_option("--out", run.out, "Folder of the reports; findings/ in it has a vector each")
      ->capture_default_str();
  app.add_option("--junit", run.junit, "JUnit file, instead of OUT/junit.xml");
  app.add_option("--json", run.json, "JSON file, instead of OUT/results.json");
  app.add_option("--html", run.html, "HTML file, instead of OUT/report.html");
  app.add_option("--waivers", run.waivers,
                 "JSON file of accepted findings; of waived cases it takes no requests");
  app.add_option("--allow-write", run.allow_write, "Real devices: what may be written, as `run`");
  app.add_flag("--read-only", run.read_only, "Write nothing, to exec: neither");
  app.add_option("--journal", run.journal, "Real devices: what they held before, as `run`");
  app.add_flag("--discard-journal", run.discard_journal,
               "Forget what an earlier run on this device did not put back");
  app.add_option("--power-cycle", run.power_cycle,
                 "Command that switches a real device off and on");
  app.add_option("--max-restarts", run.max_restarts,
                 "How often a device is started again that ended or fell mute (20)")
      ->check(CLI::Range(0, 1'000'000));
  app.add_option("--floor", run.floor, "The link's own uncertainty, instead of measuring it: 2ms");
  add_gate(app, run);
  app.add_flag("--fail-fast", run.fail_fast, "Stop at the first finding");
  app.add_flag("--skip-absent", run.skip_absent, "Exit 77 when the hardware is not there");
  app.add_flag("-v,--verbose", run.verbose, "Show every result with its exchange");
}

/// Its commands, each with what it does.
void add_history(CLI::App& app, cli::HistoryOptions& options, std::function<int()>& chosen) {
  using Command = int (*)(const cli::HistoryOptions&);
  const auto add = [&](const char* name, const char* what, Command command) {
    CLI::App* one = app.add_subcommand(name, what);
    one->add_option("--history", options.file,
                    "File of the history (default fieldproof/history.sqlite in XDG_DATA_HOME or "
                    "~/.local/share)");
    one->callback([&options, &chosen, command] {
      chosen = [&options, command] { return command(options); };
    });
    return one;
  };
  const auto add_device = [&](CLI::App& one) {
    one.add_option("--device", options.device, "Its name, or a part that only one device has");
  };
  const auto add_last = [&](CLI::App& one, const char* what) {
    one.add_option("--last", options.last, what)->check(CLI::Range(0, 1'000'000));
  };
  const auto add_reports = [&](CLI::App& one) {
    one.add_option("--html", options.html, "HTML file");
    CLI::Option* json = one.add_flag("--json", options.json);
    one.add_flag("--markdown", options.markdown)->excludes(json);
  };
  add("add", "Add runs; one that is there already stands once", cli::history_add_command)
      ->add_option("results", options.results, "OUT/results.ndjson or OUT/results.json of each run")
      ->required();
  CLI::App* list = add("list", "The runs, the newest first", cli::history_list_command);
  add_device(*list);
  add_last(*list, "So many runs (20); 0: all");
  list->add_flag("--json", options.json, "All runs, the oldest first");
  CLI::App* show =
      add("show", "One run: what did not hold, reply times", cli::history_show_command);
  show->add_option("run", options.run, "Its number, or last")->capture_default_str();
  add_device(*show);
  show->add_flag("--json", options.json, "All cases");
  CLI::App* matrix = add("matrix", "Devices or firmware versions side by side, case by case",
                         cli::history_matrix_command);
  matrix->add_option("--by", options.by, "What has a column: device, firmware")
      ->capture_default_str()
      ->check(CLI::IsMember({"device", "firmware"}));
  add_device(*matrix);
  matrix->add_option("--filter", options.filter, "Cases by id: globs separated by ':'");
  add_last(*matrix, "So many columns, those with the latest runs (12); 0: all");
  add_reports(*matrix);
  CLI::App* trend = add("trend",
                        "A device over its runs: reply times, counts, where they changed, "
                        "flaky cases",
                        cli::history_trend_command);
  add_device(*trend);
  add_last(*trend, "The last so many runs (all)");
  add_reports(*trend);
}

/// "; did you mean '--filter'?" for "--filer=x"; empty for what is an option, or like none. Those
/// that help does not show are not meant.
std::string meant_option(const CLI::App& app, std::string_view word) {
  word = word.substr(0, word.find('='));
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  if (!word.starts_with("--") || std::ranges::count(names, word) > 0) return {};
  return suggestion(word, std::vector<std::string_view>(names.begin(), names.end()));
}

/// "; did you mean '--filter' of fieldproof run?" for an option in front of its command.
std::string meant_option_of_a_command(const CLI::App& app, std::string_view word) {
  for (const CLI::App* command : app.get_subcommands({})) {
    const std::string name(word.substr(0, word.find('=')));
    if (name.starts_with("--") && name != "--help" && command->get_option_no_throw(name))
      return fmt::format("; {} is an option of fieldproof {}, which stands in front of it", name,
                         command->get_name());
    if (std::string meant = meant_option(*command, word); !meant.empty())
      return meant.insert(meant.size() - 1, " of fieldproof " + command->get_name());
  }
  return {};
}

/// GoogleTest's options that do not get in our way.
constexpr std::array<std::string_view, 7> passed_to_gtest{
    "--gtest_shuffle",          "--gtest_random_seed", "--gtest_color",
    "--gtest_print_time",       "--gtest_brief",       "--gtest_break_on_failure",
    "--gtest_catch_exceptions",
};

/// CLI11 leaves here what it does not know.
std::string unknown_argument(const CLI::App& app, const std::vector<std::string>& extras,
                             std::vector<std::string>& gtest_arguments) {
  for (const std::string& extra : extras) {
    if (extra.starts_with("--gtest_repeat")) return "--gtest_repeat is refused: use --repeat";
    if (extra.starts_with("--gtest_output"))
      return "--gtest_output is refused: use --junit and --json; GoogleTest's XML loses control "
             "bytes";
    if (extra.starts_with("--gtest_filter")) return "--gtest_filter is refused: use --filter";
    if (!extra.starts_with("--gtest_"))
      return fmt::format("unknown argument '{}'{}; see fieldproof run --help", extra,
                         meant_option(app, extra));
    const std::size_t equals = extra.find('=');
    const std::string name = extra.substr(0, equals);
    if (std::ranges::find(passed_to_gtest, name) == passed_to_gtest.end())
      return fmt::format("unknown argument '{}'{}; of GoogleTest's own these pass: {}", extra,
                         suggestion(name, passed_to_gtest), fmt::join(passed_to_gtest, ", "));
    const std::string seed = equals == extra.npos ? "" : extra.substr(equals + 1);
    if (name == "--gtest_random_seed" &&
        (seed.empty() || seed.size() > 5 || seed.find_first_not_of("0123456789") != seed.npos))
      return fmt::format("{}: write a number from 0 to 99999: {}=1", extra, name);
    gtest_arguments.push_back(extra);
  }
  return {};
}

/// What the first unknown word was meant to be, and where the words stand.
std::string slip_of(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  std::string path, meant;
  int at = 1;
  for (bool known = true; known && at < argc;) {
    std::vector<std::string> names;
    const CLI::App* next = nullptr;
    for (const CLI::App* one : command->get_subcommands({})) {
      names.push_back(one->get_name());
      if (names.back() == argv[at]) next = one;
    }
    known = next != nullptr;
    if (known) {
      command = next;
      path += command->get_name() + " ";
      ++at;
    } else {
      meant = suggestion(argv[at], std::vector<std::string_view>(names.begin(), names.end()));
    }
  }
  if (command == &app && meant.empty() && at < argc)
    meant = meant_option_of_a_command(app, argv[at]);
  for (; at < argc && meant.empty(); ++at) meant = meant_option(*command, argv[at]);
  return fmt::format("{}; see fieldproof {}--help", meant, path);
}

std::string command_line(int argc, char** argv) {
  std::string line = "fieldproof";
  for (int i = 1; i < argc; ++i) line += " " + run::shell_word(argv[i]);
  return line;
}

}  // namespace

int with_command(int argc, char** argv, const Start& start) {
  CLI::App app(
      "fieldproof proves, clause by clause of the manual, that a PLC communication module speaks "
      "its protocols.",
      "fieldproof");
  cli::format_help(app);
  app.set_version_flag("--version", [] { return cli::version_text(suites::protocols()); });
  app.require_subcommand(1);
  app.footer(exit_codes);
  std::function<int()> chosen;

  run::RunOptions run;
  CLI::App* run_app = app.add_subcommand("run", "Run the cases against an endpoint and judge it");
  add_run(*run_app, run);
  usage::group_options(*run_app);
  run_app->footer(exit_codes);
  run.command = command_line(argc, argv);

  cli::ExploreOptions explore;
  CLI::App* explore_app = app.add_subcommand(
      "explore", "Requests that no vector has, against the device and our own model of it");
  add_explore(*explore_app, explore);
  usage::group_options(*explore_app);
  explore_app->footer(exit_codes);
  explore.run.command = command_line(argc, argv);

  cli::ListOptions list;
  CLI::App* list_app = app.add_subcommand("list", "List the cases");
  list_app->add_option("--filter,filter", list.filter, "Cases by id: globs separated by ':'");
  add_role(*list_app, list.role);
  list_app->add_option("--vectors", list.vectors, "Another folder of vectors");
  list_app->add_flag(
      "--coverage", list.coverage,
      "Traceability: the statements of the manuals, their vectors, and what is not tested and why");
  list_app->add_flag("--redundant", list.redundant,
                     "Cases that no fault of our broken devices tells apart (vectors/faults.json)");
  list_app->add_option("--results", list.results,
                       "With --coverage: the verdicts of this run (NDJSON, JSON or JUnit)");
  list_app->add_option("--html", list.html, "With --coverage: HTML file");
  list_app
      ->add_option("--min-coverage", list.min_coverage,
                   "With --coverage: exit 1 below this share of statements that have a vector, or "
                   "were judged in --results")
      ->check(CLI::Range(0.0, 100.0));
  CLI::Option* list_json = list_app->add_flag(
      "--json", list.json,
      "Each expanded case with the bytes of its steps; with --coverage: each statement");
  list_app->add_flag("--markdown", list.markdown, "With --coverage: tables")->excludes(list_json);

  cli::LintOptions lint;
  CLI::App* lint_app = app.add_subcommand("lint", "Check vectors, statements and profiles");
  lint_app->add_option("--vectors", lint.vectors, "Another folder of vectors");
  lint_app
      ->add_option("--manuals", lint.manuals,
                   "Folder of the manuals' text: quotes are checked against it")
      ->check(CLI::ExistingDirectory);
  lint_app->add_flag("--lock", lint.lock, "Lock the verified quotes (quotes.lock)");

  cli::EmulateOptions emulate;
  CLI::App* emulate_app =
      app.add_subcommand("emulate", "A stand-in device behind a pty or a socket");
  emulate_app
      ->add_option("model", emulate.model,
                   "MODEL[?station=1&protocol=...]: xbc-h, xbm-s, xec-h, inverter, modem")
      ->required();
  emulate_app->add_option(
      "--tcp", emulate.tcp, "Listen on [HOST:]PORT; without HOST for programs here alone");
  emulate_app->add_option("--udp", emulate.udp, "The same for datagrams");
  CLI::Option* pty = emulate_app->add_option(
      "--pty", emulate.pty, "A link to a new pty, or somebody's pty that is there");
  emulate_app->add_option("--tty", emulate.tty, "A real serial port, with MODEL?line=9600-8N1, ...")
      ->excludes(pty);
  emulate_app->add_option("--config", emulate.config,
                          "What is set up in it, a JSON file: keys of given.config");
  emulate_app->add_option("--p2p", emulate.p2p,
                          "P2P parameters, a JSON file: the device is the client that asks");
  emulate_app->add_option("--bus", emulate.bus,
                          "[HOST:]PORT where a second emulated device joins its fieldbus (X-NET)");
  emulate_app->add_option(
      "--monitor", emulate.monitor,
      "CSV file of the frame monitor: each frame with its result, time and data");
  emulate_app
      ->add_option("--control", emulate.control,
                   "-: set up by lines of JSON on standard input, as by the bench's --control")
      ->transform([](std::string text) { return text == "-" ? std::string("0") : text; });
  emulate_app->add_flag("-v,--verbose", emulate.verbose, "Print each frame");

  cli::ProbeOptions probe;
  CLI::App* probe_app = app.add_subcommand("probe",
                                           "Find the device on a port: speed, frame, station, "
                                           "protocol; or say what is wrong with the line");
  probe_app
      ->add_option("endpoint", probe.endpoint,
                   "serial:PATH, rfc2217:HOST:PORT, tcp:HOST:PORT, exec:COMMAND; "
                   "emulator:MODEL?line=38400-8E1 to try it out")
      ->required();
  probe_app->add_option("--station", probe.stations, "Only these: 5 or 0-31 (default 0-31)")
      ->delimiter(',')
      ->allow_extra_args(false);
  probe_app->add_option("--speed", probe.speeds, "Only these: 9600 (default 1200 to 115200)")
      ->delimiter(',')
      ->allow_extra_args(false);
  probe_app
      ->add_option("--frame", probe.frames,
                   "Only these: 8N1 (default 8 or 7 data bits, parity N, E or O)")
      ->delimiter(',')
      ->allow_extra_args(false);
  probe_app
      ->add_option("--protocol", probe.protocols,
                   "Only these: xgt-cnet (default each that has a harmless read)")
      ->delimiter(',')
      ->allow_extra_args(false);
  probe_app->add_option("--wait", probe.wait_ms, "How long an answer may take, in ms")
      ->capture_default_str()
      ->check(CLI::Range(1, 60'000));
  probe_app->add_flag("--all", probe.all, "Go on after the first find");
  probe_app->add_flag("--fingerprint", probe.fingerprint,
                      "Read which areas the device has and where they end, for the bench file");
  probe_app->footer(
      "Exit codes: 0 found, 1 something is wrong and named, 2 usage, 3 port trouble, 130 "
      "interrupted.");

  cli::InitOptions init;
  CLI::App* init_app = app.add_subcommand(
      "init",
      "The first run: asks where the device is, finds it, writes a bench file, runs its "
      "cases and writes a job for CI");
  init_app->add_option("--endpoint", init.endpoint,
                       "serial:PATH, rfc2217:HOST:PORT, tcp:HOST, exec:COMMAND, emulator:MODEL");
  init_app->add_option("--protocol", init.protocol, "Look for this one alone");
  init_app->add_option("--profile", init.profile,
                       "What the device declares: a name from the profiles folder, or a JSON file");
  init_app->add_option("--name", init.name, "Its name in the bench file");
  init_app->add_option("--serial", init.serial, "Its serial number, for reports");
  init_app->add_option("--firmware", init.firmware, "Its firmware, for reports and waivers");
  init_app->add_option("--allow-write", init.allow_write,
                       "Memory that may be written: M100-M199,D0-D99 (a program behind exec: needs "
                       "none)");
  init_app->add_option("--ci", init.ci, "github, gitlab or none");
  init_app->add_option("--bench", init.bench, "Bench file; a device is added to one that is there")
      ->capture_default_str();
  init_app->add_option("--out", init.out, "Folder of the reports")->capture_default_str();
  init_app->add_flag("--yes", init.yes, "Ask nothing: what no option answers is as usual");
  init_app->add_flag("--no-run", init.no_run, "Write the files alone");
  init_app->footer(exit_codes);

  cli::FrameOptions frame;
  CLI::App* frame_app =
      app.add_subcommand("frame", "Explain a frame field by field, with its checks computed");
  frame_app
      ->add_option("frame", frame.frame,
                   "Notation, hex or raw: \"[ENQ st 'rSS' '01' name(%MW100) EOT BCC]\"")
      ->required();
  frame_app->add_option("--protocol", frame.protocol,
                        "the one that the frame fits best when absent");
  frame_app->add_option("--station", frame.station, "What `st` stands for")
      ->capture_default_str()
      ->check(CLI::Range(0, 255));

  cli::ErrataOptions errata;
  CLI::App* errata_app =
      app.add_subcommand("errata", "List the mistakes of the manuals and their proofs");
  errata_app->add_option("--vectors", errata.vectors, "Another folder of vectors");
  CLI::Option* errata_json = errata_app->add_flag("--json", errata.json);
  errata_app->add_flag("--markdown", errata.markdown)->excludes(errata_json);

  cli::ReportOptions report;
  CLI::App* report_app = app.add_subcommand("report",
                                            "Derive JUnit, JSON, HTML, tables and a capture from "
                                            "the results of a run, finished or killed");
  report_app->add_option("results", report.ndjson, "OUT/results.ndjson")->required();
  report_app->add_option("--junit", report.junit);
  report_app->add_option("--json", report.json);
  report_app->add_option("--html", report.html);
  report_app->add_option("--capture", report.capture, "pcapng for Wireshark");
  report_app->add_option("--csv", report.csv, "Folder of tables of what a model did");

  cli::CompareOptions compare;
  CLI::App* compare_app =
      app.add_subcommand("compare", "What changed between runs: verdicts, reasons, reply times");
  compare_app
      ->add_option(
          "results", compare.files,
          "Results of two or more runs (NDJSON, JSON or JUnit): each is compared with the first; "
          "`last` as the first: the last run of that device in the history")
      ->required()
      ->expected(2, -1);
  compare_app->add_option("--history", compare.history, "File of the history, for `last`");
  compare_app->add_option("--html", compare.html, "HTML file of the comparison");
  compare_app->add_option("--junit", compare.junit,
                          "JUnit file of the comparison: what got worse is a failure");
  compare_app->footer(
      "Exit codes: 0 nothing got worse, 1 something got worse, 2 a file cannot be read.");

  cli::HistoryOptions history;
  CLI::App* history_app =
      app.add_subcommand("history", "Many runs: verdicts side by side, reply times over versions");
  history_app->require_subcommand(1);
  add_history(*history_app, history, chosen);
  history_app->footer("Exit codes: 0 done, 2 a file cannot be used, 3 it could not be written.");

  cli::MergeOptions merge;
  CLI::App* merge_app = app.add_subcommand(
      "merge", "One report of the shards of a run (GTEST_TOTAL_SHARDS, GTEST_SHARD_INDEX)");
  merge_app->add_option("results", merge.files, "results.json or results.ndjson of each shard")
      ->required();
  merge_app->add_option("--out", merge.out, "Folder of the reports")->capture_default_str();
  merge_app->add_option("--junit", merge.junit, "JUnit file, instead of OUT/junit.xml");
  merge_app->add_option("--json", merge.json, "JSON file, instead of OUT/results.json");
  merge_app->add_option("--html", merge.html, "HTML file, instead of OUT/report.html");
  merge_app->footer(exit_codes);
  merge.command = command_line(argc, argv);

  cli::JudgeOptions judge;
  CLI::App* judge_app = app.add_subcommand(
      "judge", "Judge a recorded run again by today's vectors, without the device");
  add_judge(*judge_app, judge);
  judge_app->footer(exit_codes);
  judge.command = command_line(argc, argv);

  cli::RestoreOptions restore;
  CLI::App* restore_app =
      app.add_subcommand("restore", "Put back what an interrupted run left on a real device");
  restore_app->add_option("journal", restore.journal, "OUT/journal.ndjson")->required();
  restore_app->add_option("--endpoint", restore.endpoint,
                          "Where the device is reached now, if not as the journal says");
  restore_app->footer(
      "Exit codes: 0 all is as it was, 2 usage, 3 something could not be put back, 130 "
      "interrupted.");

  std::string shell;
  CLI::App* completion_app = app.add_subcommand("completion", "Print the completion of a shell");
  completion_app->add_option("shell", shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>(usage::shells.begin(), usage::shells.end())));
  CLI::App* man_app = app.add_subcommand("man", "Print the man page");

  run_app->callback([&] {
    const std::string wrong = unknown_argument(*run_app, run_app->remaining(), run.gtest_arguments);
    chosen = [&run, wrong] {
      return wrong.empty() ? cli::run_command(run, suites::protocols())
                           : run::complain(wrong, run::exit_code::usage);
    };
  });
  // Called when all words are read.
  const auto runs = [&chosen](CLI::App* command, const Command& run_it) {
    command->callback([&chosen, run_it] { chosen = run_it; });
  };
  runs(explore_app, [&] { return cli::explore_command(explore, suites::protocols()); });
  runs(list_app, [&] { return cli::list_command(list, suites::protocols()); });
  runs(lint_app, [&] { return cli::lint_command(lint, suites::protocols()); });
  runs(emulate_app, [&] { return cli::emulate_command(emulate, suites::protocols()); });
  runs(probe_app, [&] { return cli::probe_command(probe, suites::protocols()); });
  runs(init_app, [&] { return cli::init_command(init, suites::protocols()); });
  runs(frame_app, [&] { return cli::frame_command(frame, suites::protocols()); });
  runs(errata_app, [&] { return cli::errata_command(errata, suites::protocols()); });
  runs(compare_app, [&] { return cli::compare_command(compare); });
  runs(merge_app, [&] { return cli::merge_command(merge); });
  runs(judge_app, [&] { return cli::judge_command(judge, suites::protocols()); });
  runs(restore_app, [&] { return cli::restore_command(restore, suites::protocols()); });
  runs(completion_app, [&] { return cli::completion_command(app, shell); });
  runs(man_app, [&] { return cli::man_command(app); });
  runs(report_app, [&] { return cli::report_command(report); });

  if (argc > 1 && std::string_view(argv[1]) == "__complete")
    return cli::complete_command(app, {argv + 2, argv + argc}, suites::protocols());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return run::complain(error.what() + slip_of(app, argc, argv), run::exit_code::usage);
  }
  return start(chosen);
}

}  // namespace fieldproof::suites
