#include "reports/compare/result_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reports/compare/junit_reader.hpp"
#include "reports/results/ndjson.hpp"
#include "reports/results/result_json.hpp"
#include "reports/results/whole_file.hpp"
#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"

namespace fieldproof::compare {
namespace {

using nlohmann::json;

constexpr int newest_schema = 1;

/// The first line of NDJSON is {"run": ...} and nothing else.
bool is_ndjson(const std::string& text) {
  const json first = json::parse(
      text.begin(),
      text.begin() + static_cast<std::ptrdiff_t>(std::min(text.find('\n'), text.size())), nullptr,
      false);
  return first.is_object() && first.size() == 1 && first.contains("run");
}

Result<ResultFile> from_ndjson(const std::string& path) {
  ResultFile file;
  auto log = results::read_ndjson(
      path, [&](const results::CaseResult& result) { file.results.push_back(result); });
  if (!log) return log.error();
  file.run = std::move(log->run);
  file.end = std::move(log->end);
  return file;
}

Result<ResultFile> from_json_text(const std::string& path, const std::string& text) {
  const auto broken = [&](const std::string& place, const std::string& cause) {
    return fail(fmt::format(
        "cannot read {}{}: {}; is it results.json, results.ndjson or JUnit, and complete?", path,
        place, cause));
  };
  ResultFile file;
  std::string place;
  try {
    const json document = json::parse(not_too_deep(text));
    if (!document.is_object() || !document.contains("cases") || !document.contains("run"))
      return broken("", "it is JSON, but no result of a run");
    const int schema = document.value("schema", 0);
    if (schema < 1 || schema > newest_schema)
      return fail(
          fmt::format("cannot read {}: its schema is {}, this version knows {}; use the version "
                      "that wrote it, or a newer one",
                      path, schema, newest_schema));
    place = ", run";
    document.at("run").get_to(file.run);
    for (const json& one : document.at("cases")) {
      place = fmt::format(", case {}", file.results.size() + 1);
      file.results.push_back(one.get<results::CaseResult>());
    }
    place = ", end";
    if (const json& end = document.value("end", json()); !end.is_null())
      file.end = end.get<results::RunEnd>();
  } catch (const json::exception& error) {
    return broken(place, json_trouble(error));
  }
  return file;
}

}  // namespace

Result<ResultFile> read_result_file(const std::string& path) {
  const Result<std::string> text = results::read_whole_file(path);
  if (!text) return text.error();
  const std::size_t start = text->starts_with("\xEF\xBB\xBF") ? 3 : 0;
  const std::size_t first = text->find_first_not_of(" \t\r\n", start);
  if (first == std::string::npos)
    return fail(
        fmt::format("cannot read {}: it is empty; the run was killed before it began", path));
  Result<ResultFile> file = (*text)[first] == '<' ? read_junit_text(*text, path)
                            : is_ndjson(*text)    ? from_ndjson(path)
                                                  : from_json_text(path, *text);
  if (file) file->path = path;
  return file;
}

}  // namespace fieldproof::compare
