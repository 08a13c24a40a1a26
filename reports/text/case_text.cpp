#include "reports/text/case_text.hpp"
#include "reports/results/extract.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "reports/text/fold.hpp"
#include "reports/text/frame_cells.hpp"
#include "reports/text/tally.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::text {

using results::CaseResult;
using results::Event;

namespace {

constexpr std::size_t label_width = 10;
constexpr std::size_t dump_of_16 = 55;       // columns, with offsets
constexpr std::size_t longest_frame = 4096;  // bytes that are shown in full

std::size_t bytes_a_line(const CaseTextOptions& options) {
  return options.width == 0 || options.width >= dump_of_16 ? 16 : 8;
}

/// Where `columns` of each line are taken by what stands left of it.
CaseTextOptions beside(CaseTextOptions options, std::size_t columns) {
  if (options.width > 0) options.width -= std::min(columns, options.width - 1);
  return options;
}

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

std::string dump_lines(const FrameCells& cells, std::size_t end, std::size_t a_line, bool offsets,
                       std::size_t before = 0) {
  std::string text;
  for (std::size_t first = 0; first < end; first += a_line)
    text += dump_line(cells, first, std::min(first + a_line, end), offsets, before);
  return text;
}

/// Of a flood: both ends, how much it was, and what tells it from another one.
std::string dump(const FrameCells& head, std::size_t kept, const results::Extract& extract,
                 std::size_t a_line) {
  return dump_lines(head, kept, a_line, true) +
         fmt::format("... {} bytes left out\n", grouped(extract.left_out(kept))) +
         dump_lines(cells_of(extract.tail), extract.tail.size(), a_line, true,
                    extract.count - extract.tail.size()) +
         fmt::format("{} bytes in all, sha256 {}\n", grouped(extract.count), extract.sha256);
}

/// `bytes`: those of the cells.
std::string dump(const FrameCells& cells, ByteView bytes, const results::Extract& extract,
                 const CaseTextOptions& options, bool offsets) {
  const std::size_t a_line = bytes_a_line(options);
  if (!extract.empty()) return dump(cells, cells.size(), extract, a_line);
  if (cells.size() > longest_frame) {
    Bytes head(bytes.begin(), bytes.end());
    const results::Extract of_it = results::cut(head, longest_frame);
    return dump(cells, head.size(), of_it, a_line);
  }
  const std::size_t shown =
      options.limit == 0 ? cells.size() : std::min(cells.size(), options.limit);
  std::string text = dump_lines(cells, shown, a_line, offsets);
  if (shown < cells.size()) text += fmt::format("... {} more bytes\n", cells.size() - shown);
  return text;
}

std::string padded(const std::string& text, std::size_t width) {
  const std::size_t have = columns_of(text);
  return have < width ? text + std::string(width - have, ' ') : text;
}

/// Rows with a label on the left; a row of several lines is indented below its first.
class Block {
 public:
  void add(std::string_view label, std::string_view lines) {
    while (!lines.empty()) {
      const std::size_t end = std::min(lines.find('\n'), lines.size());
      if (end > 0) text_ += fmt::format("{:<{}}{}", label, label_width, lines.substr(0, end));
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

/// What was judged, in the exchange. nullptr: not there.
struct Judged {
  const Event* request = nullptr;  // that the answer answers; without an answer, the last sent
  const Event* answer = nullptr;
};

/// `probes`: also of what belongs to no step, as a probe does.
Judged judged_in(const CaseResult& result, bool probes) {
  Judged judged;
  const Event* request = nullptr;
  for (const Event& event : result.exchange) {
    if (event.step < 0 && !event.surplus && !probes) continue;
    if (event.kind == Event::Kind::sent) request = &event;
    const bool came = event.kind == Event::Kind::received && !event.bytes.empty();
    if (came && event.bytes == result.received_bytes && event.extract == result.received_extract &&
        request != nullptr) {
      judged = {request, &event};
      // The same answer may have come to what was asked before, and behind it.
      if (!result.due.empty() && event.end >= result.due.from) return judged;
    }
  }
  if (!judged.request) judged.request = request;
  return judged;
}

/// A probe may be answered by the very frame that is wrong.
Judged judged_in(const CaseResult& result) {
  const Judged judged = judged_in(result, false);
  return judged.request && (judged.answer || result.received_bytes.empty())
             ? judged
             : judged_in(result, true);
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

using DifferenceRow = std::array<std::string, 4>;

/// Cells side by side, each in lines of its column's width; the hint, where it does not fit beside
/// them, in a line of its own.
std::string difference_row(const DifferenceRow& row, const std::array<std::size_t, 3>& widths,
                           const CaseTextOptions& options) {
  std::array<std::string, 3> cells;
  for (std::size_t i = 0; i < cells.size(); ++i)
    cells[i] = options.width == 0 ? row[i] : fold(row[i], widths[i]);
  std::string text, hint = row[3];
  while (std::ranges::any_of(cells, [](const std::string& cell) { return !cell.empty(); })) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::size_t end = std::min(cells[i].find('\n'), cells[i].size());
      line += padded(cells[i].substr(0, end), widths[i]) + "  ";
      cells[i].erase(0, end + 1);
    }
    if (options.width == 0 || columns_of(line + hint) <= options.width)
      line += std::exchange(hint, "");
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return hint.empty() ? text : text + fold("  " + hint, options.width) + '\n';
}

std::string differences(const CaseResult& result, const CaseTextOptions& options) {
  std::vector<DifferenceRow> rows = {{"field", "expected", "received", ""}};
  for (const results::Difference& difference : result.differences) {
    rows.push_back({shorten(difference.field, options), shorten(difference.expected, options),
                    shorten(difference.received, options), shorten(difference.hint, options)});
  }
  // One long value must not push all others aside.
  std::array<std::size_t, 3> widest{40, 40, 40};
  if (options.width > 0) {
    widest[0] = std::clamp<std::size_t>(options.width / 4, 6, 16);
    widest[1] = widest[2] = std::clamp<std::size_t>((options.width - widest[0] - 4) / 2, 8, 40);
  }
  std::array<std::size_t, 3> widths{};
  for (const DifferenceRow& row : rows) {
    for (std::size_t i = 0; i < widths.size(); ++i)
      widths[i] = std::min(widest[i], std::max(widths[i], columns_of(row[i])));
  }
  std::string text;
  for (const DifferenceRow& row : rows) text += difference_row(row, widths, options);
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
  const bool offsets =
      std::max(expected ? expected->size() : 0, received.size()) > bytes_a_line(options);

  if (const Event* request = judged_in(result).request) {
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
  return dump(cells_of(bytes), bytes, extract, options, bytes.size() > bytes_a_line(options));
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
  constexpr std::size_t frame_column = 28;
  const CaseTextOptions inner = beside(options, frame_column);
  const Judged above = options.frames_above ? judged_in(result) : Judged{};
  const auto row = [&inner](const std::string& time, const std::string& gap, const char* direction,
                            const std::string& text) {
    const std::string lines = indent(fold(text, inner.width), frame_column);
    return fmt::format("{:>10}  {:>9}  {}  {}", time, gap, direction,
                       lines.size() > frame_column ? lines.substr(frame_column) : "\n");
  };
  std::string text = row("time ms", "gap ms", "   ", "frame");
  const Time zero = results::shown_from(result);
  std::optional<Time> last_end;
  for (const Event& event : result.exchange) {
    const bool is_frame = event.kind != Event::Kind::note;
    const std::string gap =
        is_frame && last_end ? fmt::format("{:.3f}", to_ms(event.start - *last_end)) : "";
    const bool stands_above = &event == above.request || &event == above.answer;
    text += row(fmt::format("{:.3f}", to_ms(event.start - zero)), gap, arrow(event.kind),
                stands_above ? &event == above.request ? "as sent above" : "as received above"
                             : shorten(event.text, options));
    if (!is_frame) continue;
    if (!stands_above) text += indent(hex_dump(event.bytes, inner, event.extract), frame_column);
    last_end = event.end;
  }
  return text;
}

std::string case_block(const CaseResult& result, const CaseTextOptions& options) {
  Block block;
  if (!result.title.empty()) block.line(xml_line(result.title));
  block.add("clause", clause(result));
  CaseTextOptions inner = beside(options, label_width);
  add_frames(block, result, inner);
  inner.frames_above = has_judged_frames(result);
  if (!result.differences.empty()) block.add("differs", differences(result, inner));
  block.add("timing", case_timing(result));
  block.add("device", xml_line(result.dut));
  const bool shown = options.exchange || several_sent(result) || result.recording.flooded;
  if (!result.exchange.empty() && shown) block.add("exchange", frame_monitor(result, inner));
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
