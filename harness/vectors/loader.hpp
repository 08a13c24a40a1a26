// Vector files to cases. Nothing here knows a protocol by name: what one makes of a shared body, it
// says itself.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/protocols.hpp"
#include "harness/vectors/case.hpp"
#include "harness/vectors/filter.hpp"
#include "reports/results/section_titles.hpp"
#include "src/base/result.hpp"

namespace fieldproof::vectors {

/// Words of a manual. `statement` may be empty: no case rests on them.
struct Passage {
  std::string statement, manual, section, quote;
};

/// A mistake of a manual, once, with all its places (vectors/errata). Cases whose statements stand
/// in its places were made by what is right.
struct Erratum {
  std::string id, kind;
  std::string printed, right;
  std::string why, effect;  // how `proof` shows it; what a reader would do wrong
  std::string doubt;        // empty, or why it may be no mistake of the maker
  std::vector<Passage> places, proof;
  std::string at;  // "errata/cnet_7.json:12", for messages
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
/// each, with file, line, vector and key; a run starts only without any.
struct VectorSet {
  std::vector<Case> cases;   // expanded, sorted by id; without tables
  std::vector<Case> tables;  // kind table
  std::vector<Erratum> errata;
  std::vector<Statement> statements;
  std::vector<Manual> manuals;
  std::map<std::string, results::SectionTitles> sections;  // by manual
  std::vector<Decision> decisions;                         // load_decisions
  std::vector<std::string> problems;
  std::string hash;  // of all files, to tell vector sets apart
};

/// The folder of its vectors, with which their ids begin: "xgt_cnet".
std::string folder_of(const harness::Protocol& protocol);

/// What to load. The protocols dress pdu(...), and say which framings there are.
struct LoadOptions {
  harness::Protocols protocols{{}};
  /// Not empty: only cases that match, and the statements that they cite. Vectors that cannot have
  /// such a case are not parsed, so nobody notices what is wrong in them.
  std::string filter{};
  /// A set whose statements may be cited by others, too; empty: there is none.
  std::filesystem::path known_set{};
};

/// A folder, or one file of vectors.
VectorSet load_vectors(const std::filesystem::path& folder, const LoadOptions& options = {});

/// Adds the second entry of the double entry: `folder`/wires/**.json gives the literal bytes of
/// each step of a case,
/// {"CASE ID": {"STEP": "05 30 .."}}, where the vector itself prints none. Only `lint` needs them.
void load_wires(const std::filesystem::path& folder, VectorSet& set);

/// The vectors of one file's text; `file` is for messages. Used by load_vectors and by tests.
void load_vector_text(std::string_view text, const std::string& file, VectorSet& set,
                      const LoadOptions& options = {});

}  // namespace fieldproof::vectors
