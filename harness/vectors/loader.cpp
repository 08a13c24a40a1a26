#include "harness/vectors/loader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "harness/vectors/case_reader.hpp"
#include "harness/vectors/citations.hpp"
#include "harness/vectors/errata.hpp"
#include "harness/vectors/fingerprint.hpp"
#include "harness/vectors/in_threads.hpp"
#include "harness/vectors/json/broken.hpp"
#include "harness/vectors/json/files.hpp"
#include "harness/vectors/json/framings.hpp"
#include "harness/vectors/json/pieces.hpp"
#include "harness/vectors/vector_shape.hpp"
#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::vectors {

namespace {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// An element that is no JSON: the position is that in the whole file.
json parse_piece(const Piece& piece, std::string_view file_text) {
  try {
    return json::parse(not_too_deep(piece.text));
  } catch (const json::exception&) {
    return json::parse(not_too_deep(file_text));  // throws the better message
  }
}

constexpr std::string_view of_vectors = "a file of vectors";

/// The vectors of one file.
class FileLoader {
 public:
  FileLoader(std::string_view text, const std::string& name, const LoadOptions& options,
             VectorSet& set)
      : text_(text), name_(name), options_(options), set_(set) {}

  void load() {
    for (const Piece& piece : pieces_of(text_, of_vectors))
      if (is_wanted(piece)) load(piece);
  }

 private:
  bool is_wanted(const Piece& piece) const {
    if (options_.filter.empty() || piece.id.empty() || may_match_filter(piece.id, options_.filter))
      return true;
    if (piece.text.find("\"framings\"") == std::string_view::npos) return false;
    return std::ranges::any_of(options_.protocols, [&](const harness::Protocol* protocol) {
      return protocol->dressing() &&
             may_match_filter(framed_id(piece.id, folder_of(*protocol)), options_.filter);
    });
  }

  void load(const Piece& piece) {
    const json vector = parse_piece(piece, text_);
    const std::vector<std::string> problems = shape_problems(vector, vector_shape());
    for (const std::string& problem : problems) report(piece, problem);
    if (problems.empty()) try {
        read(vector);
      } catch (const std::exception& error) {
        report(piece, json_trouble(error));
      }
  }

  void report(const Piece& piece, std::string_view problem) {
    set_.problems.push_back(fmt::format("{}:{}: {}: {}", name_, piece.line,
                                        piece.id.empty() ? "a vector" : piece.id, problem));
  }

  void read(const json& vector) {
    const std::vector<std::string> framings = framings_of(vector);
    for (const std::string& framing : framings) read(framed(vector, framing), framing);
    if (framings.empty()) read(vector, {});
  }

  void read(const json& vector, const std::string& framing) {
    const std::string& id = vector["id"].get_ref<const std::string&>();
    const harness::Protocol* protocol = options_.protocols.find(protocol_of(id));
    if (!framing.empty() && !(protocol && protocol->dressing())) throw no_framing(framing);
    const CaseReader reader(vector, name_, protocol ? protocol->dressing() : nullptr);
    std::vector<Case>& cases = vector.value("kind", "case") == "table" ? set_.tables : set_.cases;
    for (const Combination& one :
         combinations(vector.contains("each") ? vector["each"] : json::object())) {
      if (!matches_filter(id + one.suffix, options_.filter)) continue;
      cases.push_back(reader.read(one));
      if (const harness::Texts* const texts = protocol ? protocol->texts() : nullptr)
        check_texts(*texts, protocol->models().front(), cases.back());
    }
  }

  /// A case that no device could run is an invalid file.
  static void check_texts(const harness::Texts& texts, const std::string& first_model,
                          const Case& read) {
    std::vector<harness::Protocol::Setting> memory = read.memory;
    std::vector<std::string> actions;
    for (const Step& step : read.steps) {
      memory.insert(memory.end(), step.memory.begin(), step.memory.end());
      if (step.kind == Step::Kind::act) actions.push_back(step.action);
    }
    const std::vector<std::string> first{first_model};
    for (const std::string& model : read.models.empty() ? first : read.models)
      if (const Status right = texts.check_texts(model, read.config, memory, actions); !right)
        throw Broken(right.error().message);
  }

  Broken no_framing(const std::string& framing) const {
    std::vector<std::string> known;
    for (const harness::Protocol* protocol : options_.protocols)
      if (protocol->dressing()) known.push_back(folder_of(*protocol));
    const std::vector<std::string_view> views(known.begin(), known.end());
    return Broken(fmt::format("framings: no protocol frames a shared body as '{}'{}", framing,
                              suggestion(framing, views)));
  }

  std::string_view text_;
  const std::string& name_;
  const LoadOptions& options_;
  VectorSet& set_;
};

/// All files of a folder into one set.
class FolderLoader {
 public:
  FolderLoader(const LoadOptions& options, VectorSet& set) : options_(options), set_(set) {}

  void load(const fs::path& folder) {
    const fs::path base = fs::is_directory(folder) ? folder : folder.parent_path();
    for (const fs::path& path : json_files(folder))
      load_file(path, path.lexically_relative(base).generic_string());
    load_vector_files();
    drop_errata_not_met();
    const bool all = options_.filter.empty() && !statement_files_.empty();
    if (statement_files_.empty()) find_statements(base);
    load_all_statements(all);
    if (!options_.known_set.empty() && !all_are_known() && find_statements(options_.known_set))
      load_all_statements(false);
    set_.hash = fmt::format("{:016x}", hash_);
    if (!set_.problems.empty()) return;  // what was not read would be missed everywhere else
    resolve_errata(set_);
    resolve_citations(set_);
  }

