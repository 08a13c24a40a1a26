#include "reports/text/frame_cells.hpp"

#include <algorithm>
#include <string_view>

namespace fieldproof::text {
namespace {

constexpr std::string_view open_byte = "??";

/// "06 30 ??"; nothing when it is something else (alternatives in words, say).
std::optional<FrameCells> cells_of_hex(std::string_view hex) {
  FrameCells cells;
  for (std::size_t at = 0; at < hex.size(); at += 3) {
    const std::string_view pair = hex.substr(at, 2);
    const bool digits = pair.size() == 2 && hex_digit(pair[0]) >= 0 && hex_digit(pair[1]) >= 0;
    const bool separated = at + 2 >= hex.size() || hex[at + 2] == ' ';
    if (!separated || !(digits || pair == open_byte)) return std::nullopt;
    cells.push_back({std::string(pair)});
  }
  return cells;
}

/// Marks what differs: each byte where the lengths are equal, else the first, since all that follow
/// have moved. Where an answer breaks off, "--" stands for the byte that is missing.
void mark_differences(const FrameCells& expected, FrameCells& received) {
  const std::size_t common = std::min(expected.size(), received.size());
  const bool moved = expected.size() != received.size();
  for (std::size_t i = 0; i < common; ++i) {
    received[i].marked = expected[i].text != open_byte && expected[i].text != received[i].text;
    if (received[i].marked && moved) return;
  }
  if (received.size() > common) received[common].marked = true;
  if (received.size() == common && moved && common > 0)
    received.push_back({"--", true});  // here it broke off
}

}  // namespace

FrameCells cells_of(ByteView bytes) {
  FrameCells cells(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) cells[i].text = hex_number(bytes[i], 2);
  return cells;
}

JudgedFrames judged_frames(const results::CaseResult& result) {
  JudgedFrames frames{cells_of_hex(result.expected_hex), cells_of(result.received_bytes)};
  if (frames.expected && frames.expected->empty())
    frames.expected = cells_of(result.expected_bytes);
  if (frames.expected && !frames.expected->empty())
    mark_differences(*frames.expected, frames.received);
  if (!result.received_extract.empty()) frames.received.resize(result.received_bytes.size());
  return frames;
}

bool has_judged_frames(const results::CaseResult& result) {
  return !result.expected.empty() || !result.expected_hex.empty() || !result.received_bytes.empty();
}

}  // namespace fieldproof::text
