// The capture of a run, opened by a program that is not ours: Wireshark's tshark.
#include <gmock/gmock.h>

#include <cstdlib>
#include <sstream>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;

struct Packet {
  double time = 0;
  std::string interface, flags, event_type, hex, comment;
  std::size_t length = 0, kept = 0;
};

std::vector<std::string> split(const std::string& line, char by) {
  std::vector<std::string> parts;
  std::istringstream in(line);
  for (std::string part; std::getline(in, part, by);) parts.push_back(part);
  return parts;
}

std::vector<std::vector<std::string>> fields(const std::string& capture,
                                             const std::vector<std::string>& names,
                                             std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"tshark", "-r", capture, "-T", "fields", "-E", "separator=/t"};
  for (const std::string& name : names) arguments.insert(arguments.end(), {"-e", name});
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Finished finished = run_program(arguments);
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_THAT(finished.err, testing::Not(HasSubstr("appears to")))
      << "tshark finds the file damaged";
  std::vector<std::vector<std::string>> rows;
  for (const std::string& line : split(finished.out, '\n')) {
    rows.push_back(split(line, '\t'));
    rows.back().resize(names.size());
  }
  return rows;
}

std::vector<Packet> packets(const std::string& capture) {
  std::vector<Packet> all;
  for (const auto& row :
       fields(capture,
              {"frame.time_epoch", "frame.interface_name", "frame.packet_flags_direction",
               "rtacser.eventtype", "data.data", "frame.comment", "frame.len", "frame.cap_len"}))
    all.push_back({std::stod(row[0]), row[1], row[2], row[3], row[4], row[5], std::stoul(row[6]),
                   std::stoul(row[7])});
  return all;
}

/// What went over the line in a case, read from the results: kind and step, with all bytes of it.
struct Traffic {
  std::string id, kind, hex;
  int step = -1;
  double end_ms = 0;
};

