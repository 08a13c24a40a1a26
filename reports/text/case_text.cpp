#include "reports/text/case_text.hpp"
#include "reports/results/extract.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "reports/text/frame_cells.hpp"
#include "reports/text/tally.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::text {

using results::CaseResult;
using results::Event;

namespace {

constexpr std::size_t bytes_a_line = 16;
constexpr std::size_t longest_frame = 4096;  // bytes that are shown in full

/// `before`: bytes of the frame that stand before the cells.
std::string dump_line(const FrameCells& cells, std::size_t first, std::size_t last, bool offsets,
                      std::size_t before) {
  std::string text = offsets ? fmt::format("{:04X}  ", before + first) : "";
  std::string marks(text.size(), ' ');
  for (std::size_t i = first; i < last; ++i) {
    const std::string_view gap = i == first ? "" : (i - first) % 8 == 0 ? "  " : " ";
    text += fmt::format("{}{}", gap, cells[i].text);
    marks += fmt::format("{}{}", gap, cells[i].marked ? "^^" : "  ");
  }
  marks.erase(marks.find_last_not_of(' ') + 1);
  return text + '\n' + (marks.empty() ? "" : marks + '\n');
}

std::string dump_lines(const FrameCells& cells, std::size_t end, bool offsets,
                       std::size_t before = 0) {
  std::string text;
  for (std::size_t first = 0; first < end; first += bytes_a_line)
    text += dump_line(cells, first, std::min(first + bytes_a_line, end), offsets, before);
  return text;
}

/// Of a flood: both ends, how much it was, and what tells it from another one.
std::string dump(const FrameCells& head, std::size_t kept, const results::Extract& extract) {
  return dump_lines(head, kept, true) +
         fmt::format("... {} bytes left out\n", grouped(extract.left_out(kept))) +
         dump_lines(cells_of(extract.tail), extract.tail.size(), true,
                    extract.count - extract.tail.size()) +
         fmt::format("{} bytes in all, sha256 {}\n", grouped(extract.count), extract.sha256);
}

/// `bytes`: those of the cells.
std::string dump(const FrameCells& cells, ByteView bytes, const results::Extract& extract,
                 const CaseTextOptions& options, bool offsets) {
  if (!extract.empty()) return dump(cells, cells.size(), extract);
  if (cells.size() > longest_frame) {
    Bytes head(bytes.begin(), bytes.end());
    const results::Extract of_it = results::cut(head, longest_frame);
    return dump(cells, head.size(), of_it);
  }
  const std::size_t shown =
      options.limit == 0 ? cells.size() : std::min(cells.size(), options.limit);
  std::string text = dump_lines(cells, shown, offsets);
  if (shown < cells.size()) text += fmt::format("... {} more bytes\n", cells.size() - shown);
  return text;
}

std::size_t characters(std::string_view utf8) {
  const auto starts_one = [](char c) { return (static_cast<Byte>(c) & 0xC0u) != 0x80u; };
  return static_cast<std::size_t>(std::count_if(utf8.begin(), utf8.end(), starts_one));
}

std::string padded(const std::string& text, std::size_t width) {
  const std::size_t have = characters(text);
  return have < width ? text + std::string(width - have, ' ') : text;
}

/// Rows with a label on the left; a row of several lines is indented below its first.
class Block {
 public:
  void add(std::string_view label, std::string_view lines) {
    while (!lines.empty()) {
      const std::size_t end = std::min(lines.find('\n'), lines.size());
      if (end > 0) text_ += fmt::format("{:<10}{}", label, lines.substr(0, end));
      text_ += '\n';
      lines.remove_prefix(std::min(end + 1, lines.size()));
      label = "";
    }
  }
  void line(const std::string& line) { text_ += line + '\n'; }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// The frame that the judged answer answers: the last sent before it; without an answer, the last
/// sent.
const Event* request_of(const CaseResult& result) {
  const Event* request = nullptr;
  const Event* before_answer = nullptr;
  for (const Event& event : result.exchange) {
    if (event.kind == Event::Kind::sent) request = &event;
    const bool came = event.kind == Event::Kind::received && !event.bytes.empty();
    if (came && event.bytes == result.received_bytes && event.extract == result.received_extract &&
        request != nullptr)
      before_answer = request;
  }
  return before_answer != nullptr ? before_answer : request;
}

std::string clause(const CaseResult& result) {
  std::string text = xml_line(result.manual);
  if (!result.section.empty()) text += (text.empty() ? "" : ", ") + xml_line(result.section);
  if (!result.level.empty()) {
    text += fmt::format("{}({}, {})", text.empty() ? "" : " ", xml_line(result.level),
                        xml_line(result.basis));
  }
  if (!result.quote.empty()) text += fmt::format("\n\"{}\"", xml_line(result.quote));
  return text;
}

/// Notation above, bytes below.
std::string frame(const std::string& notation, const std::string& bytes,
                  const CaseTextOptions& options) {
  return (notation.empty() ? "" : shorten(notation, options) + '\n') + bytes;
}

std::string differences(const CaseResult& result, const CaseTextOptions& options) {
  using Row = std::array<std::string, 4>;
  std::vector<Row> rows = {{"field", "expected", "received", ""}};
  for (const results::Difference& difference : result.differences) {
    rows.push_back({shorten(difference.field, options), shorten(difference.expected, options),
                    shorten(difference.received, options), shorten(difference.hint, options)});
  }
  constexpr std::size_t widest = 40;  // one long value must not push all others aside
  std::array<std::size_t, 3> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < widths.size(); ++i)
      widths[i] = std::min(widest, std::max(widths[i], characters(row[i])));
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < widths.size(); ++i) line += padded(row[i], widths[i]) + "  ";
    line += row[3];
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

bool several_sent(const CaseResult& result) {
  const auto sent = [](const Event& event) { return event.kind == Event::Kind::sent; };
  return std::count_if(result.exchange.begin(), result.exchange.end(), sent) > 1;
}

void add_frames(Block& block, const CaseResult& result, const CaseTextOptions& options) {
  if (!has_judged_frames(result)) return;
  const auto [expected, received] = judged_frames(result);
  // Alike for both, so that they stand byte below byte.
  const bool offsets = std::max(expected ? expected->size() : 0, received.size()) > bytes_a_line;

  if (const Event* request = request_of(result)) {
    block.add("sent", frame(request->text, hex_dump(request->bytes, options), options));
  }
  const std::string expected_bytes =
      expected ? dump(*expected, result.expected_bytes, {}, options, offsets)
               : shorten(result.expected_hex, options);
  block.add("expected", frame(result.expected, expected_bytes, options));
  const std::string came = frame(
      result.received,
      dump(received, result.received_bytes, result.received_extract, options, offsets), options);
  block.add("received", came.empty() ? "nothing" : came);
}

const char* arrow(Event::Kind kind) {
  switch (kind) {
    case Event::Kind::sent: return "-->";
    case Event::Kind::received: return "<--";
    case Event::Kind::opened:
    case Event::Kind::closed:
    case Event::Kind::reset:
    case Event::Kind::note: break;
  }
  return " . ";
}

}  // namespace

