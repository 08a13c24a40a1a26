// How a real device is set up for a case: as the profile declares it, and in what it can be given
// (marks of exec:, --control) as the case needs it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "harness/bench/files/profile.hpp"
#include "harness/endpoints/endpoint.hpp"
#include "harness/endpoints/set_up/command_marks.hpp"
#include "harness/protocol.hpp"
#include "harness/vectors/case.hpp"

namespace fieldproof::bench {

/// What a device has that declares nothing.
const nlohmann::json& default_config();

/// The key as the profile declares it, else as it is by default; null: neither says.
nlohmann::json declared_value(const Profile& profile, const std::string& key,
                              const harness::Protocol& protocol);
/// Do these two values of the key mean the same?
bool means_the_same(const Profile& profile, const std::string& key, const nlohmann::json& one,
                    const nlohmann::json& other, const harness::Protocol& protocol);

/// What `source` needs otherwise than the profile and `station` have it, and `endpoint` can give:
/// keys of given.config, and "model" where the profile leaves it to the case. Empty: nothing.
nlohmann::json needed_set_up(const vectors::Case& source, const Profile& profile, int station,
                             const endpoints::Endpoint& endpoint,
                             const harness::Protocol& protocol);

/// All that a device of this profile is to have, for Endpoint::begin.
nlohmann::json whole_config(const Profile& profile, int station, const harness::Protocol& protocol);

}  // namespace fieldproof::bench
