// GitHub's action and GitLab's component, as the recipes of README use them: their YAML is read by
// a reader that is not ours, and their script lines are run.
#include <gmock/gmock.h>

#include <regex>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// The documents of a YAML file; none where there is no reader.
json read_yaml(const std::string& path) {
  const Finished read = run_program(
      {"/usr/bin/python3", "-c",
       "import json, sys, yaml\nprint(json.dumps(list(yaml.safe_load_all(open(sys.argv[1])))))",
       path});
  EXPECT_EQ(read.code, 0) << path << ": " << read.err;
  return json::parse(read.out, nullptr, false);
}

/// The block of README that has this word.
std::string recipe_with(const std::string& word) {
  const std::string readme = read_text(FIELDPROOF_SOURCE_DIR "/README.md");
  const std::string fence = "```yaml\n";
  for (std::size_t at = 0; (at = readme.find(fence, at)) != std::string::npos;) {
    at += fence.size();
    const std::string block = readme.substr(at, readme.find("```", at) - at);
    if (block.find(word) != std::string::npos) return block;
  }
  ADD_FAILURE() << "README has no recipe with " << word;
  return {};
}

class Recipes : public testing::Test {
 protected:
  Recipes() {
    script("my_plc", "exec " FIELDPROOF_TOOL " emulate xbc-h --pty \"$1\"");
    // Readme.RecipesPassAsPrinted runs all that the filter of a recipe selects; here a few do.
    for (const char* name : {"run.sh", "fieldproof/run.sh"})
      script(name,
             "for one; do\n  shift\n  case $one in '*:-'*) one='xgt_cnet/rs*/*refused/*' ;; esac\n"
             "  set -- \"$@\" \"$one\"\ndone\nexec " FIELDPROOF_TOOL " \"$@\"");
  }

  void SetUp() override {
    if (run_program({"/usr/bin/python3", "-c", "import yaml"}).code != 0)
      GTEST_SKIP() << "python3-yaml is not installed";
  }

  void script(const std::string& name, const std::string& text) const {
    std::filesystem::permissions(folder_.write(name, "#!/bin/sh\n" + text + "\n"),
                                 std::filesystem::perms::owner_all);
  }

  /// Of the recipe, over the defaults; what has none must be given, and nothing else is.
  static std::map<std::string, std::string> inputs(const json& declared, const json& given) {
    std::map<std::string, std::string> values;
    for (const auto& [name, input] : declared.items()) {
      EXPECT_TRUE(input.contains("default") || given.contains(name)) << name << " is not given";
      if (input.contains("default")) values[name] = input["default"];
    }
    for (const auto& [name, value] : given.items()) {
      EXPECT_TRUE(declared.contains(name)) << "there is no input " << name;
      values[name] = value;
    }
    return values;
  }

  /// "${{ inputs.x }}" or "$[[ inputs.x ]]" by its value.
  static std::string filled(std::string text, const std::map<std::string, std::string>& values) {
    const std::regex hole(R"re(\$(?:\{\{|\[\[) inputs\.(\w+) (?:\}\}|\]\]))re");
    for (std::smatch found; std::regex_search(text, found, hole);)
      text.replace(static_cast<std::size_t>(found.position()),
                   static_cast<std::size_t>(found.length()), values.at(found[1]));
    return text;
  }

  void expect_green(const std::vector<std::string>& shell, const ProcessOptions& options) const {
    const Finished finished = run_program(shell, options);
    EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
    EXPECT_THAT(finished.out, HasSubstr("exec:./my_plc {tty}  profile xbc-h"));
    const Results results = read_results(folder_ / "fieldproof-out/results.ndjson");
    EXPECT_THAT(results.run.at("properties").at("gate").get<std::string>(), HasSubstr("90"))
        << "the arguments came through";
    expect_reports(folder_ / "fieldproof-out");
  }

  TestFolder folder_;
};

TEST_F(Recipes, of_github_runs) {
  const json action = read_yaml(FIELDPROOF_SOURCE_DIR "/action.yml").at(0);
  for (const char* key : {"name", "description", "inputs", "runs"})
    EXPECT_TRUE(action.contains(key)) << key;
  EXPECT_EQ(action["runs"]["using"], "composite");

  const json recipe = read_yaml(folder_.write("recipe.yml", recipe_with("jobs:"))).at(0);
  const json& steps = recipe.at("jobs").at("conformance").at("steps");
  const auto ours = std::ranges::find_if(steps, [](const json& step) {
    return step.value("uses", "").find("/fieldproof@v" FIELDPROOF_VERSION) != std::string::npos;
  });
  ASSERT_NE(ours, steps.end()) << "the recipe uses the action, in this version";
  const auto values = inputs(action["inputs"], ours->at("with"));
  for (const json& step : action["runs"]["steps"]) {
    ProcessOptions options{.environment = {{"GITHUB_ACTION_PATH", folder_.path()}},
                           .folder = folder_.path()};
    for (const auto& [name, value] : step.at("env").items())
      options.environment.emplace_back(name, filled(value, values));
    EXPECT_THAT(step.at("run").get<std::string>(), Not(HasSubstr("${{")))
        << "what a user writes is no part of a script";
    expect_green({step.at("shell"), "-e", "-c", step.at("run")}, options);
  }
}

TEST_F(Recipes, of_gitlab_runs) {
  const json component = read_yaml(FIELDPROOF_SOURCE_DIR "/templates/conformance/template.yml");
  ASSERT_EQ(component.size(), 2u) << "a header, and the jobs";
  const json recipe = read_yaml(folder_.write("recipe.yml", recipe_with("component:"))).at(0);
  const json& include = recipe.at("include").at(0);
  EXPECT_TRUE(include.at("component")
                  .get<std::string>()
                  .ends_with("/fieldproof/conformance@" FIELDPROOF_VERSION));
  const auto values = inputs(component[0].at("spec").at("inputs"), include.at("inputs"));
  const json& job = component[1].at("conformance");
  ProcessOptions options{.environment = {}, .folder = folder_.path()};
  for (const auto& [name, value] : job.at("variables").items())
    if (value.is_object()) options.environment.emplace_back(name, filled(value["value"], values));
  std::string script = "set -e\n";
  for (const json& line : job.at("script")) script += filled(line, values) + '\n';
  expect_green({"sh", "-c", script}, options);
  EXPECT_EQ(job["artifacts"]["reports"]["junit"], "fieldproof-out/junit.xml");
}

}  // namespace
}  // namespace fieldproof::tool_tests