std::string bare(std::string hex) {
  std::erase(hex, ' ');
  std::ranges::transform(hex, hex.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return hex;
}

std::vector<Traffic> traffic(const Results& results) {
  std::vector<Traffic> all;
  for (const nlohmann::json& one : results.cases) {
    bool first = true;
    for (const nlohmann::json& event : one.value("exchange", nlohmann::json::array())) {
      if (event["kind"] == "note") continue;
      Traffic now{one["id"], event["kind"], bare(event["hex"]), event.value("step", -1),
                  event["end_ms"]};
      Traffic* before = first ? nullptr : &all.back();
      first = false;
      if (before && before->kind == now.kind && before->step == now.step && now.step >= 0) {
        before->hex += now.hex;
        before->end_ms = now.end_ms;
      } else {
        all.push_back(now);
      }
    }
  }
  return all;
}

void expect_same(const std::vector<Packet>& captured, const std::vector<Traffic>& expected) {
  ASSERT_EQ(captured.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Packet& packet = captured[i];
    const bool sent = expected[i].kind == "sent";
    ASSERT_EQ(packet.hex, expected[i].hex) << "packet " << i + 1 << ' ' << packet.comment;
    ASSERT_EQ(packet.length, packet.hex.size() / 2 + 12) << packet.comment;
    ASSERT_EQ(packet.event_type, sent ? "0x01" : "0x02") << packet.comment;
    ASSERT_EQ(packet.flags, sent ? "0x00000002" : "0x00000001") << packet.comment;
    ASSERT_THAT(packet.comment, HasSubstr(expected[i].id)) << "packet " << i + 1;
    // Doubles of a time since 1970 are good for a microsecond.
    ASSERT_NEAR(packet.time - captured[0].time, (expected[i].end_ms - expected[0].end_ms) / 1000,
                2e-6)
        << packet.comment;
  }
}

TEST(Capture, holds_every_frame_of_a_run) {
  const TestFolder folder;
  ASSERT_EQ(run_tool({"run", "--filter", "xgt_cnet/*", "--out", folder / "out", "--capture",
                      folder / "run.pcapng"})
                .code,
            0);
  const std::vector<Traffic> expected = traffic(read_results(folder / "out/results.ndjson"));
  ASSERT_GT(expected.size(), 5000u);
  const std::vector<Packet> captured = packets(folder / "run.pcapng");
  expect_same(captured, expected);
  EXPECT_EQ(captured.front().interface, "xgt-cnet");

  const Finished again =
      run_tool({"report", folder / "out/results.ndjson", "--capture", folder / "again.pcapng"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(read_text(folder / "again.pcapng"), read_text(folder / "run.pcapng"));
}

/// Behind a port a reply comes in pieces, and time is real.
TEST(Capture, joins_the_pieces_of_a_port) {
  const TestFolder folder;
  const Finished finished =
      run_tool({"run", "--endpoint", "pty:xbc-h", "--filter", "xgt_cnet/rsb/*", "--out",
                folder / "out", "--capture", folder / "run.pcapng"});
  ASSERT_EQ(finished.code, 0) << finished.out << finished.err;
  const Results results = read_results(folder / "out/results.ndjson");
  const std::vector<Packet> captured = packets(folder / "run.pcapng");
  for (const nlohmann::json& one : results.cases) {
    if (one["verdict"] != "PASS" || one.value("received", "").empty()) continue;
    const std::string comment = one["id"].get<std::string>() + ", step 2: PASS";
    const auto reply = std::ranges::find_if(
        captured, [&](const Packet& packet) { return packet.comment.starts_with(comment); });
    ASSERT_NE(reply, captured.end()) << comment;
    EXPECT_EQ(reply->hex, bare(one["received_bytes"])) << comment;
  }
}

TEST(Capture, modbus_rtu_is_decoded_with_its_crc) {
  const TestFolder folder;
  const Finished finished = run_tool(
      {"run", "--filter", "modbus_rtu/examples/*:modbus_rtu/data/*:modbus_rtu/line/crc_zero",
       "--out", folder / "out", "--capture", folder / "run.pcapng"});
  ASSERT_EQ(finished.code, 0) << finished.out;
  const std::vector<Traffic> expected = traffic(read_results(folder / "out/results.ndjson"));
  const auto rows = fields(folder / "run.pcapng",
                           {"frame.protocols", "mbrtu.crc16.status", "modbus.func_code",
                            "modbus.request_frame", "frame.comment"},
                           {"-d", "rtacser.data,mbrtu", "-o", "mbrtu.crc_verification:TRUE"});
  ASSERT_EQ(rows.size(), expected.size());
  std::size_t answers = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_THAT(rows[i][0], HasSubstr("mbrtu"));
    const bool wrong_on_purpose = rows[i][4].starts_with("modbus_rtu/line/crc_zero, step 1:");
    EXPECT_EQ(rows[i][1], wrong_on_purpose ? "0" : "1") << rows[i][4];
    EXPECT_EQ(std::stoi(rows[i][2]), std::stoi(expected[i].hex.substr(2, 2), nullptr, 16) & 0x7F)
        << rows[i][4];
    answers += !rows[i][3].empty();
  }
  EXPECT_GT(answers, 10u) << "replies are paired with their requests";
}

TEST(Capture, clocks_of_several_protocols_run_one_after_the_other) {
  const TestFolder folder;
  ASSERT_EQ(run_tool({"run", "--filter", "modbus_rtu/examples/*:xgt_cnet/rss/refused/*", "--out",
                      folder / "out", "--capture", folder / "run.pcapng", "--seed", "1"})
                .code,
            0);
  const std::vector<Packet> captured = packets(folder / "run.pcapng");
  EXPECT_TRUE(std::ranges::is_sorted(captured, {}, &Packet::time));
  std::set<std::string> interfaces;
  for (const Packet& packet : captured) interfaces.insert(packet.interface);
  EXPECT_EQ(interfaces, (std::set<std::string>{"modbus-rtu", "xgt-cnet"}));
}

nlohmann::ordered_json link_event(const char* kind, const char* link, double at,
                                  const std::string& hex = "") {
  nlohmann::ordered_json event{{"kind", kind}, {"start_ms", at}, {"end_ms", at}, {"text", ""},
                               {"link", link}, {"port", 502},    {"step", 0}};
  if (!hex.empty()) event["hex"] = hex;
  return event;
}

nlohmann::ordered_json by_device(nlohmann::ordered_json event) {
  event["by_device"] = true;
  return event;
}

/// Results with this exchange, as a capture.
std::string captured(const TestFolder& folder, const nlohmann::ordered_json& exchange) {
  const nlohmann::ordered_json run{{"tool_version", "0"}, {"started", "2026-11-21T12:00:00+00:00"}};
  const nlohmann::ordered_json one{{"id", "modbus_tcp/a"},
                                   {"verdict", "PASS"},
                                   {"protocol", "modbus-tcp"},
                                   {"exchange", exchange}};
  folder.write("results.ndjson", nlohmann::ordered_json{{"run", run}}.dump() + '\n' +
                                     nlohmann::ordered_json{{"case", one}}.dump() + '\n');
  const Finished finished =
      run_tool({"report", folder / "results.ndjson", "--capture", folder / "run.pcapng"});
  EXPECT_EQ(finished.code, 0) << finished.err;
  return folder / "run.pcapng";
}

/// Two clients of a Modbus TCP server, one of them resets: no option tells tshark what it is.
TEST(Capture, modbus_tcp_is_decoded_without_options) {
  const TestFolder folder;
  const std::string request = "00 01 00 00 00 06 01 03 00 63 00 01";
  const std::string reply = "00 01 00 00 00 05 01 03 02 12 34";
  const std::string capture = captured(
      folder, {link_event("opened", "a", 0), link_event("opened", "b", 1),
               link_event("sent", "a", 2, request), link_event("sent", "b", 3, request),
               link_event("received", "b", 4, reply), link_event("received", "a", 5, reply),
               link_event("closed", "a", 6), by_device(link_event("closed", "a", 7)),
               by_device(link_event("reset", "b", 8))});
  const auto rows = fields(
      capture, {"frame.protocols", "modbus.func_code", "modbus.request_frame", "tcp.analysis.flags",
                "tcp.stream", "frame.number", "mbtcp.trans_id", "tcp.flags.reset"});
  ASSERT_EQ(rows.size(), 6u + 4 + 4 + 1);
  std::map<std::string, std::string> request_of;  // frame, by stream
  int answers = 0, resets = 0;
  for (const auto& row : rows) {
    EXPECT_EQ(row[3], "") << "frame " << row[5] << ": sequence or acknowledge number is wrong";
    resets += row[7] == "1" || row[7] == "True";
    if (row[6].empty()) continue;
    EXPECT_THAT(row[0], HasSubstr("mbtcp:modbus"));
    EXPECT_EQ(row[1], "3");
    EXPECT_EQ(row[6], "1");
    if (row[2].empty()) {
      request_of[row[4]] = row[5];
    } else {
      EXPECT_EQ(row[2], request_of[row[4]]) << "each answer is paired with its own request";
      ++answers;
    }
  }
  EXPECT_EQ(answers, 2);
  EXPECT_EQ(resets, 1);
}

TEST(Capture, packets_of_a_network_have_right_checksums) {
  const TestFolder folder;
  nlohmann::ordered_json udp = link_event("sent", "u", 3, "00 01 00 00 00 06 01 03 00 63 00");
  udp["transport"] = "udp";
  const std::string capture =
      captured(folder, {link_event("opened", "a", 0), link_event("sent", "a", 1, "00 01 FF"),
                        by_device(link_event("closed", "a", 2)), udp});
  const auto rows = fields(
      capture,
      {"ip.checksum.status", "tcp.checksum.status", "udp.checksum.status", "_ws.expert.message"},
      {"-o", "ip.check_checksum:TRUE", "-o", "tcp.check_checksum:TRUE", "-o",
       "udp.check_checksum:TRUE"});
  ASSERT_EQ(rows.size(), 3u + 1 + 2 + 1);
  for (const auto& row : rows) {
    EXPECT_EQ(row[0], "1");
    EXPECT_EQ(row[1] + row[2], "1");
  }
}

/// Names, texts and sizes that a file format may stumble over.
TEST(Capture, hostile_results_stay_readable) {
  const TestFolder folder;
  nlohmann::ordered_json run{{"tool_version", "0\x01"},
                             {"started", "2026-11-21T12:00:00+09:00"},
                             {"endpoint", std::string(100'000, 'e')}};
  nlohmann::ordered_json exchange = nlohmann::ordered_json::array();
  exchange.push_back(
      {{"kind", "sent"}, {"start_ms", 0.5}, {"end_ms", 1.5}, {"hex", "00 FF"}, {"text", ""}});
  std::string megabyte;
  for (int i = 0; i < 1 << 20; ++i) megabyte += "55 ";
  megabyte.pop_back();
  exchange.push_back(
      {{"kind", "received"}, {"start_ms", 2}, {"end_ms", 3}, {"hex", megabyte}, {"text", ""}});
  nlohmann::ordered_json one{{"id", std::string(70'000, 'i') + "<script>"},
                             {"verdict", "FAIL"},
                             {"protocol", "\x1B[2J"},
                             {"exchange", exchange}};
  folder.write("results.ndjson", nlohmann::ordered_json{{"run", run}}.dump() + '\n' +
                                     nlohmann::ordered_json{{"case", one}}.dump() + '\n');
  const Finished finished =
      run_tool({"report", folder / "results.ndjson", "--capture", folder / "run.pcapng"});
  ASSERT_EQ(finished.code, 0) << finished.err;
  const std::vector<Packet> captured = packets(folder / "run.pcapng");
  ASSERT_EQ(captured.size(), 2u);
  EXPECT_NEAR(captured[0].time, 1795230000.0015, 1e-6) << "12:00 in Seoul is 03:00 UTC";
  EXPECT_EQ(captured[0].hex, "00ff");
  EXPECT_THAT(captured[0].comment, testing::EndsWith("i: FAIL"));
  EXPECT_EQ(captured[1].length, (1u << 20) + 12);
  EXPECT_EQ(captured[1].kept, 262'144u);
  EXPECT_EQ(captured[0].interface, "[1B][2J");
}

TEST(Capture, says_where_it_cannot_be_written) {
  const TestFolder folder;
  const Finished finished =
      run_tool({"run", "--vectors", write_vectors(folder, {small_vector("v/pass")}), "--out",
                folder / "out", "--capture", folder / "no/run.pcapng"});
  EXPECT_EQ(finished.code, 3);
  EXPECT_THAT(finished.err, HasSubstr("no/run.pcapng"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
