// Facts of table vectors about the flags and registers of the P2P service (000 and 003 Appendix 2).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "src/base/result.hpp"

namespace fieldproof::xgt_cnet {

/// {"model": "xbc-h", "keyword": "_P2P1_NDR00", "address": "%LX5120"}, and perhaps "words": that it takes.
Status check_keyword_fact(const nlohmann::json& facts);

}  // namespace fieldproof::xgt_cnet
