// The schemas of vectors/, which editors read, and the tables that we check by, are one.
#include "harness/vectors/vector_shape.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "harness/vectors/errata.hpp"
#include "harness/vectors/lint/citation_rules.hpp"
#include "reports/results/whole_file.hpp"

namespace fieldproof::vectors::schemas_test {
namespace {

using nlohmann::json;
using Kind = Shape::Kind;

json texts_of(std::span<const std::string_view> words) {
  json list = json::array();
  for (const std::string_view word : words) list.push_back(std::string(word));
  return list;
}

json sorted(json list) {
  std::sort(list.begin(), list.end());
  return list;
}

json schema_of(const Shape& shape);

void add_text(const Shape& shape, json& schema) {
  schema["type"] = "string";
  if (shape.least) schema["minLength"] = shape.least;
  if (shape.most != ~0u) schema["maxLength"] = shape.most;
  if (shape.form) schema["pattern"] = std::string(shape.form->pattern);
  if (shape.words.empty()) return;
  if (shape.filled)
    schema["anyOf"] = {{{"enum", texts_of(shape.words)}}, {{"pattern", "^\\$\\{[a-z0-9_]+\\}$"}}};
  else
    schema["enum"] = texts_of(shape.words);
}

void add_demands(const Shape& shape, json& schema) {
  for (const Demand& demand : shape.demands) {
    const std::string key(demand.key);
    json rule{{"if",
               {{"properties", {{key, {{"enum", texts_of(demand.words)}}}}},
                {"required", json::array({key})}}}};
    if (!demand.then.empty()) rule["then"]["required"] = json::array({std::string(demand.then)});
    if (!demand.otherwise.empty())
      rule["else"]["required"] = json::array({std::string(demand.otherwise)});
    schema["allOf"].push_back(rule);
  }
}

void add_object(const Shape& shape, json& schema) {
  schema["type"] = "object";
  if (shape.least) schema["minProperties"] = shape.least;
  for (const Key& key : shape.keys) {
    schema["properties"][std::string(key.name)] = schema_of(*key.shape);
    if (key.required) schema["required"].push_back(std::string(key.name));
  }
  if (schema.contains("required")) schema["required"] = sorted(schema["required"]);
  if (!shape.open) schema["additionalProperties"] = false;
  if (shape.others) schema["additionalProperties"] = schema_of(*shape.others);
  add_demands(shape, schema);
}

/// The table as a JSON Schema.
json schema_of(const Shape& shape) {
  json schema = json::object();
  switch (shape.kind) {
    case Kind::text: add_text(shape, schema); break;
    case Kind::number:
      schema["type"] = "integer";
      schema["minimum"] = shape.least;
      if (shape.most != ~0u) schema["maximum"] = shape.most;
      break;
    case Kind::boolean: schema["type"] = "boolean"; break;
    case Kind::yes: schema["const"] = true; break;
    case Kind::object: add_object(shape, schema); break;
    case Kind::list:
      schema["type"] = "array";
      if (shape.least) schema["minItems"] = shape.least;
      if (shape.items) schema["items"] = schema_of(*shape.items);
  }
  if (!shape.instead) return schema;
  return {{"oneOf", {schema, schema_of(*shape.instead)}}};
}

/// A schema without references and descriptions.
json resolved(const json& schema, const json& root) {
  if (schema.is_array()) {
    json list = json::array();
    for (const json& one : schema) list.push_back(resolved(one, root));
    return list;
  }
  if (!schema.is_object()) return schema;
  if (schema.contains("$ref"))
    return resolved(
        root.at(json::json_pointer(schema["$ref"].get_ref<const std::string&>().substr(1))), root);
  json result = json::object();
  for (const auto& [keyword, rule] : schema.items()) {
    if (keyword == "description" && rule.is_string()) continue;
    result[keyword] = resolved(rule, root);
    if (keyword == "required") result[keyword] = sorted(rule);
  }
  return result;
}

json schema_file(const std::string& name = "schema.json") {
  return json::parse(*results::read_whole_file(FIELDPROOF_SOURCE_DIR "/vectors/" + name));
}

void expect_one(const json& file, const Shape& shape) {
  EXPECT_EQ(file["type"], "array");
  const json printed = resolved(file["items"], file), table = schema_of(shape);
  EXPECT_TRUE(printed == table) << "the schema becomes the table by\n"
                                << json::diff(printed, table).dump(1);
}

TEST(VectorShape, IsWhatTheSchemaSaysToEditors) { expect_one(schema_file(), vector_shape()); }

TEST(ErratumShape, IsWhatTheSchemaSaysToEditors) {
  expect_one(schema_file("errata.schema.json"), erratum_shape());
}

TEST(CitationRuleShape, IsWhatTheSchemaSaysToEditors) {
  expect_one(schema_file("citations.schema.json"), citation_rule_shape());
}

TEST(VectorShape, EveryDefinitionOfTheSchemaIsUsed) {
  for (const char* schema : {"schema.json", "errata.schema.json", "citations.schema.json"}) {
    const json file = schema_file(schema);
    for (const auto& [name, definition] : file["definitions"].items())
      EXPECT_THAT(file.dump(), testing::HasSubstr("\"#/definitions/" + name + "\""));
  }
}

TEST(VectorShape, PatternsAndTheirCodeAgree) {
  const std::vector<std::string> samples{"",       "a",        "a_1",
                                         "A",      "a/b",      "a/b/c_2",
                                         "/a",     "a/",       "a//b",
                                         "a-b/c",  "1",        "10ms",
                                         "1.5s",   "20us",     ".5s",
                                         "1.s",    "5 ms",     "ms",
                                         "1.5",    "1.2.3s",   "${gap}",
                                         "${}",    "${gap",    "x${gap}",
                                         "${Gap}", "${a b}",   "05",
                                         "05 3F",  "05 3f ??", "0x05",
                                         "05,06",  " ",        "xgt_cnet/rss/two_words"};
  for (const Form* form : vector_forms())
    for (const std::string& sample : samples)
      EXPECT_EQ(form->fits(sample),
                std::regex_search(sample, std::regex(std::string(form->pattern))))
          << form->like << ": '" << sample << "'";
}

}  // namespace
}  // namespace fieldproof::vectors::schemas_test
