// /dev/ttyUSB0 is whatever was plugged in first; /dev/serial/by-id names the adapter itself.
#pragma once

#include <string>

namespace fieldproof::os {

/// The link in `folder` that leads to the same port as `path`; empty where there is none, or `path`
/// is such a link.
std::string stable_name(const std::string& path, const std::string& folder = "/dev/serial/by-id");

}  // namespace fieldproof::os
