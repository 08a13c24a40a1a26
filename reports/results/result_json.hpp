// How what a result is stands in results.ndjson and results.json (results.schema.json).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "reports/results/case_result.hpp"
#include "reports/results/soak.hpp"

namespace fieldproof::results {

/// Each appends one JSON object without line breaks. What is not UTF-8 becomes U+FFFD.
void append_json(std::string& out, const CaseResult& result);
void append_json(std::string& out, const RunInfo& info);
void append_json(std::string& out, const RunEnd& end);
void append_json(std::string& out, const SoakSample& sample);
void append_json(std::string& out, const SoakSummary& soak);
void append_json(std::string& out, const std::vector<SoakSample>& samples);
void append_json(std::string& out, const std::map<std::string, ResponseFigures>& figures);

/// Throw nlohmann::json::exception on a foreign shape.
void from_json(const nlohmann::json& json, CaseResult& result);
void from_json(const nlohmann::json& json, RunInfo& info);
void from_json(const nlohmann::json& json, RunEnd& end);
void from_json(const nlohmann::json& json, SoakSample& sample);
void from_json(const nlohmann::json& json, SoakSummary& soak);

}  // namespace fieldproof::results
