// Which runs are of the same device, whatever firmware it had, and when they were.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "reports/results/case_result.hpp"

namespace fieldproof::history {

/// What a device is called, and known by: "LS ELECTRIC XBL-C41A, serial number 2219-00417". Without
/// a serial number the name in the bench file with maker and model; without an identity, as of a
/// run that names no bench file, "exec:./my_plc {tty}, profile xbc-h". Of a shared run all of its
/// devices, joined by " + ".
std::string device_of(const results::RunInfo& run);

/// Seconds since 1970 of "2026-11-21T12:39:03+01:00"; nothing for what is no such time.
std::optional<std::int64_t> seconds_of(const std::string& timestamp);

}  // namespace fieldproof::history
