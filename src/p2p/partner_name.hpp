// Names of a partner's memory as the XGT clients send them: "%MW100" (Cnet EN 6.2.3, FEnet
// EN 7.5.1). The areas of the partner are not known here.
#pragma once

#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/p2p/block.hpp"

namespace fieldproof::p2p {

/// Are the partner's names of `block` names of its type, with at most `longest` characters? The
/// error names the key, save or read.
Status check_partner_names(const P2pBlock& block, std::size_t longest);

/// "%MW00100" as it is sent: "%MW100". Dotted names stay as they are.
std::string unpadded_name(std::string_view name);

}  // namespace fieldproof::p2p
