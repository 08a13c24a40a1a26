// What people write, and what other programs may have left damaged: notation, vectors, profiles,
// bench files, waivers, definitions of user frames, journals, results.
#pragma once

#include "src/base/bytes.hpp"

namespace fieldproof::fuzz {

/// Notation that can be read is printed so that it reads the same again.
void feed_notation(ByteView input);
void feed_vectors(ByteView input);
void feed_profile(ByteView input);
void feed_bench(ByteView input);
void feed_waivers(ByteView input);
void feed_definition(ByteView input);
void feed_journal(ByteView input);
void feed_results(ByteView input);

std::vector<Bytes> good_notation();
std::vector<Bytes> good_vectors();
std::vector<Bytes> good_profiles();
std::vector<Bytes> good_benches();
std::vector<Bytes> good_waivers();
std::vector<Bytes> good_definitions();
std::vector<Bytes> good_journals();
std::vector<Bytes> good_results();

}  // namespace fieldproof::fuzz