std::string shorten(const std::string& text, const CaseTextOptions& options) {
  // A byte in notation takes one to four characters.
  const std::size_t limit =
      text.size() > 4 * longest_frame ? 4 * results::extract_end : 4 * options.limit;
  // Cleaning never shortens: what stands far behind the cut need not be cleaned. A character split
  // here is behind it, too.
  const std::string clean =
      xml_line(limit == 0 ? std::string_view(text) : std::string_view(text).substr(0, limit + 4));
  if (limit == 0 || clean.size() <= limit) return clean;
  std::size_t cut = limit;
  while (cut > 0 && (static_cast<Byte>(clean[cut]) & 0xC0u) == 0x80u)
    --cut;  // not within a character
  return clean.substr(0, cut) + " ...";
}

std::string case_name(const CaseResult& result) {
  return result.line.empty() ? xml_line(result.id)
                             : fmt::format("{} [{}]", xml_line(result.id), xml_line(result.line));
}

std::string group_of(const std::string& id) {
  const std::size_t first = id.find('/');
  return first == std::string::npos ? id : id.substr(0, id.find('/', first + 1));
}

std::string case_label(const CaseResult& result) {
  return result.repeat == 0 ? case_name(result)
                            : fmt::format("{} #{}", case_name(result), result.repeat + 1);
}

