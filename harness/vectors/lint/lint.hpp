// What must hold of the vectors beyond their shape: literal bytes against notation, statements,
// quotes, tables.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/protocols.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::vectors {

/// `wire` against the notation, at the station that the vector gives. Every step that the vector
/// sends or expects has literal bytes, so that no byte of a vector can change unnoticed.
std::vector<std::string> lint_wires(const VectorSet& set, const harness::Protocols& protocols);

/// A serial line is neither opened nor closed by a step.
std::vector<std::string> lint_links(const VectorSet& set, const harness::Protocols& protocols);

/// No case repeats the exchange of another: the same bytes in all steps, with the same device,
/// memory and line. Each problem names both.
std::vector<std::string> lint_duplicates(const VectorSet& set, const harness::Protocols& protocols);

/// What makes verdicts of these cases worthless, checked before a run: words of a notation that the
/// protocol does not have, literal bytes that contradict it, a manual or a statement that there is
/// not (in a set that has manuals), a link that is not open or a serial line that is closed.
std::vector<std::string> contradictions(const VectorSet& set, const harness::Protocols& protocols);

/// Cited statements exist, every statement has a vector or a reason, manuals are known, ids are
/// unique.
std::vector<std::string> lint_statements(const VectorSet& set);

/// One name ties all vectors of a reading together: each names the same alternatives, the same one
/// preferred.
std::vector<std::string> lint_readings(const VectorSet& set);

/// Facts of kind `table` against the tables in src/.
std::vector<std::string> lint_tables(const VectorSet& set, const harness::Protocols& protocols);

/// Each quote stands in its manual's text (white space folded) and has five words or is a table
/// row.
std::vector<std::string> lint_quotes(const VectorSet& set, const std::filesystem::path& manuals);

/// The lock file: one line "HASH ID" for each quote, as last verified against the manuals.
std::string quotes_lock(const VectorSet& set);
/// Quotes that are not the ones locked, by id.
std::vector<std::string> lint_lock(const VectorSet& set, const std::string& lock);

/// Statements by section: how many there are, have a vector, or carry a reason.
struct SectionCoverage {
  std::string manual, section;
  int statements = 0, covered = 0, reasoned = 0;
  std::vector<std::string> uncovered;  // ids
};
std::vector<SectionCoverage> coverage(const VectorSet& set);

/// White space folded to single spaces.
std::string fold_space(std::string_view text);

}  // namespace fieldproof::vectors
