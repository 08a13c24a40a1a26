#include "reports/capture.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <map>

#include "reports/captured_network.hpp"
#include "reports/pcapng.hpp"
#include "reports/results/ndjson.hpp"
#include "reports/text/case_text.hpp"
#include "reports/text/report_file.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::reports {

using results::CaseResult;
using results::Event;

namespace {

/// Another piece of the same frame? What belongs to no step is a probe, which is sent in one piece,
/// or its answer.
bool continues(const Event& event, const Event& before) {
  return event.kind == before.kind && event.step == before.step &&
         event.surplus == before.surplus &&
         (event.step >= 0 || event.kind == Event::Kind::received);
}

std::string comment_of(const CaseResult& result, const Event& event) {
  std::string part;
  if (event.kind != Event::Kind::sent && event.kind != Event::Kind::received)
    part = "";  // what happened on a link
  else if (event.surplus)
    part = ", surplus";
  else if (event.step >= 0)
    part = fmt::format(", step {}", event.step + 1);
  else if (!result.recording.stimulus.empty())
    part = ", probe";  // without a recording the steps are not known
  return text::xml_line(text::case_label(result).substr(0, 1000)) + part + ": " +
         std::string(results::to_string(result.verdict));
}

void join(CapturedFrame& frame, const Event& event) {
  const double pause = to_ms(event.start) - to_ms(frame.end);
  if (pause > 0 && frame.comment.size() < 1500)
    frame.comment += fmt::format("; pause of {:.3f} ms after {} bytes", pause, frame.bytes.size());
  frame.end = event.end;
  frame.bytes.insert(frame.bytes.end(), event.bytes.begin(), event.bytes.end());
}

/// ISO 8601 with zone, as a run begins, in ns since 1970; 0 for what is not.
std::uint64_t since_epoch(const std::string& text) {
  using namespace std::chrono;
  int y = 0, mo = 0, d = 0, h = 0, mi = 0, s = 0, zone_h = 0, zone_m = 0;
  char sign = '+';
  if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d%c%2d:%2d", &y, &mo, &d, &h, &mi, &s, &sign,
                  &zone_h, &zone_m) < 6)
    return 0;
  const year_month_day date{year(y), month(static_cast<unsigned>(mo)),
                            day(static_cast<unsigned>(d))};
  if (!date.ok() || y < 1970 || y > 2200) return 0;
  const minutes zone = hours(zone_h) + minutes(zone_m);
  const seconds time = sys_days(date).time_since_epoch() + hours(h) + minutes(mi) + seconds(s) -
                       (sign == '-' ? -zone : zone);
  return static_cast<std::uint64_t>(nanoseconds(time).count());
}

/// Clocks that begin anew, or stand behind another one, go on where the last case ended. Unsigned:
/// a damaged file may hold any time.
class Calendar {
 public:
  void begin_run(const std::string& started) { offset_ = since_epoch(started); }

  void begin_case(Time first) {
    if (const std::uint64_t begun = at(first); begun < last_) offset_ += last_ - begun;
  }
  std::uint64_t pass(Time time) { return last_ = std::max(last_, at(time)), at(time); }

 private:
  std::uint64_t at(Time time) const { return offset_ + static_cast<std::uint64_t>(time.count()); }

  std::uint64_t offset_ = 0, last_ = 0;
};

/// Writes packets as results are read.
class Capture {
 public:
  explicit Capture(std::ostream& out) : out_(out) {}

  void begin(const results::RunInfo& run) {
    const results::Identity& device = run.identity;
    const std::string hardware = text::xml_line(
        fmt::format("{} {} {} {}", device.maker, device.model, device.serial, device.firmware));
    out_ << pcapng_section("fieldproof " + text::xml_line(run.tool_version),
                           hardware.find_first_not_of(' ') == std::string::npos ? "" : hardware);
    endpoint_ = text::xml_line(run.endpoint);
    calendar_.begin_run(run.started);
  }

  void add(const CaseResult& result) {
    const std::vector<CapturedFrame> frames = captured_frames(result);
    const std::vector<CapturedPacket> packets = network_.packets(
        result.exchange, [&](const Event& event) { return comment_of(result, event); });
    if (frames.empty() && packets.empty()) return;
    const Time first = std::min(frames.empty() ? Time::max() : frames.front().start,
                                packets.empty() ? Time::max() : packets.front().time);
    calendar_.begin_case(first);
    auto frame = frames.begin();
    for (const CapturedPacket& packet : packets) {
      for (; frame != frames.end() && frame->end <= packet.time; ++frame) add(result, *frame);
      add(result, packet);
    }
    for (; frame != frames.end(); ++frame) add(result, *frame);
  }

 private:
  void add(const CaseResult& result, const CapturedFrame& frame) {
    const std::uint32_t interface = interface_of(result.protocol, linktype_rtac_serial);
    out_ << pcapng_serial_packet(
        {interface, calendar_.pass(frame.end), frame.sent, frame.bytes, frame.comment});
  }
  void add(const CaseResult& result, const CapturedPacket& packet) {
    const std::uint32_t interface = interface_of(result.protocol, linktype_ipv4);
    out_ << pcapng_packet(
        {interface, calendar_.pass(packet.time), packet.sent, packet.bytes, packet.comment});
  }

  std::uint32_t interface_of(const std::string& protocol, std::uint16_t linktype) {
    const auto [found, added] = interfaces_.emplace(std::pair(protocol, linktype),
                                                    static_cast<std::uint32_t>(interfaces_.size()));
    if (added) out_ << pcapng_interface(linktype, text::xml_line(protocol), endpoint_);
    return found->second;
  }

  std::ostream& out_;
  std::string endpoint_;
  Calendar calendar_;
  CapturedNetwork network_;
  std::map<std::pair<std::string, std::uint16_t>, std::uint32_t> interfaces_;
};

}  // namespace

std::vector<CapturedFrame> captured_frames(const CaseResult& result) {
  std::vector<CapturedFrame> frames;
  const Event* before = nullptr;
  for (const Event& event : result.exchange) {
    if (event.bytes.empty() || CapturedNetwork::is_of_network(event)) continue;
    if (before && continues(event, *before))
      join(frames.back(), event);
    else
      frames.push_back({event.kind == Event::Kind::sent, event.start, event.end, event.bytes,
                        comment_of(result, event)});
    before = &event;
  }
  return frames;
}

Result<text::Tally> write_capture(const std::string& ndjson, const std::string& path) {
  // The head of the file comes before the first packet, and before the results are read.
  const Result<results::RunLog> head = results::read_ndjson(ndjson, [](const CaseResult&) {});
  if (!head) return head.error();
  Result<text::ReportFile> file = text::ReportFile::create(path);
  if (!file) return file.error();
  Capture capture(file->out());
  capture.begin(head->run);
  text::Tally tally;
  const Result<results::RunLog> log = results::read_ndjson(ndjson, [&](const CaseResult& result) {
    tally.add(result.verdict);
    capture.add(result);
  });
  if (!log) return log.error();
  if (const Status done = file->commit(); !done) return done.error();
  return tally;
}

}  // namespace fieldproof::reports
