// Facts of the remote service in table vectors (FEnet EN 2.4, chapter 9).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "src/base/result.hpp"

namespace fieldproof::xgt_fenet_suite {

bool is_remote_fact(const nlohmann::json& facts);

/// {"service": "remote server", "transport": "tcp", "port": 2002, "channels": 1}, or
/// {"remote": [...], "accepted": false, "says": "ip"}: is it so in src/xgt_fenet/remote.hpp?
Status check_remote_fact(const nlohmann::json& facts);

}  // namespace fieldproof::xgt_fenet_suite
