#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "harness/bench/files/bench_file.hpp"
#include "harness/bench/files/profile.hpp"
#include "harness/cli/ci_job.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/questions.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/paths.hpp"
#include "harness/run/run_report.hpp"
#include "reports/compare/result_file.hpp"
#include "reports/results/whole_file.hpp"
#include "reports/text/report_file.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::cli {

using endpoints::EndpointName;
using nlohmann::ordered_json;

namespace {

namespace fs = std::filesystem;

/// What the answers come to.
struct Answers {
  EndpointName endpoint;
  ProbedDevice found;
  std::string profile, name, serial, firmware, allow_write, ci;
};

std::vector<std::string> ports_here() {
  std::vector<std::string> ports;
  std::error_code none;
  for (const auto& one : fs::directory_iterator("/dev/serial/by-id", none))
    ports.push_back("serial:" + one.path().string());
  std::ranges::sort(ports);
  ports.insert(ports.end(), {"tcp:192.168.1.10", "exec:./my_plc {tty}", "emulator:"});
  return ports;
}

int find_device(const InitOptions& options, const std::string& text,
                const harness::Protocols& known, std::vector<ProbedDevice>& found) {
  ProbeOptions probe;
  probe.endpoint = text;
  probe.profile = options.profile;
  if (!options.protocol.empty()) probe.protocols = {options.protocol};
  return probe_command(probe, known, &found);
}

Result<std::string> ask_profile(const Questions& questions, const InitOptions& options,
                                const ProbedDevice& found) {
  const fs::path folder = harness::find_data().profiles;
  std::vector<std::string> hints;
  for (const std::string& name : bench::profile_names(folder)) {
    const Result<bench::Profile> one = bench::load_profile(name, folder);
    if (one && std::ranges::count(one->protocols, found.protocol) > 0)
      hints.push_back(fmt::format("{:<14} {}", name, one->title));
  }
  Result<std::string> profile =
      questions.answer({"--profile", "Which model is it?", hints, found.profile}, options.profile);
  if (!profile) return profile;
  if (const Result<bench::Profile> loaded = bench::load_profile(*profile, folder); !loaded)
    return loaded.error();
  return profile;
}

Result<std::string> ask_ci(const Questions& questions, const InitOptions& options) {
  const std::string usual = fs::exists(".github")   ? "github"
                            : fs::exists(".gitlab") ? "gitlab"
                                                    : "none";
  Result<std::string> ci = questions.answer(
      {"--ci", "A job for which CI: github, gitlab, none?", {}, usual}, options.ci);
  if (ci && *ci != "github" && *ci != "gitlab" && *ci != "none")
    return fail(fmt::format("--ci {}: write github, gitlab or none", *ci));
  return ci;
}

/// In the order in which an engineer knows them.
Result<Answers> ask(const Questions& questions, const InitOptions& options, Answers known) {
  Answers answers = std::move(known);
  const bool stays = !endpoints::kind_of(answers.endpoint).can_restart &&
                     !endpoints::kind_of(answers.endpoint).emulated;
  const auto one = [&](std::string& to, Result<std::string> answer) -> Status {
    if (!answer) return answer.error();
    to = std::move(*answer);
    return ok();
  };
  Status asked = one(answers.profile, ask_profile(questions, options, answers.found));
  if (asked)
    asked = one(answers.name,
                questions.answer({"--name", "Its name on this bench?", {}, "dut"}, options.name));
  if (asked)
    asked =
        one(answers.serial,
            questions.answer({"--serial", "Serial number, if any?", {}, "", true}, options.serial));
  if (asked)
    asked = one(answers.firmware,
                questions.answer({"--firmware", "Firmware version, if known?", {}, "", true},
                                 options.firmware));
  if (asked && stays)
    asked = one(answers.allow_write,
                questions.answer({"--allow-write",
                                  "Which memory may be written (M100-M199,D0-D99)? Empty: none",
                                  {},
                                  "",
                                  true},
                                 options.allow_write));
  if (asked) asked = one(answers.ci, ask_ci(questions, options));
  if (!asked) return asked.error();
  return answers;
}

ordered_json device_of(const Answers& answers) {
  ordered_json device{{"endpoint", answers.found.endpoint}, {"profile", answers.profile}};
  if (!answers.serial.empty()) device["identity"]["serial"] = answers.serial;
  if (!answers.firmware.empty()) device["identity"]["firmware"] = answers.firmware;
  for (std::size_t at = 0; at < answers.allow_write.size();) {
    const std::size_t end = std::min(answers.allow_write.find(',', at), answers.allow_write.size());
    device["allow_write"].push_back(answers.allow_write.substr(at, end - at));
    at = end + 1;
  }
  return device;
}

Status write_file(const std::string& path, const std::string& text) {
  std::error_code none;
  if (const fs::path folder = fs::path(path).parent_path(); !folder.empty())
    fs::create_directories(folder, none);  // opening tells what failed
  Result<text::ReportFile> file = text::ReportFile::create(path);
  if (!file) return file.error();
  file->out() << text;
  return file->commit();
}

/// Adds the device to the bench file, which may be there already.
Status add_to_bench(const std::string& path, const Answers& answers,
                    const safety::WordReader& words) {
  ordered_json bench = ordered_json::object();
  if (fs::exists(path)) {
    const Result<bench::BenchFile> before = bench::load_bench_file(path, words);
    if (!before) return before.error();
    if (before->devices.contains(answers.name))
      return fail(
          fmt::format("{} has a device '{}' already; give another --name, or another --bench", path,
                      answers.name));
    const Result<std::string> text = results::read_whole_file(path, "bench file");
    if (!text) return text.error();
    bench = ordered_json::parse(*text);
  }
  bench["devices"][answers.name] = device_of(answers);
  const std::string text = bench.dump(2) + "\n";
  if (const auto right = bench::parse_bench_file(text, path, words); !right) return right.error();
  return write_file(path, text);
}

/// Percent of what the profile declares, rounded down; nothing where the run has no results.
std::optional<int> judged_share(const std::string& results) {
  const Result<compare::ResultFile> file = compare::read_result_file(results);
  if (!file) return std::nullopt;
  text::Tally tally;
  for (const results::CaseResult& one : file->results) tally.add(one);
  if (tally.applicable() == 0) return std::nullopt;
  return static_cast<int>(100 * tally.judged() / tally.applicable());
}

int write_ci_job(const Answers& answers, const std::string& arguments) {
  if (answers.ci == "none") return run::exit_code::ok;
  const endpoints::KindOf& kind = endpoints::kind_of(answers.endpoint);
  const CiJob job = ci_job(answers.ci, arguments, !kind.can_restart && !kind.emulated);
  if (fs::exists(job.file)) {
    run::tell(fmt::format("{} is there already; this would be the job:\n{}", job.file, job.text));
    return run::exit_code::ok;
  }
  if (const Status written = write_file(job.file, job.text); !written)
    return run::complain(written.error().message, run::exit_code::trouble);
  run::tell(fmt::format("ci       {}\n", job.file));
  return run::exit_code::ok;
}

}  // namespace

