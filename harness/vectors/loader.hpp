// Vector files to cases: JSON, schema, expansion of `each`, notation. Nothing here knows a
// protocol.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/vectors/case.hpp"
#include "src/base/result.hpp"

namespace fieldproof::vectors {

struct Erratum {
  std::string vector_id, manual, section;
  std::string printed, correct, why;
};

/// A testable statement of a manual (vectors/statements).
struct Statement {
  std::string id, manual, section, quote;
  std::string reason;  // why no vector tests it; empty when one must
};

struct Manual {
  std::string id, file, title, edition;
};

/// All that a folder of vectors holds. A broken file does not hide the others: `problems` names
/// each, with file, vector and key; a run starts only without any.
struct VectorSet {
  std::vector<Case> cases;   // expanded, sorted by id; without tables
  std::vector<Case> tables;  // kind table
  std::vector<Erratum> errata;
  std::vector<Statement> statements;
  std::vector<Manual> manuals;
  std::vector<std::string> problems;
  std::string hash;       // of all files, to tell vector sets apart
  nlohmann::json schema;  // vectors/schema.json; null: files are not checked against it
};

/// A folder, or one file of vectors. The folder's own schema.json, where it has one, else
/// `schema_file`.
VectorSet load_vectors(const std::filesystem::path& folder,
                       const std::filesystem::path& schema_file = {});

/// Adds the second entry of the double entry: `folder`/wires/**.json gives the literal bytes of
/// each step of a case,
/// {"CASE ID": {"STEP": "05 30 .."}}, where the vector itself prints none. Only `lint` needs them.
void load_wires(const std::filesystem::path& folder, VectorSet& set);

/// The vectors of one file's text; `file` is for messages. Used by load_vectors and by tests.
void load_vector_text(std::string_view text, const std::string& file, VectorSet& set);

/// "*" and "?" as in a shell; '*' crosses '/'. Alternatives are separated by ':' and a leading '-'
/// excludes.
bool matches_filter(std::string_view id, std::string_view filter);

}  // namespace fieldproof::vectors
