// JSON Schema (draft 7) by valijson, kept in one translation unit.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace fieldproof::vectors {

/// What is wrong with `document` under `schema`, one line each: "[3][steps][0]: ...". Empty:
/// nothing.
std::vector<std::string> schema_problems(const nlohmann::json& schema,
                                         const nlohmann::json& document);

}  // namespace fieldproof::vectors
