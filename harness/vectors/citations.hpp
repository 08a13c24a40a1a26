// What cases rest on: from the ids of statements to their words.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "harness/vectors/loader.hpp"

namespace fieldproof::vectors {

using StatementsById = std::map<std::string_view, const Statement*>;

/// Points into the set.
StatementsById statements_by_id(const VectorSet& set);
/// "no statement 'm/2' in statements/; did you mean 'm/1'?".
std::string no_statement(std::string_view id, const StatementsById& known);

/// The ids of all statements that a case or one of its steps names, in order, each once.
std::vector<std::string_view> cited_by(const Case& one);

/// Gives each case and each step that has no words of its own those of the first statement that it
/// names. Where that is not there, it is a problem of the set, with the nearest one that is.
void resolve_citations(VectorSet& set);

}  // namespace fieldproof::vectors
