#include "src/user_frames/definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"
#include "src/base/spelling.hpp"
#include "src/user_frames/segment_reader.hpp"

namespace fieldproof::user_frames {

namespace {

/// The library keeps one of two equal keys in silence, and a frame would be lost.
Result<Json> parse_json(const std::string& text, const std::string& file) {
  std::vector<std::set<std::string>> open;
  std::string twice;
  const auto watch = [&](int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) open.emplace_back();
    if (event == Json::parse_event_t::object_end) open.pop_back();
    if (event == Json::parse_event_t::key && !open.back().insert(parsed.get<std::string>()).second)
      twice = parsed.get<std::string>();
    return true;
  };
  try {
    Json json = Json::parse(not_too_deep(text), watch);
    if (!twice.empty())
      return wrong(
          file, fmt::format("'{}' stands twice in one object; give each a name of its own", twice));
    return json;
  } catch (const Json::parse_error& error) {
    return wrong(file, fmt::format("it is no JSON: {}", json_trouble(error)));
  }
}

/// One group while it is read.
struct Group {
  std::string name, place;
  bool sent = false;
  Json head = Json::array(), tail = Json::array();
};

Status read_area(const Json& list, const plc::PlcModel& plc, const Group& group,
                 const std::string& place, Area area, std::vector<Segment>& to) {
  if (!list.is_array())
    return wrong(place, fmt::format("{} is not an array of segments", to_string(area)));
  for (std::size_t i = 0; i < list.size(); ++i) {
    Result<Segment> segment = read_segment(
        list[i], {plc, group.sent, area, i, fmt::format("{}, {}[{}]", place, to_string(area), i)});
    if (!segment) return segment.error();
    to.push_back(std::move(*segment));
  }
  return ok();
}

/// The limits of Cnet KO 6.5.1.
Status check_limits(const UserFrame& frame, const std::string& place) {
  using Kind = Segment::Kind;
  const auto count = [&](auto predicate) {
    return static_cast<std::size_t>(std::ranges::count_if(frame.segments, predicate));
  };
  std::size_t size = 0;
  for (const Segment& segment : frame.segments) size += segment.size;
  if (size > max_frame)
    return wrong(place, fmt::format("the frame has {} bytes; it may have {}", size, max_frame));
  const std::size_t variables =
      count([](const Segment& s) { return s.kind == Kind::data || s.kind == Kind::rest; });
  if (variables > max_variables)
    return wrong(
        place, fmt::format("the body has {} variables; it may have {}", variables, max_variables));
  if (count([](const Segment& s) { return s.kind == Kind::check; }) > 1)
    return wrong(place, "the tail has two checks; it may have one");
  const auto rest = std::ranges::find(frame.segments, Kind::rest, &Segment::kind);
  if (rest == frame.segments.end()) return ok();
  if (rest + 1 != frame.segments.end() && (rest + 1)->area == Area::body)
    return wrong(
        place,
        fmt::format(
            "a segment follows body[{}], which is as long as what comes; it must be the last",
            rest->index));
  if (frame.segments.front().area == Area::body && frame.segments.back().area == Area::body)
    return wrong(place, "a variable without size needs a head or a tail; add one");
  return ok();
}

Result<UserFrame> read_frame(const std::string& name, const Json& value, const plc::PlcModel& plc,
                             const Group& group) {
  const std::string place = fmt::format("{}, frame {}", group.place, name);
  if (const Status keys = check_keys(value, place, {"answer", "body", "note"}); !keys)
    return keys.error();
  UserFrame frame{group.name + "." + name, group.sent, {}, {}};
  const Json body = value.value("body", Json::array());
  if (body.empty()) return wrong(place, "there is no body; a frame has at least one segment there");
  for (const auto& [area, list] :
       {std::pair{Area::head, &group.head}, {Area::body, &body}, {Area::tail, &group.tail}})
    if (const Status read = read_area(*list, plc, group, place, area, frame.segments); !read)
      return read.error();
  if (const Status within = check_limits(frame, place); !within) return within.error();
  const auto check = std::ranges::find(frame.segments, Segment::Kind::check, &Segment::kind);
  if (check != frame.segments.end()) {
    const std::size_t index = check->index;
    const auto position = static_cast<std::size_t>(check - frame.segments.begin());
    const Status settled = settle_check(frame.segments, position, group.tail[index],
                                        fmt::format("{}, tail[{}]", place, index));
    if (!settled) return settled.error();
  }
  const Result<std::string> answer = text_of(value, place, "answer");
  if (!answer) return answer.error();
  if (!answer->empty() && group.sent)
    return wrong(place, "a sent frame has no answer; give it to the frame that is received");
  frame.answer = *answer;
  return frame;
}

Status check_name(const std::string& name, const std::string& place) {
  if (!name.empty() && name.find_first_of(". ") == std::string::npos) return ok();
  return wrong(
      place,
      fmt::format("the name '{}' is empty or holds a dot or a space, which GROUP.FRAME cannot",
                  name));
}

Status read_group(const std::string& name, const Json& value, const std::string& file,
                  FrameDefinition& to) {
  Group group{name, fmt::format("{}: group {}", file, name)};
  if (Status named = check_name(name, file); !named) return named;
  if (Status keys = check_keys(value, group.place, {"frames", "head", "note", "tail", "type"});
      !keys)
    return keys;
  const Result<std::string> type = text_of(value, group.place, "type");
  if (!type) return type.error();
  if (*type != "send" && *type != "receive")
    return wrong(group.place, fmt::format("type is '{}'; use send or receive", *type));
  group.sent = *type == "send";
  group.head = value.value("head", group.head);
  group.tail = value.value("tail", group.tail);
  const Json frames = value.value("frames", Json::object());
  if (!frames.is_object() || frames.empty())
    return wrong(group.place, "there are no frames; give at least one, by name");
  for (const auto& [frame_name, frame_value] : frames.items()) {
    if (Status named = check_name(frame_name, group.place); !named) return named;
    Result<UserFrame> frame = read_frame(frame_name, frame_value, *to.plc, group);
    if (!frame) return frame.error();
    to.frames.push_back(std::move(*frame));
  }
  return ok();
}

/// `key` names a frame; `sent` is what it must be.
Status check_reference(const FrameDefinition& definition, const std::string& place,
                       const std::string& key, const std::string& name, bool sent) {
  const UserFrame* frame = definition.find(name);
  if (frame && frame->sent == sent) return ok();
  if (frame)
    return wrong(place, fmt::format("{} names {}, which is {}; name a frame of a {} group", key,
                                    name, sent ? "received" : "sent", sent ? "send" : "receive"));
  std::vector<std::string_view> names;
  for (const UserFrame& one : definition.frames) names.push_back(one.name);
  return wrong(place, fmt::format("{} names '{}'; there is no such frame{}", key, name,
                                  suggestion(name, names)));
}

Status read_probe(const Json& value, const std::string& file, FrameDefinition& to) {
  const std::string place = file + ": probe";
  if (Status keys = check_keys(value, place, {"reply", "send"}); !keys) return keys;
  const Result<std::string> send = text_of(value, place, "send"),
                            reply = text_of(value, place, "reply");
  if (!send) return send.error();
  if (!reply) return reply.error();
  if (Status found = check_reference(to, place, "send", *send, false); !found) return found;
  if (Status found = check_reference(to, place, "reply", *reply, true); !found) return found;
  using Kind = Segment::Kind;
  const auto open = [](const Segment& s) { return s.kind == Kind::data || s.kind == Kind::rest; };
  if (std::ranges::any_of(to.find(*send)->segments, open))
    return wrong(
        place, fmt::format("send names {}, which has variables; its bytes cannot be told", *send));
  to.probe = *send;
  to.probe_reply = *reply;
  return ok();
}

}  // namespace

