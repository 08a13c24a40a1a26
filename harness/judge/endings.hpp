// How a device ended a link, in words.
#pragma once

#include <string>

#include "harness/exchange/transcript.hpp"

namespace fieldproof::judging {

/// "the device closed the connection a (FIN) after 12 bytes"; "the connection was refused".
std::string in_words(const exchange::Ending& ending);
/// The same with the time since `cause`: ", 3.0 ms after the request".
std::string in_words(const exchange::Ending& ending, Time cause, const std::string& what);

}  // namespace fieldproof::judging