int init_command(const InitOptions& options, const harness::Protocols& protocols) {
  const Questions questions(!options.yes && ::isatty(STDIN_FILENO) != 0);
  const auto wrong = [](const Error& error) {
    return run::complain(error.message, run::exit_code::usage);
  };
  const Result<std::string> where =
      questions.answer({"--endpoint", "Where is the device?", ports_here()}, options.endpoint);
  if (!where) return wrong(where.error());
  Answers answers;
  const Result<EndpointName> endpoint = endpoints::parse_endpoint(*where);
  if (!endpoint) return wrong(endpoint.error());
  answers.endpoint = *endpoint;

  std::vector<ProbedDevice> found;
  const int probed = find_device(options, *where, protocols, found);
  if (found.empty())
    return probed == run::exit_code::failed
               ? run::complain("no device was found there; nothing was written",
                               run::exit_code::trouble)
               : probed;
  answers.found = found.front();
  const Result<Answers> asked = ask(questions, options, std::move(answers));
  if (!asked) return wrong(asked.error());

  const safety::WordReader words = [&](std::string_view text) { return protocols.read_word(text); };
  if (const Status added = add_to_bench(options.bench, *asked, words); !added)
    return wrong(added.error());
  run::tell(
      fmt::format("\nbench    {}: {} is {}\n", options.bench, asked->name, asked->found.endpoint));
  std::string arguments = fmt::format("--bench {} --dut {} --role server",
                                      run::shell_word(options.bench), run::shell_word(asked->name));
  int code = run::exit_code::ok;
  if (!options.no_run) {
    run::RunOptions run;
    run.bench = options.bench;
    run.duts = {asked->name};
    run.role = "server";
    run.out = options.out;
    run.command = "fieldproof run " + arguments;
    run::tell(fmt::format("run      {}\n\n", run.command));
    code = run_command(run, protocols);
    const std::optional<int> share =
        judged_share((fs::path(options.out) / "results.ndjson").string());
    if (share && *share > 0) arguments += fmt::format(" --min-judged {}%", *share);
  }
  const int written = write_ci_job(*asked, arguments);
  if (endpoints::kind_of(asked->endpoint).started_by_bench())
    run::tell(fmt::format(
        "more     what the program can be told, it is judged by: {{station}} and other marks in "
        "its "
        "command, --control (README, \"A program that can be set up\")\n"));
  run::tell(fmt::format("next     fieldproof run {}\n", arguments));
  return code != run::exit_code::ok ? code : written;
}

}  // namespace fieldproof::cli
