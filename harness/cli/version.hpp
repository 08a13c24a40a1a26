// What `fieldproof --version` says.
#pragma once

#include <string>

#include "harness/protocols.hpp"

namespace fieldproof::cli {

/// Version and date of the release, hash of the vectors (as results name it), compiler and
/// libraries.
std::string version_text(const harness::Protocols& protocols);

}  // namespace fieldproof::cli