Result<FrameDefinition> parse_frame_definition(const std::string& text, const std::string& file) {
  const Result<Json> json = parse_json(text, file);
  if (!json) return json.error();
  if (const Status keys = check_keys(*json, file, {"groups", "note", "plc", "probe", "title"});
      !keys)
    return keys.error();
  FrameDefinition definition;
  const Result<std::string> title = text_of(*json, file, "title"),
                            plc = text_of(*json, file, "plc", "xbc-h");
  if (!title) return title.error();
  if (!plc) return plc.error();
  if (title->empty())
    return wrong(file, "there is no title; say in one line whose frames these are");
  definition.title = *title;
  definition.plc = plc::find_plc_model(*plc);
  if (!definition.plc)
    return wrong(file, fmt::format("plc is '{}'; use one of {}", *plc, plc::plc_model_names()));
  const Json groups = json->value("groups", Json::object());
  if (!groups.is_object() || groups.empty())
    return wrong(file, "there are no groups; give at least one, by name");
  for (const auto& [name, value] : groups.items())
    if (const Status read = read_group(name, value, file, definition); !read) return read.error();
  for (const UserFrame& frame : definition.frames) {
    if (frame.answer.empty()) continue;
    if (const Status found =
            check_reference(definition, fmt::format("{}: frame {}", file, frame.name), "answer",
                            frame.answer, true);
        !found)
      return found.error();
  }
  if (const auto probe = json->find("probe"); probe != json->end())
    if (const Status read = read_probe(*probe, file, definition); !read) return read.error();
  return definition;
}

}  // namespace fieldproof::user_frames
