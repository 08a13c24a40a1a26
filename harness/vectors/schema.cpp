#include "harness/vectors/schema.hpp"

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace fieldproof::vectors {

namespace {

/// valijson's sentence about an unknown key is long and hides the key at its end.
std::string in_words(const std::string& description) {
  constexpr std::string_view unknown_key = "Object contains a property that could not be validated";
  if (!description.starts_with(unknown_key)) return description;
  const std::size_t colon = description.rfind(": ");
  return "unknown key " +
         (colon == std::string::npos ? description : description.substr(colon + 2));
}

}  // namespace

std::vector<std::string> schema_problems(const nlohmann::json& schema,
                                         const nlohmann::json& document) {
  valijson::Schema compiled;
  valijson::SchemaParser parser;
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema), compiled);
  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(compiled, valijson::adapters::NlohmannJsonAdapter(document), &results))
    return {};
  // valijson reports the innermost problem first; the outer ones only repeat that something inside
  // is wrong.
  std::vector<std::string> problems;
  valijson::ValidationResults::Error error;
  while (results.popError(error)) {
    std::string path;
    for (const std::string& part : error.context)
      if (part != "<root>") path += part;
    problems.push_back(path + ": " + in_words(error.description));
  }
  return problems;
}

}  // namespace fieldproof::vectors
