// The traffic of a run for Wireshark: pcapng, one packet a frame.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "reports/results/sink.hpp"

namespace fieldproof::reports {

/// Writes `path`: the frames of all cases in both directions, with step, case and verdict as
/// comment. Lines are RTAC serial (linktype 250), links of a network IPv4 with TCP or UDP (linktype
/// 228, see CapturedNetwork); one interface a protocol and linktype. `path` appears at the end,
/// whole or not at all.
///   tshark -r FILE -d rtacser.data,mbrtu -o mbrtu.crc_verification:TRUE   decodes Modbus RTU
///   the display filter frame.comment contains "FAIL"   shows the cases that failed
///
/// Of an extract the bytes that are kept stand in it: on a line the first, with the length of all;
/// of a connection both ends, with a gap of the sequence between them. The comment says how many
/// there were.
///
/// Times are those of the bench, counted from the start of the run as the clock of the computer
/// gave it (in seconds). Simulated clocks of several protocols run one after the other, as their
/// cases did.
std::unique_ptr<results::Sink> capture_report(const std::string& path);

/// What one step sent, or took, as a whole: the pieces in which a port delivers a frame are joined.
struct CapturedFrame {
  bool sent = false;
  Time start{};
  Time end{};
  Bytes bytes;
  std::size_t left_out = 0;  // that came and were not kept, behind them
  std::string comment;  // "xgt_cnet/rss/one_word, step 2: FAIL; pause of 20.000 ms after 5 bytes"
};
std::vector<CapturedFrame> captured_frames(const results::CaseResult& result);

}  // namespace fieldproof::reports
