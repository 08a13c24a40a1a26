// What is wrong with a file of JSON, in words for the person who wrote it.
#pragma once

#include <exception>
#include <string>

namespace fieldproof {

/// "line 5, column 16: there is ',' where a key in quotes is due; is there a comma too many?" for
/// what the JSON library throws; what anything else says is as it was.
std::string json_trouble(const std::exception& error);

}  // namespace fieldproof