std::string case_timing(const CaseResult& result) {
  const auto& times = result.response_ms;
  if (times.empty()) return "";
  if (times.size() == 1) return fmt::format("reply after {:.3f} ms", times[0]);
  if (times.size() <= 4) {
    std::string text = "replies after";
    for (const double& time : times)
      text += fmt::format("{} {:.3f}", &time == &times.front() ? "" : ",", time);
    return text + " ms";
  }
  std::vector<double> sorted = times;
  std::sort(sorted.begin(), sorted.end());
  return fmt::format("{} replies after {:.3f} to {:.3f} ms, median {:.3f} ms", sorted.size(),
                     sorted.front(), sorted.back(), sorted[sorted.size() / 2]);
}

std::string case_message(const CaseResult& result) {
  return result.message.empty() ? std::string(results::to_string(result.verdict))
                                : xml_line(result.message);
}

std::string hex_dump(ByteView bytes, const CaseTextOptions& options,
                     const results::Extract& extract) {
  return dump(cells_of(bytes), bytes, extract, options, bytes.size() > bytes_a_line);
}

std::string indent(std::string_view lines, std::size_t columns) {
  std::string text;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    if (end > 0) text += std::string(columns, ' ');
    text += lines.substr(0, end);
    text += '\n';
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return text;
}

std::string frame_monitor(const CaseResult& result, const CaseTextOptions& options) {
  if (result.exchange.empty()) return "";
  const auto row = [](const std::string& time, const std::string& gap, const char* direction,
                      const std::string& text) {
    return fmt::format("{:>10}  {:>9}  {}  {}\n", time, gap, direction, text);
  };
  constexpr std::size_t frame_column = 28;
  std::string text = row("time ms", "gap ms", "   ", "frame");
  const Time zero = results::shown_from(result);
  std::optional<Time> last_end;
  for (const Event& event : result.exchange) {
    const bool is_frame = event.kind != Event::Kind::note;
    const std::string gap =
        is_frame && last_end ? fmt::format("{:.3f}", to_ms(event.start - *last_end)) : "";
    text += row(fmt::format("{:.3f}", to_ms(event.start - zero)), gap, arrow(event.kind),
                shorten(event.text, options));
    if (!is_frame) continue;
    text += indent(hex_dump(event.bytes, options, event.extract), frame_column);
    last_end = event.end;
  }
  return text;
}

std::string case_block(const CaseResult& result, const CaseTextOptions& options) {
  Block block;
  if (!result.title.empty()) block.line(xml_line(result.title));
  block.add("clause", clause(result));
  add_frames(block, result, options);
  if (!result.differences.empty()) block.add("differs", differences(result, options));
  block.add("timing", case_timing(result));
  block.add("device", xml_line(result.dut));
  const bool shown = options.exchange || several_sent(result) || result.recording.flooded;
  if (!result.exchange.empty() && shown) block.add("exchange", frame_monitor(result, options));
  std::string readings;
  for (const auto& [name, taken] : result.readings)
    readings += fmt::format("{} = {}\n", xml_line(name), xml_line(taken));
  block.add("reading", readings);
  std::string notes;
  for (const std::string& note : result.notes) notes += xml_line(note) + '\n';
  block.add("notes", notes);
  block.add("replay", xml_line(result.replay));
  return block.take();
}

}  // namespace fieldproof::text
