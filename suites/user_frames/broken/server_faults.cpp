// User-defined frames on a network, as server (FEnet EN 7.7.3, 7.7.4): what is wrong with variables
// is the same as on a line; the rest is of connections and datagrams.
#include "src/user_frames/network_server.hpp"
#include "suites/user_frames/broken/faults.hpp"
#include "suites/user_frames/definition_files.hpp"

namespace fieldproof::user_frames_broken {

using user_frames::Segment;
using user_frames::UserFrame;

namespace {

/// A fault of a port, met on a network.
Fault on_network(std::string_view name, std::string_view caught_by, std::string_view message) {
  Fault fault = *broken::find_by_name(faults(), name);
  fault.caught_by = caught_by;
  fault.message = message;
  fault.neighbours = {};
  return fault;
}

Behaviour edge(broken::Edge edge) {
  return {.works_with = {}, .set_to = {}, .says = {}, .deaf_to = {}, .edge = std::move(edge)};
}

Behaviour hears_link(std::function<bool(Burst& burst)> hears) {
  return edge({.hears_link = std::move(hears)});
}

Behaviour does(std::function<void(std::vector<Burst>& doings)> edit) {
  return edge({.does = std::move(edit)});
}

Behaviour deaf_to(const std::string& action) { return edge({.deaf_to = action}); }

/// The setting is another.
Behaviour is_set(const std::string& key, const nlohmann::json& value) {
  return {.works_with = {},
          .set_to = [=](nlohmann::json& config) { config[key] = value; },
          .says = {},
          .deaf_to = {}};
}

bool is_frame_of_px7(const Bytes& bytes) {
  return bytes.size() > 1 && bytes.front() == 0x02 && bytes.back() == '\n';
}

/// What lacks its end, or its beginning, is none.
Behaviour segments_alone() {
  return hears_link(
      [](Burst& burst) { return burst.event != LinkEvent::data || is_frame_of_px7(burst.bytes); });
}

/// What has come on all connections is one stream.
Behaviour one_stream() {
  return hears_link([rest = Bytes{}](Burst& burst) mutable {
    if (burst.event != LinkEvent::data) return true;
    rest.insert(rest.end(), burst.bytes.begin(), burst.bytes.end());
    if (rest.back() != '\n') return false;
    burst.bytes = std::exchange(rest, {});
    return true;
  });
}

/// A datagram that lacks its end waits for the next one.
Behaviour joins_datagrams() {
  return hears_link([rest = Bytes{}](Burst& burst) mutable {
    if (burst.event != LinkEvent::datagram || burst.bytes.empty()) return true;
    rest.insert(rest.end(), burst.bytes.begin(), burst.bytes.end());
    if (rest.back() != '\n') return false;
    burst.bytes = std::exchange(rest, {});
    return true;
  });
}

Behaviour no_service(LinkEvent of) {
  return hears_link([of](Burst& burst) { return burst.event != of; });
}

/// Another frame than the registered one ends the connection.
Behaviour throws_out() {
  return hears_link([](Burst& burst) {
    if (burst.event != LinkEvent::data || burst.bytes.size() < 3 || burst.bytes[2] == '1')
      return true;
    burst.event = LinkEvent::reset;
    burst.bytes.clear();
    return true;
  });
}

/// The station of a frame, its first constant behind STX, is not compared.
void any_station(UserFrame& frame) {
  bool first = true;
  for (Segment& segment : frame.segments) {
    if (segment.kind != Segment::Kind::constant || segment.area != user_frames::Area::body)
      continue;
    if (std::exchange(first, false)) accept_anything(segment);
  }
}

/// Answers go to the partner that connected last.
Behaviour answers_last_connected() {
  const auto last = std::make_shared<LinkId>(line_link);
  return edge({.hears_link =
                   [last](Burst& burst) {
                     if (burst.event == LinkEvent::opened) *last = burst.link;
                     return true;
                   },
               .does =
                   [last](std::vector<Burst>& doings) {
                     for (Burst& one : doings)
                       if (one.event == LinkEvent::data) one.link = *last;
                   }});
}

/// What is sent goes to the partner that connected first.
Behaviour sends_to_first() {
  const auto first = std::make_shared<LinkId>(line_link);
  return edge({.hears_link =
                   [first](Burst& burst) {
                     if (burst.event == LinkEvent::opened)
                       *first = *first == line_link ? burst.link : std::min(*first, burst.link);
                     return true;
                   },
               .does =
                   [first](std::vector<Burst>& doings) {
                     for (Burst& one : doings)
                       if (one.event == LinkEvent::data) one.link = *first;
                   }});
}

Behaviour never_closes() {
  return does([](std::vector<Burst>& doings) {
    std::erase_if(doings, [](const Burst& one) { return one.event == LinkEvent::reset; });
  });
}

/// An answer to a datagram goes out as bytes of a connection, which there is none.
Behaviour no_datagrams_out() {
  return does([](std::vector<Burst>& doings) {
    std::erase_if(doings, [](const Burst& one) { return one.event == LinkEvent::datagram; });
  });
}

/// Half a second of silence ends a frame: what follows belongs to none.
Behaviour ends_after_half_a_second() {
  return hears_link([last = Time{}](Burst& burst) mutable {
    if (burst.event != LinkEvent::data) return true;
    const bool late = burst.start - std::exchange(last, burst.start) > 400ms;
    return !late || burst.bytes.front() == 0x02;
  });
}

Behaviour counts(std::string_view counter, std::string_view always) {
  return edge({.shows = [=](std::string_view address, std::string right) {
    return address == counter ? std::string(always) : right;
  }});
}

/// Constants of what is sent are in lower case.
void letters_low(Segment& segment) {
  if (segment.kind != Segment::Kind::constant) return;
  for (Byte& byte : segment.bytes)
    if (byte >= 'A' && byte <= 'Z') byte = static_cast<Byte>(byte - 'A' + 'a');
}

void without(UserFrame& frame, user_frames::Area area) {
  for (std::size_t i = frame.segments.size(); i-- > 0;)
    if (frame.segments[i].area == area) remove_segment(frame, i);
}

/// The bytes of a numerical constant are taken for text.
void numbers_as_text(Segment& segment) {
  if (segment.kind != Segment::Kind::constant || segment.bytes.size() != 1) return;
  if (segment.bytes[0] < 0x20) segment.bytes = to_bytes(hex_number(segment.bytes[0], 2));
}

/// The fourth variable of a frame has no memory.
void lose_the_fourth(UserFrame& frame) {
  int count = 0;
  for (Segment& segment : frame.segments)
    if (segment.kind != Segment::Kind::constant && segment.kind != Segment::Kind::check &&
        ++count == 4)
      segment.memory.reset();
}

}  // namespace

const std::vector<Fault>& server_faults() {
  using user_frames::Area;
  static const std::vector<Fault> table = {
      on_network("swap_not_applied", "user_frames_net/server/swap_2", "body"),
      on_network("swap_always_2", "user_frames_net/server/swap_4", "body"),
      on_network("swap_of_8_is_4", "user_frames_net/server/swap_8", "body"),
      on_network("not_converted", "user_frames_net/server/a2h_tx", ""),
      on_network("converted_the_other_way", "user_frames_net/server/h2a_rx", "holds"),
      on_network("rest_cut", "user_frames_net/server/variable_rx", "holds"),
      on_network("fixed_cut", "user_frames_net/server/four_variables", "holds"),
      on_network("stored_one_further", "user_frames_net/server/h2a_rx", "holds"),
      on_network("second_variable_lost", "user_frames_net/server/four_variables", "holds"),
      on_network("never_stores", "user_frames_net/server/udp_rest", "holds"),
      {"fourth_variable_lost", "of four variables the last is not stored",
       each_received(lose_the_fourth), "user_frames_net/server/four_variables", "holds"},
      {"constants_in_lower_case", "string constants are sent in lower case",
       each_sent([](UserFrame& frame) { std::ranges::for_each(frame.segments, letters_low); }),
       "user_frames_net/server/answer_tcp", "expected"},
      {"numbers_as_text", "numerical constants are sent as their hex digits",
       each_sent([](UserFrame& frame) { std::ranges::for_each(frame.segments, numbers_as_text); }),
       "user_frames_net/server/answer_tcp", "expected"},
      {"without_head", "what is sent has no head",
       each_sent([](UserFrame& frame) { without(frame, Area::head); }),
       "user_frames_net/server/answer_udp", "expected"},
      {"without_tail", "what is sent has no tail",
       each_sent([](UserFrame& frame) { without(frame, Area::tail); }),
       "user_frames_net/server/answer_udp", "expected"},
      {"any_station", "a frame with another constant is received", each_received(any_station),
       "user_frames_net/server/other_frame_tcp", "where silence is due"},
      {"no_tcp", "connections are not heard", no_service(LinkEvent::data),
       "user_frames_net/server/answer_tcp", "no answer within"},
      {"no_udp", "datagrams are not heard", no_service(LinkEvent::datagram),
       "user_frames_net/server/answer_udp", "no answer within"},
      {"no_datagrams_out", "a datagram is received, and not answered", no_datagrams_out(),
       "user_frames_net/server/send_udp", "no answer within"},
      {"always_port_1024", "it listens at port 1024 whatever the setting is", is_set("port", 1024),
       "user_frames_net/server/other_own_port", ""},
      {"port_one_further",
       "it listens one port further",
       {.works_with = {},
        .set_to = [](nlohmann::json& config) { config["port"] = config.value("port", 1024) ^ 1; },
        .says = {},
        .deaf_to = {}},
       "user_frames_net/server/other_port",
       ""},
      {"segment_is_frame", "a frame in two segments is none", segments_alone(),
       "user_frames_net/server/pieces", "no answer within"},
      {"one_stream", "all connections are one stream", one_stream(),
       "user_frames_net/server/halves_of_two", "where silence is due"},
      {"joins_datagrams", "halves of a frame in two datagrams are one", joins_datagrams(),
       "user_frames_net/server/udp_halves", "where silence is due"},
      {"throws_out", "another frame ends the connection", throws_out(),
       "user_frames_net/server/other_frame_tcp", ""},
      {"answers_last_connected", "answers go to the partner that connected last",
       answers_last_connected(), "user_frames_net/server/two_partners", ""},
      {"sends_to_first", "what is sent goes to the partner that connected first", sends_to_first(),
       "user_frames_net/server/send_to_last", ""},
      {"fin_not_answered", "a FIN of the partner is not answered", never_closes(),
       "user_frames_net/server/fin_ends", ""},
      {"half_a_second_ends", "half a second of silence ends a frame, not a whole one",
       ends_after_half_a_second(), "user_frames_net/server/tcp_rest", "holds"},
      {"deaf_to_stop", "STOP changes nothing", deaf_to("stop"), "user_frames_net/server/stop",
       "where silence is due"},
      {"runs_at_power_on", "it runs at power-on whatever its switch says", is_set("mode", "run"),
       "user_frames_net/server/stop_at_first", "where silence is due"},
      {"deaf_to_power_cycle", "connections outlive the power", deaf_to("power_cycle"),
       "user_frames_net/server/power_cycle", ""},
      {"services_not_counted", "no service is counted", counts("@services", "0000"),
       "user_frames_net/server/counters", "@services holds 0000"},
      {"errors_not_counted", "no error is counted", counts("@errors", "0000"),
       "user_frames_net/server/counters", "@errors holds 0000"},
      {"status_not_shown", "the status stays normal", counts("@status", "00"),
       "user_frames_net/server/counters", "@status holds 00"},
  };
  return table;
}

Result<std::unique_ptr<plc::EmulatedDevice>> make_broken_server(const Behaviour& behaviour,
                                                                std::string_view model,
                                                                nlohmann::json config) {
  const Result<user_frames::FrameDefinition> definition =
      broken_definition(behaviour, model, config);
  if (!definition) return definition.error();
  auto right = user_frames::make_user_frame_server(*definition, config);
  if (!right) return right.error();
  return std::unique_ptr<plc::EmulatedDevice>(
      std::make_unique<broken::EdgeDevice>(std::move(*right), behaviour.edge));
}

}  // namespace fieldproof::user_frames_broken
