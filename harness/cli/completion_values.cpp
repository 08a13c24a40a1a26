#include "harness/cli/completion_values.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "harness/bench/files/profile.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/paths.hpp"
#include "harness/run/tool_vectors.hpp"

namespace fieldproof::cli {

namespace {

using Words = std::vector<std::string>;

/// Globs are separated by ':', and '-' excludes: what stands before the last one stays.
Words filters(const harness::Protocols& protocols, const std::string& beginning) {
  std::size_t begin = beginning.rfind(':') + 1;
  if (begin < beginning.size() && beginning[begin] == '-') ++begin;
  const std::string before = beginning.substr(0, begin), id = beginning.substr(begin);
  const Result<vectors::VectorSet> set = run::load_sound_vectors("", protocols, id + '*');
  if (!set) return {};
  std::set<std::string> found;
  for (const vectors::Case& one : set->cases)
    if (one.id.starts_with(id)) {
      const std::size_t slash = one.id.find('/', id.size());
      found.insert(before + one.id.substr(0, slash == std::string::npos ? slash : slash + 1));
    }
  return {found.begin(), found.end()};
}

Words protocol_names(const harness::Protocols& protocols) {
  Words names;
  for (const harness::Protocol* one : protocols) names.emplace_back(one->name());
  return names;
}

Words models(const harness::Protocols& protocols) {
  std::set<std::string> found;
  for (const harness::Protocol* one : protocols)
    if (one->has_frames())
      for (const std::string& model : one->models()) found.insert(model);
  return {found.begin(), found.end()};
}

Words endpoint_kinds() {
  Words kinds;
  for (const endpoints::KindOf& one : endpoints::all_kinds())
    kinds.push_back(std::string(one.name) + ':');
  return kinds;
}

}  // namespace

usage::Values completion_values(const harness::Protocols& protocols) {
  return [protocols](const usage::Command&, const usage::Option& option,
                     const std::string& beginning) -> Words {
    const std::string& name = option.names.back();
    if (name == "--filter" || name == "filter") return filters(protocols, beginning);
    if (name == "--profile") return bench::profile_names(harness::find_data().profiles);
    if (name == "--protocol") return protocol_names(protocols);
    if (name == "model") return models(protocols);
    for (const std::string_view takes : {"--endpoint", "--aux", "--loop", "endpoint"})
      if (name == takes) return endpoint_kinds();
    return {};
  };
}

}  // namespace fieldproof::cli
