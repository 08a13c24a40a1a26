// `run --matrix`: the line settings that a run repeats its cases with.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/endpoints/endpoint.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::run {

/// Reads "SPEEDS x FRAMES": "38400,115200 x 8N1,8E1" is four steps, speed by speed; "all" stands
/// for all of a list, and alone for both (8 speeds by 12 frames). Errors name the part that is
/// wrong.
Result<std::vector<line::LineSettings>> parse_line_matrix(std::string_view text);

/// "38400 x 8N1": the matrix of this step alone.
std::string matrix_text(const line::LineSettings& step);

/// The endpoint with the bench's own side of the line, and of an emulator the device's too, set so.
/// Kinds without line settings (tcp, udp, exec) stay as they are.
endpoints::EndpointName at_line(endpoints::EndpointName endpoint, const line::LineSettings& step);

/// Does the endpoint set the device itself, so that nobody need be asked?
bool sets_device(const endpoints::EndpointName& endpoint);

}  // namespace fieldproof::run
