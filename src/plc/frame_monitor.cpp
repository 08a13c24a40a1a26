#include "src/plc/frame_monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "src/base/csv.hpp"

namespace fieldproof::plc {

namespace {

std::string shown(Byte b) {
  switch (b) {
    case 0x02: return "[STX]";
    case 0x03: return "[ETX]";
    case 0x04: return "[EOT]";
    case 0x05: return "[ENQ]";
    case 0x06: return "[ACK]";
    case 0x0A: return "[LF]";
    case 0x0D: return "[CR]";
    case 0x15: return "[NAK]";
    default: break;
  }
  const bool plain = b >= ' ' && b <= '~' && b != '[' && b != '<';
  return plain ? std::string(1, static_cast<char>(b)) : fmt::format("<{:02X}>", b);
}

}  // namespace

std::string hex_view(const MonitoredFrame& frame) { return to_hex(frame.data); }

std::string ascii_view(const MonitoredFrame& frame) {
  std::string text;
  for (const Byte b : frame.data) text += shown(b);
  return text;
}

std::string csv_header() { return "Form,Result,Size,Time,Frame data (HEX),Frame data (ASCII)\r\n"; }

std::string csv_row(const MonitoredFrame& frame, std::string_view time) {
  return fmt::format("{},{},{},{},{},{}\r\n", frame.sent ? "Transmission" : "Reception",
                     frame.result.text, frame.data.size(), time, hex_view(frame),
                     in_csv_quotes(ascii_view(frame)));
}

void FrameMonitor::receive(const Burst& burst) {
  heard_.insert(heard_.end(), burst.bytes.begin(), burst.bytes.end());
  silence_.heard(burst);
  take_frames(burst.character_time);
  line_->receive(burst);
}

void FrameMonitor::take_frames(Duration character_time) {
  while (const std::optional<std::size_t> length = rules_.frame_length(heard_)) {
    if (*length == 0 || *length > heard_.size()) return;
    const auto end = heard_.begin() + static_cast<std::ptrdiff_t>(*length);
    Bytes frame(heard_.begin(), end);
    heard_.erase(heard_.begin(), end);
    record(false, silence_.last_end() - character_time * static_cast<Duration::rep>(heard_.size()),
           std::move(frame));
  }
}

/// What was heard is over, whatever it is.
void FrameMonitor::close() {
  if (!heard_.empty()) record(false, silence_.last_end(), std::exchange(heard_, {}));
}

void FrameMonitor::record(bool sent, Time time, Bytes data) {
  const FrameResult result = rules_.classify(data, sent);
  last_ = result;
  if (record_) record_({sent, result, time, std::move(data)});
}

std::optional<Time> FrameMonitor::wake_at() const {
  const std::optional<Time> wake = line_->wake_at();
  if (heard_.empty()) return wake;
  const Time over = silence_.over_at();
  return wake ? std::min(*wake, over) : over;
}

Bytes FrameMonitor::advance(Time now) {
  if (now >= silence_.over_at()) close();
  Bytes bytes = line_->advance(now);
  if (bytes.empty()) return bytes;
  close();
  record(true, now, bytes);
  return bytes;
}

Status FrameMonitor::act(std::string_view action) {
  const Status done = device_->act(action);
  if (!done || action != "power_cycle") return done;
  close();
  last_.reset();
  return done;
}

Result<std::string> FrameMonitor::get(std::string_view address, std::size_t digits) const {
  if (address != "@monitor") return device_->get(address, digits);
  return hex_number(last_ ? last_->number : 0u, static_cast<int>(digits == 0 ? 2 : digits));
}

}  // namespace fieldproof::plc