 private:
  void guarded(const std::string& name, auto&& act) { guarded(set_, name, act); }

  static void guarded(VectorSet& set, const std::string& name, auto&& act) {
    try {
      act();
    } catch (const std::exception& error) {
      set.problems.push_back(fmt::format("{}: {}", name, json_trouble(error)));
    }
  }

  void load_file(const fs::path& path, const std::string& name) {
    if (name.ends_with("schema.json") || name.starts_with("wires/") ||
        name.starts_with("citations/") || name == "faults.json")
      return;
    guarded(name, [&] {
      std::string text = text_of_file(path);
      hash_ = extend_fingerprint(extend_fingerprint(hash_, name), text);
      if (name == "manuals.json")
        load_manuals(text);
      else if (name == "sections.json")
        set_.sections = json::parse(not_too_deep(text)).get<decltype(set_.sections)>();
      else if (name.starts_with("statements/"))
        statement_files_.emplace_back(name, std::move(text));
      else if (name.starts_with("errata/"))
        load_errata(text, name, set_);
      else
        vector_files_.emplace_back(name, std::move(text));
    });
  }

  /// Most of the time of a start goes here; files do not know of one another.
  void load_vector_files() {
    std::vector<VectorSet> parts(vector_files_.size());
    in_threads(parts.size(), [&](std::size_t i) {
      const auto& [name, text] = vector_files_[i];
      guarded(parts[i], name, [&] { FileLoader(text, name, options_, parts[i]).load(); });
    });
    for (VectorSet& part : parts) {
      std::ranges::move(part.cases, std::back_inserter(set_.cases));
      std::ranges::move(part.tables, std::back_inserter(set_.tables));
      std::ranges::move(part.problems, std::back_inserter(set_.problems));
    }
  }

  /// Those of a set stand in it; those of a part of a set, one folder up.
  bool find_statements(const fs::path& base) {
    const fs::path here = fs::absolute(base.empty() ? "." : base).lexically_normal();
    for (const fs::path& place : {here, here.parent_path()})
      if (const fs::path folder = place / "statements"; fs::is_directory(folder)) {
        statement_files_.clear();
        for (const fs::path& path : json_files(folder))
          statement_files_.emplace_back(path.string(), text_of_file(path));
        return true;
      }
    return false;
  }

  std::set<std::string, std::less<>> loaded() const {
    std::set<std::string, std::less<>> ids;
    for (const Statement& one : set_.statements) ids.insert(one.id);
    return ids;
  }

  bool all_are_known() { return std::ranges::includes(loaded(), cited(), std::less<>{}); }

  /// `all`, or those that the cases cite, each once.
  void load_all_statements(bool all) {
    const auto known = loaded();
    for (const auto& [name, text] : statement_files_)
      guarded(name, [&] {
        for (const Piece& piece : pieces_of(text, of_vectors))
          if ((all || cited().contains(piece.id)) && !known.contains(piece.id))
            load_statement(parse_piece(piece, text));
      });
  }

  void load_statement(const json& value) {
    const std::string id = value.at("id");
    set_.statements.push_back({id, id.substr(0, id.find('/')), value.at("section"),
                               value.at("quote"), value.value("reason", "")});
  }

  /// Of selected cases only the errata that they met, with all statements that these name.
  void drop_errata_not_met() {
    if (options_.filter.empty()) return;
    std::erase_if(set_.errata, [&](const Erratum& one) {
      return std::ranges::none_of(
          one.places, [&](const Passage& place) { return cited().contains(place.statement); });
    });
    for (const Erratum& one : set_.errata)
      for (const std::string_view id : statements_of(one)) cited_.insert(id);
  }

  std::set<std::string_view>& cited() {
    if (cited_.empty())
      for (const std::vector<Case>* cases : {&set_.cases, &set_.tables})
        for (const Case& one : *cases)
          for (const std::string_view id : cited_by(one)) cited_.insert(id);
    return cited_;
  }

  void load_manuals(std::string_view text) {
    for (const json& value : json::parse(not_too_deep(text)))
      set_.manuals.push_back(
          {value.at("id"), value.at("file"), value.at("title"), value.at("edition")});
  }

  const LoadOptions& options_;
  VectorSet& set_;
  std::uint64_t hash_ = empty_fingerprint;
  std::vector<std::pair<std::string, std::string>> vector_files_, statement_files_;  // name, text
  std::set<std::string_view> cited_;
};

void report_duplicates(VectorSet& set) {
  std::set<std::string_view> ids;
  for (const std::vector<Case>* cases : {&set.cases, &set.tables})
    for (const Case& one : *cases)
      if (!ids.insert(one.id).second)
        set.problems.push_back(
            fmt::format("{}: the id {} is used twice; ids are chosen once", one.file, one.id));
}

}  // namespace

std::string folder_of(const harness::Protocol& protocol) {
  std::string folder(protocol.name());
  std::ranges::replace(folder, '-', '_');
  return folder;
}

void load_vector_text(std::string_view text, const std::string& file, VectorSet& set,
                      const LoadOptions& options) {
  FileLoader(text, file, options, set).load();
}

VectorSet load_vectors(const fs::path& folder, const LoadOptions& options) {
  VectorSet set;
  if (!fs::exists(folder)) {
    set.problems.push_back(
        fmt::format("cannot find the vectors in {}; name their folder, or one file, with --vectors",
                    folder.string()));
    return set;
  }
  FolderLoader(options, set).load(folder);
  report_duplicates(set);
  std::ranges::sort(set.cases, {}, &Case::id);
  return set;
}

}  // namespace fieldproof::vectors
