#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "harness/cli/case_lines.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/coverage.hpp"
#include "harness/cli/redundant.hpp"
#include "harness/exchange/prepared_case.hpp"
#include "harness/run/run_report.hpp"
#include "harness/run/tool_vectors.hpp"
#include "harness/system/terminal.hpp"
#include "reports/coverage_html.hpp"

namespace fieldproof::cli {

using vectors::Step;

namespace {

using nlohmann::ordered_json;

ordered_json memory_json(const std::vector<std::pair<std::string, std::string>>& memory) {
  ordered_json result = ordered_json::object();
  for (const auto& [address, hex] : memory) result[address] = hex;
  return result;
}

ordered_json checked_json(const Step& step) {
  ordered_json result = memory_json(step.memory);
  for (std::size_t i = 0; i < step.numbers.size(); ++i)
    if (step.numbers[i]) result[step.memory[i].first] = step.numbers[i]->text();
  return result;
}

/// All that a check may find, by name.
ordered_json alternatives_json(const Step& step) {
  ordered_json result = ordered_json::array();
  for (const vectors::CheckedValues& one : step.alternatives) {
    Step other = step;
    for (std::size_t i = 0; i < other.memory.size(); ++i) other.memory[i].second = one.digits[i];
    other.numbers = one.numbers;
    result.push_back(
        {{"reading", step.reading}, {"name", one.alternative}, {"check", checked_json(other)}});
  }
  return result;
}

ordered_json partner_json(const vectors::PartnerSpec& partner) {
  ordered_json result = partner.config;
  if (!partner.model.empty()) result["model"] = partner.model;
  if (!partner.memory.empty()) result["memory"] = memory_json(partner.memory);
  if (!partner.fault.empty()) result["fault"] = partner.fault;
  return result;
}

ordered_json open_json(const exchange::PreparedStep& step) {
  ordered_json link{{"name", step.link}, {"protocol", step.protocol->name()}};
  if (step.network) {
    link["transport"] = step.step->link.transport == Transport::udp ? "udp" : "tcp";
    link["port"] = step.port;
  }
  return {{"open", std::move(link)}};
}

const char* name_of(Closing how) {
  return how == Closing::fin ? "fin" : how == Closing::rst ? "rst" : "vanish";
}
const char* name_of(const std::optional<LinkEvent>& ending) {
  return !ending ? "any" : *ending == LinkEvent::closed ? "fin" : "rst";
}

ordered_json kind_json(const exchange::PreparedStep& step) {
  const Step& source = *step.step;
  switch (source.kind) {
    case Step::Kind::send:
      return {{"send", notation::to_hex_with_holes(step.frames.front().frame)},
              {"notation", source.frames.front().text}};
    case Step::Kind::expect: {
      ordered_json result{{"expect", notation::to_hex_with_holes(step.frames.front().frame)},
                          {"notation", source.frames.front().text}};
      if (step.frames.size() == 1) return result;
      result["alternatives"] = ordered_json::array();
      for (const exchange::PreparedFrame& one : step.frames)
        result["alternatives"].push_back({{"reading", source.reading},
                                          {"name", one.alternative},
                                          {"expect", notation::to_hex_with_holes(one.frame)}});
      return result;
    }
    case Step::Kind::silence: return {{"silence", true}};
    case Step::Kind::wait: return {{"wait", fmt::format("{}ms", to_ms(source.duration))}};
    case Step::Kind::set: return {{"set", memory_json(source.memory)}};
    case Step::Kind::check: {
      ordered_json result{{"check", checked_json(source)}};
      if (!source.alternatives.empty()) result["alternatives"] = alternatives_json(source);
      return result;
    }
    case Step::Kind::act: return {{"do", source.action}};
    case Step::Kind::open: return open_json(step);
    case Step::Kind::close: return {{"close", name_of(source.closing)}};
    case Step::Kind::expect_close:
      return {{"expect_close", source.may_stay ? "may" : name_of(source.ending)}};
    case Step::Kind::expect_open: return {{"expect_open", step.link}};
    case Step::Kind::partner: return ordered_json::object();
  }
  return {};
}

ordered_json step_json(const exchange::PreparedStep& step) {
  const Step& source = *step.step;
  ordered_json result = kind_json(step);
  if (!source.on.empty() && source.kind != Step::Kind::open &&
      source.kind != Step::Kind::expect_open)
    result["on"] = source.on;
  if (source.partner) result["partner"] = partner_json(*source.partner);
  if (source.every) result["every"] = fmt::format("{}ms", to_ms(*source.every));
  if (source.times > 1) result["times"] = source.times;
  return result;
}

ordered_json case_json(const vectors::Case& one, const harness::Protocols& protocols) {
  ordered_json result{{"id", one.id},
                      {"rev", one.rev},
                      {"title", one.title},
                      {"level", one.level},
                      {"basis", one.basis},
                      {"source",
                       {{"manual", one.source.manual},
                        {"section", one.source.section},
                        {"statement", one.source.statements},
                        {"quote", one.source.quote}}},
                      {"protocol", one.protocol},
                      {"models", one.models},
                      {"config", one.config},
                      {"memory", memory_json(one.memory)}};
  result["steps"] = ordered_json::array();
  const harness::Protocol* protocol = protocols.find(one.protocol);
  if (!protocol) return result;
  const Result<exchange::PreparedCase> prepared = exchange::prepare(
      one, vectors::config_station(one.config, 1).value_or(1), *protocol, {protocols});
  if (!prepared) return result;
  for (const exchange::PreparedStep& step : prepared->steps)
    result["steps"].push_back(step_json(step));
  return result;
}

int list_coverage(const ListOptions& options, const vectors::VectorSet& set) {
  std::optional<compare::ResultFile> results;
  if (!options.results.empty()) {
    Result<compare::ResultFile> read = compare::read_result_file(options.results);
    if (!read) return run::complain(read.error().message, run::exit_code::usage);
    results = std::move(*read);
  }
  const Result<vectors::FaultMatrix> faults =
      vectors::load_fault_matrix(run::vectors_path(options.vectors));
  if (!faults) return run::complain(faults.error().message, run::exit_code::usage);
  const reports::Coverage coverage = trace(set, results, *faults);
  if (!options.html.empty())
    if (const Status written = reports::write_coverage_html(coverage, options.html); !written)
      return run::complain(written.error().message, run::exit_code::trouble);
  if (options.json || options.markdown)
    run::print(options.json ? reports::coverage_json(coverage)
                            : reports::coverage_markdown(coverage));
  else
    run::tell(reports::coverage_text(coverage));
  const reports::CoverageCounts counts = reports::count_statements(coverage);
  const double percent = counts.percent(coverage.with_results());
  if (percent < options.min_coverage)
    return run::complain(fmt::format("coverage is {:.1f} %, below --min-coverage {:g}", percent,
                                     options.min_coverage),
                         run::exit_code::failed);
  return counts.count(reports::Traced::open) == 0 ? run::exit_code::ok : run::exit_code::failed;
}

int list_redundant(const ListOptions& options, const vectors::VectorSet& set) {
  const std::filesystem::path folder = run::vectors_path(options.vectors);
  const Result<vectors::FaultMatrix> faults = vectors::load_fault_matrix(folder);
  if (!faults) return run::complain(faults.error().message, run::exit_code::usage);
  if (faults->empty())
    return run::complain(
        fmt::format("there is no {}, which says what our broken devices show of these cases",
                    (folder / "faults.json").string()),
        run::exit_code::usage);
  run::tell(redundant_text(set, *faults));
  return run::exit_code::ok;
}

}  // namespace

int list_command(const ListOptions& options, const harness::Protocols& protocols) {
  if (!options.coverage && (options.markdown || !options.html.empty() || !options.results.empty() ||
                            options.min_coverage > 0))
    return run::complain(
        "--results, --markdown, --html and --min-coverage are about --coverage; add it",
        run::exit_code::usage);
  if (options.redundant && (options.coverage || options.json || !options.role.empty()))
    return run::complain("--redundant goes with --filter and --vectors alone",
                         run::exit_code::usage);
  if (options.coverage && !(options.filter + options.role).empty())
    return run::complain("--filter and --role select cases; --coverage is of all statements",
                         run::exit_code::usage);
  const Result<vectors::VectorSet> loaded = run::load_sound_vectors(
      options.vectors, protocols, options.coverage ? std::string() : options.filter);
  if (!loaded) return run::complain(loaded.error().message, run::exit_code::usage);
  const vectors::VectorSet& set = *loaded;
  if (options.coverage) return list_coverage(options, set);
  if (options.redundant) return list_redundant(options, set);
  std::vector<const vectors::Case*> listed;
  for (const vectors::Case& one : set.cases)
    if (vectors::has_role(one, options.role)) listed.push_back(&one);
  if (options.json) {
    ordered_json all = ordered_json::array();
    for (const vectors::Case* one : listed) all.push_back(case_json(*one, protocols));
    run::print(all.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n');
  }
  if (listed.empty())
    return run::complain(
        fmt::format("no case{} matches '{}'{}; `fieldproof list` shows them all",
                    options.role.empty() ? "" : " of role " + options.role, options.filter,
                    run::meant_filter(options.vectors, protocols, options.filter)),
        run::exit_code::nothing);
  if (!options.json)
    run::print(case_lines(listed, os::terminal_columns(STDOUT_FILENO)) +
               fmt::format("{} cases\n", listed.size()));
  return run::exit_code::ok;
}

}  // namespace fieldproof::cli
