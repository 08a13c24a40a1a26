// Which device is it? No command of these protocols reads model or serial number, but the areas and
// their ends tell models apart. Only reads are sent.
#pragma once

#include <map>
#include <string>

#include "harness/exchange/memory_access.hpp"

namespace fieldproof::bench {

/// {"areas": "PMKFTCLNDUR", "P": "0-1023", ...}: the areas that answer, and the first and last word
/// of each.
using Fingerprint = std::map<std::string, std::string>;

/// Asks for the ends that the known models declare and for the word past each; where a device ends
/// elsewhere, the end is searched by halves. Errors: the protocol has no areas, the port failed, or
/// a read gets no answer that can be read.
Result<Fingerprint> read_fingerprint(endpoints::Endpoint& endpoint,
                                     const harness::Protocol& protocol, int station,
                                     Duration patience);

/// What a bench file declares must be what can be found; the error names the key that is not.
Status check_fingerprint(const Fingerprint& declared, const harness::Protocol& protocol);

/// "area R: 0-10239 declared, none found", ...; empty where all that is declared was found.
std::string fingerprint_difference(const Fingerprint& declared, const Fingerprint& found);

/// As a bench file takes it: {"areas": "PM", ...}.
std::string to_string(const Fingerprint& fingerprint);

}  // namespace fieldproof::bench
