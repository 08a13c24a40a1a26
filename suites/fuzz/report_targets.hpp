// What is made of results that somebody else has written, and results of others.
#pragma once

#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::fuzz {

/// Every report of results.ndjson: JSON and JUnit can be read again.
void feed_reports(ByteView input);
/// The capture of results.ndjson: blocks of pcapng, whole ones, to the end.
void feed_pcapng(ByteView input);
std::vector<Bytes> good_reports();

/// NDJSON, JSON or JUnit of anybody.
void feed_others(ByteView input);
std::vector<Bytes> good_others();

}  // namespace fieldproof::fuzz
