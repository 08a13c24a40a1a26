#include "suites/mutants/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace fieldproof::mutants {

namespace {

using Stages = std::vector<std::string>;

struct Count {
  std::size_t all = 0, equivalent = 0, unreached = 0, ended = 0;  // ended: crashed or hung
  std::vector<std::size_t> killed;                                // by stage

  std::size_t counting() const { return all - equivalent; }
};

void add(Count& count, const Mutant& mutant, const Outcome& outcome, const Stages& stages) {
  ++count.all;
  count.killed.resize(stages.size());
  const bool killed = is_killed(outcome.fate);
  if (!killed && !mutant.equivalent.empty()) {
    ++count.equivalent;
    return;
  }
  count.unreached += outcome.fate == Fate::unreached;
  count.ended += outcome.fate == Fate::crashed || outcome.fate == Fate::hung;
  const auto stage = std::ranges::find(stages, outcome.stage);
  if (killed) ++count.killed[static_cast<std::size_t>(stage - stages.begin())];
}

using Counts = std::map<std::string, Count>;

template <typename Key>
Counts counted(const std::vector<Mutant>& mutants, const std::vector<Outcome>& outcomes,
               const Stages& stages, Key key) {
  Counts counts;
  for (std::size_t i = 0; i < mutants.size(); ++i)
    add(counts[key(mutants[i])], mutants[i], outcomes[i], stages);
  return counts;
}

constexpr auto all_of = [](const Mutant&) { return std::string("all"); };
constexpr auto by_protocol = [](const Mutant& one) { return one.protocol; };
constexpr auto by_file = [](const Mutant& one) { return one.file; };

/// Of those that count, up to each stage: "96.1 %".
std::vector<std::string> shares(const Count& count) {
  std::vector<std::string> texts;
  std::size_t killed = 0;
  for (const std::size_t of_stage : count.killed) {
    killed += of_stage;
    const double share = count.counting() ? 100.0 * static_cast<double>(killed) /
                                                static_cast<double>(count.counting())
                                          : 100.0;
    texts.push_back(fmt::format("{:.1f} %", share));
  }
  return texts;
}

std::size_t living(const Count& count) {
  std::size_t left = count.counting();
  for (const std::size_t killed : count.killed) left -= killed;
  return left;
}

std::string row(const std::string& name, const Count& count) {
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", name, count.all, count.equivalent,
                     fmt::join(shares(count), " | "), count.ended, count.unreached, living(count));
}

std::string table(const std::string& what, const Counts& counts, const Count& all,
                  const Stages& stages) {
  std::string text = fmt::format(
      "| {} | mutants | equivalent | killed by {} | of them by a crash or hang | of the living "
      "never reached | living |\n|---",
      what, fmt::join(stages, " | and "));
  for (std::size_t i = 0; i < 5 + stages.size(); ++i) text += "|---";
  text += "|\n";
  for (const auto& [name, count] : counts) text += row(name, count);
  return text + row("all", all) + '\n';
}

std::string one_line(std::string text) {
  std::string line;
  for (const char c : text) {
    const bool space = c == '\n' || c == ' ';
    if (space && line.ends_with(' ')) continue;
    if (c == '|') line += '\\';
    line += space ? ' ' : c;
  }
  return line.size() > 120 ? line.substr(0, 117) + "..." : line;
}

bool lives(const Mutant& mutant, const Outcome& outcome) {
  return !is_killed(outcome.fate) && mutant.equivalent.empty();
}

}  // namespace

std::string markdown(const std::vector<Mutant>& mutants, const std::vector<Outcome>& outcomes,
                     const Stages& stages) {
  const Count all = counted(mutants, outcomes, stages, all_of).at("all");
  std::string text = "# Mutants of our own devices\n\n";
  text += table("protocol", counted(mutants, outcomes, stages, by_protocol), all, stages);
  text += table("file", counted(mutants, outcomes, stages, by_file), all, stages);
  std::map<std::string, std::size_t> sections;
  for (std::size_t i = 0; i < mutants.size(); ++i)
    if (lives(mutants[i], outcomes[i]))
      ++sections[outcomes[i].section.empty() ? "(never reached)" : outcomes[i].section];
  text += "| section of the most special case that comes by | living |\n|---|---|\n";
  for (const auto& [section, count] : sections)
    text += fmt::format("| {} | {} |\n", section, count);
  text += "\n| living | function | rule | before | after | section |\n|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < mutants.size(); ++i) {
    const Mutant& one = mutants[i];
    if (!lives(one, outcomes[i])) continue;
    text += fmt::format("| {} {}:{} | {} | {} | `{}` | `{}` | {} |\n", one.id, one.file, one.line,
                        one.function, one.rule, one_line(one.before), one_line(one.after),
                        outcomes[i].section);
  }
  return text;
}

std::string json_text(const std::vector<Mutant>& mutants, const std::vector<Outcome>& outcomes) {
  nlohmann::ordered_json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < mutants.size(); ++i) {
    const Mutant& one = mutants[i];
    const Outcome& outcome = outcomes[i];
    rows.push_back({{"id", one.id},
                    {"protocol", one.protocol},
                    {"file", one.file},
                    {"line", one.line},
                    {"function", one.function},
                    {"rule", one.rule},
                    {"before", one.before},
                    {"after", one.after},
                    {"fate", to_string(outcome.fate)},
                    {"stage", outcome.stage},
                    {"by", outcome.by},
                    {"section", outcome.section},
                    {"equivalent", one.equivalent}});
  }
  return rows.dump(1) + '\n';
}

std::string summary(const std::vector<Mutant>& mutants, const std::vector<Outcome>& outcomes,
                    const Stages& stages) {
  Counts counts = counted(mutants, outcomes, stages, by_protocol);
  std::string text;
  const auto line = [&](const std::string& name, const Count& count) {
    const std::vector<std::string> parts = shares(count);
    text += fmt::format("{}: {} of {} killed", name, parts.front(), count.counting());
    for (std::size_t i = 0; i < stages.size(); ++i)
      text += fmt::format("{} {}{}", i ? "," : " by", i ? parts[i] + " with " : "", stages[i]);
    text += '\n';
  };
  for (const auto& [name, count] : counts) line(name, count);
  line("all", counted(mutants, outcomes, stages, all_of).at("all"));
  return text;
}

}  // namespace fieldproof::mutants
