#include "harness/vectors/lint/lint.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <unordered_set>

#include "harness/notation/frame_template.hpp"
#include "harness/vectors/citations.hpp"
#include "harness/vectors/lint/fields_of_steps.hpp"

namespace fieldproof::vectors {

namespace {

/// "05 30 ??" as one token a byte; nothing when it is not.
std::optional<std::vector<std::string>> wire_bytes(const std::string& wire) {
  std::vector<std::string> bytes;
  std::istringstream in(wire);
  for (std::string token; in >> token;) {
    if (token.size() != 2) return std::nullopt;
    if (token != "??" && (hex_digit(token[0]) < 0 || hex_digit(token[1]) < 0)) return std::nullopt;
    std::ranges::transform(token, token.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    bytes.push_back(token);
  }
  return bytes;
}

std::string compare_wire(const std::string& wire, const notation::FrameTemplate& frame) {
  const std::optional<std::vector<std::string>> written = wire_bytes(wire);
  if (!written)
    return fmt::format("wire \"{}\" is not two-digit hex bytes separated by spaces", wire);
  const std::vector<std::string> notation = *wire_bytes(notation::to_hex_with_holes(frame));
  const auto [a, b] = std::ranges::mismatch(*written, notation);
  if (a == written->end() && b == notation.end()) return {};
  const auto at = a - written->begin();
  return fmt::format("wire and notation differ at byte {}: wire has {}, notation has {} ({})", at,
                     a == written->end() ? "nothing" : *a, b == notation.end() ? "nothing" : *b,
                     notation::to_hex_with_holes(frame));
}

/// `all`: every frame has literal bytes.
void lint_step(const Case& one, std::size_t index, const notation::Fields& stations, bool all,
               std::vector<std::string>& problems) {
  for (const Frame& frame : one.steps[index].frames) {
    if (!frame.wire && !all) continue;
    const auto problem = [&](const std::string& what) {
      problems.push_back(fmt::format("{}: {}: steps[{}]{}{}: {}", one.file, one.id, index,
                                     frame.alternative.empty() ? "" : " ", frame.alternative,
                                     what));
    };
    const Result<std::vector<notation::FrameTemplate>> templates =
        notation::make_templates(frame.notation, stations);
    if (!templates) {
      problem(templates.error().message);
    } else if (!frame.wire) {
      problem(
          "no wire: type the literal bytes from the manual, or derive them without looking at the "
          "notation");
    } else if (const std::string what = compare_wire(*frame.wire, templates->front());
               !what.empty()) {
      problem(what);
    }
  }
}

/// Manuals and statements that cases cite are there.
void lint_citations(const VectorSet& set, std::vector<std::string>& problems) {
  std::unordered_set<std::string_view> manuals;
  for (const Manual& manual : set.manuals) manuals.insert(manual.id);
  const StatementsById known = statements_by_id(set);
  for (const std::vector<Case>* cases : {&set.cases, &set.tables})
    for (const Case& one : *cases) {
      if (!manuals.contains(one.source.manual))
        problems.push_back(fmt::format("{}: {}: no manual '{}' in manuals.json", one.file, one.id,
                                       one.source.manual));
      if (one.source.statements.empty())
        problems.push_back(
            fmt::format("{}: {}: names no statement; list the sentence in statements/ and name its "
                        "id, so that coverage knows it",
                        one.file, one.id));
      for (const std::string_view statement : cited_by(one))
        if (!known.contains(statement))
          problems.push_back(
              fmt::format("{}: {}: {}", one.file, one.id, no_statement(statement, known)));
    }
}

/// A partner that cannot be made would only be noticed in a run.
void lint_partner(const Case& one, std::size_t index, const harness::Protocol& protocol,
                  std::vector<std::string>& problems) {
  const std::optional<PartnerSpec>& partner = one.steps[index].partner;
  if (!partner) return;
  const auto problem = [&](const Error& error) {
    problems.push_back(
        fmt::format("{}: {}: steps[{}] partner: {}", one.file, one.id, index, error.message));
  };
  const Result<std::unique_ptr<plc::EmulatedDevice>> device = protocol.make_device(
      partner->model.empty() ? protocol.models().front() : partner->model, partner->config);
  if (!device) return problem(device.error());
  for (const auto& [address, hex] : partner->memory)
    if (const Status set = (*device)->set(address, hex); !set) problem(set.error());
}

}  // namespace

std::vector<std::string> lint_wires(const VectorSet& set, const harness::Protocols& protocols) {
  std::vector<std::string> problems;
  for (const Case& one : set.cases) {
    const harness::Protocol* protocol = protocols.find(one.protocol);
    if (!protocol) {
      problems.push_back(
          fmt::format("{}: {}: no protocol '{}'; an id begins with the folder of its protocol",
                      one.file, one.id, one.protocol));
      continue;
    }
    for (const std::string& model : one.models)
      if (!protocol->has_model(model))
        problems.push_back(
            fmt::format("{}: {}: {} has no model '{}'", one.file, one.id, one.protocol, model));
    FieldsOfSteps fields(one, *protocol, protocols);
    for (std::size_t i = 0; i < one.steps.size(); ++i) {
      const Result<notation::Fields> own = fields.next(one.steps[i]);
      if (own) lint_step(one, i, *own, true, problems);  // else lint_links says why
      lint_partner(one, i, *protocol, problems);
    }
  }
  return problems;
}

namespace {

/// Words of a step that its protocol does not have.
Status check_words(const Step& step, const notation::Fields& fields) {
  for (const Frame& frame : step.frames)
    if (Status known = notation::check_words(frame.notation, fields); !known) return known;
  return ok();
}

void contradictions_of(const Case& one, const harness::Protocol& protocol,
                       const harness::Protocols& protocols, std::vector<std::string>& problems) {
  FieldsOfSteps fields(one, protocol, protocols);
  for (std::size_t i = 0; i < one.steps.size(); ++i) {
    const Result<notation::Fields> own = fields.next(one.steps[i]);
    const Status known = own ? check_words(one.steps[i], *own) : own.error();
    if (known)
      lint_step(one, i, *own, false, problems);
    else
      problems.push_back(
          fmt::format("{}: {}: steps[{}]: {}", one.file, one.id, i, known.error().message));
  }
}

}  // namespace

std::vector<std::string> contradictions(const VectorSet& set, const harness::Protocols& protocols) {
  std::vector<std::string> problems = lint_links(set, protocols);
  if (!problems.empty()) return problems;  // what is spoken where is not known
  for (const Case& one : set.cases)
    if (const harness::Protocol* protocol = protocols.find(one.protocol))
      contradictions_of(one, *protocol, protocols, problems);
  if (!set.manuals.empty()) lint_citations(set, problems);
  return problems;
}

/// Each section of a statement has a title, in a set that has titles at all.
void lint_titles(const VectorSet& set, std::vector<std::string>& problems) {
  if (set.sections.empty()) return;
  std::set<std::pair<std::string, std::string>> seen;
  for (const Statement& one : set.statements) {
    if (!results::is_numbered(one.section) || !seen.emplace(one.manual, one.section).second)
      continue;
    const auto titles = set.sections.find(one.manual);
    if (titles == set.sections.end() || results::title_of(titles->second, one.section).empty())
      problems.push_back(fmt::format("sections.json: no title of {} in {}, which {} is of",
                                     one.section, one.manual, one.id));
  }
}

std::vector<std::string> lint_statements(const VectorSet& set) {
  std::vector<std::string> problems;
  std::set<std::string_view> manuals, ids;
  for (const Manual& manual : set.manuals) manuals.insert(manual.id);
  for (const Statement& statement : set.statements) {
    if (!ids.insert(statement.id).second)
      problems.push_back(fmt::format("statements: the id {} is used twice", statement.id));
    if (!manuals.contains(statement.manual))
      problems.push_back(fmt::format("statements: {}: no manual '{}' in manuals.json", statement.id,
                                     statement.manual));
  }
  lint_citations(set, problems);
  lint_titles(set, problems);
  for (const SectionCoverage& section : coverage(set))
    for (const std::string& id : section.uncovered)
      problems.push_back(fmt::format("statements: {} has neither a vector nor a reason", id));
  return problems;
}

std::vector<std::string> lint_readings(const VectorSet& set) {
  std::map<std::string, std::pair<const Case*, std::vector<std::string>>>
      first;  // the vector that names most alternatives
  std::vector<std::string> problems;
  for (const Case& one : set.cases)
    for (const Step& step : one.steps)
      if (const std::vector<std::string> names = alternatives_of(step);
          !step.reading.empty() && first[step.reading].second.size() < names.size())
        first[step.reading] = {&one, names};
  for (const Case& one : set.cases)
    for (const Step& step : one.steps) {
      if (step.reading.empty()) continue;
      const auto& [model, known] = first[step.reading];
      const std::vector<std::string> names = alternatives_of(step);
      for (const std::string& name : names)
        if (std::ranges::find(known, name) == known.end())
          problems.push_back(fmt::format("{}: {}: reading {} has no alternative '{}' in {} ({})",
                                         one.file, one.id, step.reading, name, model->id,
                                         fmt::join(known, ", ")));
      if (names.front() != known.front())
        problems.push_back(fmt::format("{}: {}: reading {} prefers '{}', but '{}' in {}", one.file,
                                       one.id, step.reading, names.front(), known.front(),
                                       model->id));
    }
  return problems;
}

std::vector<std::string> lint_tables(const VectorSet& set, const harness::Protocols& protocols) {
  std::vector<std::string> problems;
  for (const Case& one : set.tables) {
    const harness::Protocol* protocol = protocols.find(one.protocol);
    const Status fact = protocol ? protocol->check_fact(one.facts)
                                 : Status(fail(fmt::format("no protocol '{}'", one.protocol)));
    if (!fact)
      problems.push_back(fmt::format("{}: {}: {}", one.file, one.id, fact.error().message));
  }
  return problems;
}

std::vector<SectionCoverage> coverage(const VectorSet& set) {
  std::set<std::string_view> cited;
  for (const std::vector<Case>* cases : {&set.cases, &set.tables})
    for (const Case& one : *cases)
      for (const std::string_view id : cited_by(one)) cited.insert(id);
  std::vector<SectionCoverage> sections;
  for (const Statement& statement : set.statements) {
    auto section = std::ranges::find_if(sections, [&](const SectionCoverage& s) {
      return s.manual == statement.manual && s.section == statement.section;
    });
    if (section == sections.end())
      section = sections.insert(sections.end(), {statement.manual, statement.section, 0, 0, 0, {}});
    ++section->statements;
    if (cited.contains(statement.id))
      ++section->covered;
    else if (!statement.reason.empty())
      ++section->reasoned;
    else
      section->uncovered.push_back(statement.id);
  }
  return sections;
}

}  // namespace fieldproof::vectors
