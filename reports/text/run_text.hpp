// A run and its verdicts in words: the same on the console, in JUnit and in HTML.
#pragma once

#include <string>

#include "reports/results/ndjson.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::text {

/// "within limits, inside the guard band"
std::string verdict_meaning(results::Verdict verdict);

/// Which option turns a verdict red that this gate lets pass: "; red with --strict". Empty for the
/// others.
std::string gate_hint(results::Verdict verdict, const results::Gate& gate);

/// "LS ELECTRIC XBL-C41A, serial number 2219-00417, firmware V1.41, at serial:/dev/ttyUSB0
/// 38400-8N1, station 3".
std::string device_text(const results::DutInfo& dut);

/// "gate met: 1,824 of 2,948 judged", or why it was not; a line.
std::string headline(const results::RunEnd& end, const Tally& tally);

/// Why a run did not end as it should: killed, interrupted, trouble. Empty for one that did.
std::string early_end(const results::RunLog& log);

}  // namespace fieldproof::text
