// What a model did while a case ran, as tables for other programs.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "reports/results/sink.hpp"

namespace fieldproof::reports {

/// Writes into `folder`, which is made, as results come (RFC 4180, a row of names first):
///   xnet.motion.one.csv        time_ms,axis,position,speed,event   samples, and rows of an event
///   xnet.motion.one.token.csv  net,station,from_ms,to_ms,busy_ms   turns with the token
/// for each case that has a trace; the name is its label (case_text.hpp), '/' as '.', what else is
/// no letter, digit, '-' or '_' as '_'. Times count from the beginning of the exchange.
std::unique_ptr<results::Sink> csv_report(const std::string& folder);

/// In quotes where that is needed.
std::string csv_field(std::string_view text);

}  // namespace fieldproof::reports
