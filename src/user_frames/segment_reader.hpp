// One segment of a definition, from its JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "src/base/result.hpp"
#include "src/user_frames/frame.hpp"

namespace fieldproof::user_frames {

/// Groups and frames keep the order of the file: the first frame that matches is received.
using Json = nlohmann::ordered_json;

/// Where a segment stands.
struct Place {
  const plc::PlcModel& plc;
  bool sent = false;
  Area area = Area::body;
  std::size_t index = 0;
  std::string text;  // "px7.json: group DRS, frame test, body[2]"
};

Error wrong(const std::string& place, const std::string& what);
/// Is it an object of these keys?
Status check_keys(const Json& object, const std::string& place,
                  std::initializer_list<std::string_view> keys);
/// The text of a key; `fallback` where it is absent.
Result<std::string> text_of(const Json& object, const std::string& place, const char* key,
                            const std::string& fallback = {});

/// The segments that a check covers are settled by `settle_check`.
Result<Segment> read_segment(const Json& value, const Place& place);

/// What the check of a frame covers. `segments` are all of the frame, `position` is that of the
/// check, `value` its JSON.
Status settle_check(std::vector<Segment>& segments, std::size_t position, const Json& value,
                    const std::string& place);

}  // namespace fieldproof::user_frames
