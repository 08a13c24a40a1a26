#include "reports/capture.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <map>

#include "reports/captured_network.hpp"
#include "reports/pcapng.hpp"
#include "reports/text/case_text.hpp"
#include "reports/text/report_file.hpp"
#include "reports/text/spill.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::reports {

using results::CaseResult;
using results::Delivery;
using results::Event;
using results::Identity;
using results::RunInfo;
using results::RunLog;
using results::Sink;
using text::ReportFile;
using text::Spill;
using text::xml_line;

namespace {

/// Another piece of the same frame? What belongs to no step is a probe, which is sent in one piece,
/// or its answer.
bool continues(const Event& event, const Event& before) {
  return event.kind == before.kind && event.step == before.step &&
         event.surplus == before.surplus && event.extract.empty() && before.extract.empty() &&
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
  if (!event.extract.empty())
    part += fmt::format(", {} bytes in all, sha256 {}", event.extract.count, event.extract.sha256);
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

class CaptureReport final : public Sink {
 public:
  explicit CaptureReport(const std::string& path) : path_(path), packets_(path) {}

  Status begin(const RunInfo& run) override {
    const Identity& device = run.identity;
    const std::string hardware = xml_line(
        fmt::format("{} {} {} {}", device.maker, device.model, device.serial, device.firmware));
    endpoint_ = xml_line(run.endpoint);
    calendar_.begin_run(run.started);
    return packets_.append(
        pcapng_section("fieldproof " + xml_line(run.tool_version),
                       hardware.find_first_not_of(' ') == std::string::npos ? "" : hardware));
  }

  Status add(const Delivery& one) override {
    const CaseResult& result = *one;
    const std::vector<CapturedFrame> frames = captured_frames(result);
    const std::vector<CapturedPacket> packets = network_.packets(
        result.exchange, [&](const Event& event) { return comment_of(result, event); });
    if (frames.empty() && packets.empty()) return ok();
    const Time first = std::min(frames.empty() ? Time::max() : frames.front().start,
                                packets.empty() ? Time::max() : packets.front().time);
    calendar_.begin_case(first);
    std::string blocks;
    auto frame = frames.begin();
    for (const CapturedPacket& packet : packets) {
      for (; frame != frames.end() && frame->end <= packet.time; ++frame)
        blocks += block_of(result, *frame);
      blocks += block_of(result, packet);
    }
    for (; frame != frames.end(); ++frame) blocks += block_of(result, *frame);
    return packets_.append(blocks);
  }

  Status end(const RunLog&) override {
    Result<ReportFile> file = ReportFile::create(path_);
    if (!file) return file.error();
    if (Status copied = packets_.copy_to(file->out()); !copied) return copied;
    return file->commit();
  }

 private:
  std::string block_of(const CaseResult& result, const CapturedFrame& frame) {
    std::string blocks;
    const std::uint32_t interface = interface_of(result.protocol, linktype_rtac_serial, blocks);
    return blocks + pcapng_serial_packet({interface, calendar_.pass(frame.end), frame.sent,
                                          frame.bytes, frame.comment, frame.left_out});
  }
  std::string block_of(const CaseResult& result, const CapturedPacket& packet) {
    std::string blocks;
    const std::uint32_t interface = interface_of(result.protocol, linktype_ipv4, blocks);
    return blocks + pcapng_packet({interface, calendar_.pass(packet.time), packet.sent,
                                   packet.bytes, packet.comment});
  }

  /// A new one is described in `blocks`.
  std::uint32_t interface_of(const std::string& protocol, std::uint16_t linktype,
                             std::string& blocks) {
    const auto [found, added] = interfaces_.emplace(std::pair(protocol, linktype),
                                                    static_cast<std::uint32_t>(interfaces_.size()));
    if (added) blocks += pcapng_interface(linktype, xml_line(protocol), endpoint_);
    return found->second;
  }

  std::string path_, endpoint_;
  Spill packets_;
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
                        event.extract.empty() ? 0 : event.extract.count - event.bytes.size(),
                        comment_of(result, event)});
    before = &event;
  }
  return frames;
}

std::unique_ptr<Sink> capture_report(const std::string& path) {
  return std::make_unique<CaptureReport>(path);
}

}  // namespace fieldproof::reports
