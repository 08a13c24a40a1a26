// What a device declares: model, protocols, configuration, timing ("response_max": "500ms", or
// "response_max_ms": 500). It selects cases; what is not declared is SKIP.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "harness/vectors/binding.hpp"
#include "src/base/result.hpp"
#include "src/base/time.hpp"

namespace fieldproof::bench {

struct Profile {
  std::string name;  // "xbc-h"
  std::string title;
  std::string model;  // selects vectors by `models`; empty: the model of each case (emulators only)
  std::vector<std::string> protocols;  // "xgt-cnet"
  vectors::Binding decisions;          // "decisions": "binding", "advisory", or a list of ids
  bool peer = false;                   // "peer": a program that tests this bench, no module
  nlohmann::json config =
      nlohmann::json::object();  // the declared configuration, keys of given.config
  /// P2P blocks that are set up in the real module, as in given.config.p2p.blocks (with "parameter"
  /// where it is not 1).
  nlohmann::json prepared_blocks = nlohmann::json::array();
  std::vector<std::pair<std::string, std::string>> exclude;  // glob and reason: SKIP
  std::string notes;  // what the manuals do not print of this device, and what follows from it

  Duration response_max = 500ms;  // the manuals print none (DECISIONS.md server/reply-time)
  Duration turnaround_min{};  // no reply begins sooner; 0: no such limit (the manuals print none)
  double guard_band = 0.1;    // the last tenth of a limit is MARGINAL
  Duration floor{};           // the link's own uncertainty; 0: the endpoint's
  Duration max_gap{};         // silence allowed inside a reply; 0: 3.5 characters of 11 bits
};

/// The file of a profile: a path as it stands (it has a '/' or ends with .json), a name in
/// `folder`.
std::filesystem::path profile_path(const std::string& name_or_path,
                                   const std::filesystem::path& folder);

/// The names of the profiles in `folder`, sorted; none where there is no such folder.
std::vector<std::string> profile_names(const std::filesystem::path& folder);

/// Reads NAME from `folder`/NAME.json, or a path. "extends" names another profile, of its own
/// folder or of `folder`: what stands there holds where this one says nothing; objects are laid
/// over each other key by key, exclusions add up. Errors name the file and the key; an unknown name
/// suggests a near one, a circle is told in full.
Result<Profile> load_profile(const std::string& name_or_path, const std::filesystem::path& folder);

/// One profile's text, with what it extends already loaded into `base`.
Result<Profile> parse_profile(const std::string& text, const std::string& file, Profile base);

}  // namespace fieldproof::bench
