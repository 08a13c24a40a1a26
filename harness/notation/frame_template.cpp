#include "harness/notation/frame_template.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

#include "src/base/spelling.hpp"

namespace fieldproof::notation {

namespace {

using Cell = FrameTemplate::Cell;

std::string unknown_check(const std::string& name, Checks checks) {
  std::vector<std::string_view> names;
  for (const Check& check : checks) names.push_back(check.name);
  return fmt::format(
      "unknown word '{}': it is no control character, and {}{}", name,
      names.empty() ? "this protocol has no checks"
                    : fmt::format("the checks of this protocol are {}", fmt::join(names, ", ")),
      suggestion(name, names));
}

/// Of a notation whose words are known.
class Builder {
 public:
  explicit Builder(const Fields& fields) : fields_(fields) {
    frames_.emplace_back();
    begins_.push_back(0);
  }

  Status add_all(const Notation& notation) {
    for (const Item& item : notation)
      for (int i = 0; i < item.repeat; ++i)
        if (Status added = add(item); !added) return added;
    return ok();
  }

  std::vector<FrameTemplate> take() {
    for (FrameTemplate& frame : frames_)
      for (std::size_t i = 0; i < frame.cells.size(); ++i)
        if (frame.cells[i].kind != Cell::Kind::literal) frame.holes.push_back(i);
    return std::move(frames_);
  }

 private:
  Status add(const Item& item) {
    if (item.kind == Item::Kind::alternatives) return fork(item);
    for (std::size_t i = 0; i < frames_.size(); ++i) add_to(frames_[i], begins_[i], item);
    return ok();
  }

  /// One frame per alternative, the preferred ones first.
  Status fork(const Item& item) {
    std::vector<FrameTemplate> frames;
    std::vector<std::size_t> begins;
    for (const Item::Alternative& alternative : item.alternatives) {
      Builder branch = *this;
      if (Status added = branch.add_all(alternative.items); !added) return added;
      for (FrameTemplate& frame : branch.frames_)
        frame.readings[item.alternatives.front().name] = alternative.name;
      frames.insert(frames.end(), branch.frames_.begin(), branch.frames_.end());
      begins.insert(begins.end(), branch.begins_.begin(), branch.begins_.end());
    }
    if (frames.size() > 64)
      return fail("too many alternatives in one frame (more than 64); split the vector");
    frames_ = std::move(frames);
    begins_ = std::move(begins);
    return ok();
  }

  void add_to(FrameTemplate& frame, std::size_t& begin, const Item& item) {
    switch (item.kind) {
      case Item::Kind::open: begin = frame.bytes.size(); break;
      case Item::Kind::close: settle(frame, begin); break;
      case Item::Kind::literal: literal(frame, item.bytes); break;
      case Item::Kind::station:
        literal(frame, item.number == 0 ? fields_.own : fields_.foreign);
        break;
      case Item::Kind::name:
        literal(frame, fields_.name_head(item.text.size()));
        literal(frame, to_bytes(item.text));
        break;
      case Item::Kind::sequence:
        for (int word = 1; word <= item.number; ++word)
          literal(frame, to_bytes(hex_number(static_cast<unsigned>(word), 4)));
        break;
      case Item::Kind::check: check(frame, begin, item); break;
      case Item::Kind::pause: frame.gaps.push_back({frame.bytes.size(), item.pause}); break;
      case Item::Kind::any: hole(frame, Cell::Kind::any, 1, ""); break;
      case Item::Kind::hex_digits: hole(frame, Cell::Kind::hex_digit, item.number, ""); break;
      case Item::Kind::capture: hole(frame, Cell::Kind::capture, item.number, item.text); break;
      case Item::Kind::reuse:
        hole(frame, Cell::Kind::reuse, item.number ? item.number : captured_size(frame, item.text),
             item.text);
        break;
      case Item::Kind::alternatives: break;
    }
  }

  /// {id} is as long as {id:n} made it, in this frame; of an earlier one whoever reads the frames
  /// in order says it (Item::number), else it is four characters.
  static int captured_size(const FrameTemplate& frame, const std::string& name) {
    int size = 0;
    for (const Cell& cell : frame.cells)
      if (cell.kind == Cell::Kind::capture && frame.names[cell.part] == name) ++size;
    return size ? size : 4;
  }

  static void literal(FrameTemplate& frame, ByteView bytes) {
    frame.bytes.insert(frame.bytes.end(), bytes.begin(), bytes.end());
    frame.cells.resize(frame.bytes.size());
  }

  static void hole(FrameTemplate& frame, Cell::Kind kind, int size, const std::string& name) {
    const auto part = static_cast<std::uint16_t>(frame.names.size());
    frame.names.push_back(name);
    for (int i = 0; i < size; ++i) {
      frame.bytes.push_back(0);
      frame.cells.push_back({kind, part, static_cast<std::uint32_t>(i)});
    }
  }

  static bool is_literal(const FrameTemplate& frame, std::size_t from, std::size_t to) {
    return std::all_of(frame.cells.begin() + static_cast<std::ptrdiff_t>(from),
                       frame.cells.begin() + static_cast<std::ptrdiff_t>(to),
                       [](const Cell& cell) { return cell.kind == Cell::Kind::literal; });
  }

  void check(FrameTemplate& frame, std::size_t begin, const Item& item) const {
    const Check& kind = *find_check(fields_.checks, item.text);
    const ByteView before = ByteView(frame.bytes).subspan(begin);
    if (kind.absent && !item.wrong && kind.absent(before)) return;
    if (!kind.behind && is_literal(frame, begin, frame.cells.size())) {
      literal(frame, item.wrong ? kind.wrong_over(before) : kind.over(before));
      return;
    }
    const auto part = static_cast<std::uint16_t>(frame.checks.size());
    frame.checks.push_back({&kind, item.wrong, begin, frame.bytes.size(), 0});
    for (std::size_t i = 0; i < kind.size; ++i) {
      frame.bytes.push_back(0);
      frame.cells.push_back({Cell::Kind::check, part, static_cast<std::uint32_t>(i)});
    }
  }

  /// The bracket is complete: checks of what is behind them are known where all of that is literal,
  /// or only counted; then those of what precedes them, which may hold such a check.
  static void settle(FrameTemplate& frame, std::size_t begin) {
    for (FrameTemplate::Check& check : frame.checks) {
      if (!check.kind->behind || check.begin != begin || check.end != 0) continue;
      check.end = frame.bytes.size();
      const std::size_t from = check.at + check.kind->size;
      if (check.kind->counts || is_literal(frame, from, check.end))
        fill(frame, check, ByteView(frame.bytes).subspan(from));
    }
    for (const FrameTemplate::Check& check : frame.checks)
      if (!check.kind->behind && check.begin == begin && is_literal(frame, begin, check.at))
        fill(frame, check, ByteView(frame.bytes).subspan(begin, check.at - begin));
  }

  static void fill(FrameTemplate& frame, const FrameTemplate::Check& check, ByteView covered) {
    std::ranges::copy(check.wrong ? check.kind->wrong_over(covered) : check.kind->over(covered),
                      frame.bytes.begin() + static_cast<std::ptrdiff_t>(check.at));
    for (std::size_t i = 0; i < check.kind->size; ++i) frame.cells[check.at + i] = {};
  }

  const Fields& fields_;
  std::vector<FrameTemplate> frames_;
  std::vector<std::size_t> begins_;  // of the bracket that is open, one a frame
};

Byte check_byte(const FrameTemplate& frame, const Cell& cell, ByteView bytes) {
  return check_bytes(frame.checks[cell.part], bytes)[cell.index];
}

bool cell_matches(const FrameTemplate& frame, std::size_t i, ByteView received,
                  Captures& captures) {
  const Cell& cell = frame.cells[i];
  const char c = static_cast<char>(received[i]);
  switch (cell.kind) {
    case Cell::Kind::literal: return frame.bytes[i] == received[i];
    case Cell::Kind::any: return true;
    case Cell::Kind::hex_digit:
      return hex_digit(c) >= 0 && !(c >= 'a' && c <= 'f');  // replies use upper-case hex
    case Cell::Kind::check: return check_byte(frame, cell, received) == received[i];
    case Cell::Kind::capture: {
      std::string& text = captures[frame.names[cell.part]];
      if (cell.index == 0) text.clear();
      text += c;
      return true;
    }
    case Cell::Kind::reuse: {
      const auto found = captures.find(frame.names[cell.part]);
      return found != captures.end() && cell.index < found->second.size() &&
             found->second[cell.index] == c;
    }
  }
  return false;
}

/// The offset, from `from` on, of the first byte that differs; `end`: none before it does.
std::size_t equal_until(std::size_t end, std::size_t from, ByteView expected, ByteView received) {
  const ByteView part = expected.subspan(from, end - from);
  if (std::ranges::equal(part, received.subspan(from, part.size()))) return end;  // mostly
  const auto differs = std::ranges::mismatch(part, received.subspan(from)).in1;
  return from + static_cast<std::size_t>(differs - part.begin());
}

}  // namespace

Status check_words(const Notation& notation, const Fields& fields) {
  for (const Item& item : notation) {
    if (item.kind == Item::Kind::check && !find_check(fields.checks, item.text))
      return fail(unknown_check(item.text, fields.checks));
    if (item.kind == Item::Kind::name && !fields.name_head)
      return fail(fmt::format("name({}): frames of this protocol have no names", item.text));
    for (const Item::Alternative& alternative : item.alternatives)
      if (Status known = check_words(alternative.items, fields); !known) return known;
  }
  return ok();
}

Result<std::vector<FrameTemplate>> make_templates(const Notation& notation, const Fields& fields) {
  if (const Status known = check_words(notation, fields); !known) return known.error();
  Builder builder(fields);
  if (Status added = builder.add_all(notation); !added) return added.error();
  return builder.take();
}

Bytes check_bytes(const FrameTemplate::Check& check, ByteView frame) {
  const std::size_t from = check.kind->behind ? check.at + check.kind->size : check.begin;
  const std::size_t to = std::min(check.kind->behind ? check.end : check.at, frame.size());
  const ByteView covered = frame.subspan(std::min(from, to), to - std::min(from, to));
  return check.wrong ? check.kind->wrong_over(covered) : check.kind->over(covered);
}

Result<Bytes> render(const FrameTemplate& frame, const Captures& captures) {
  Bytes bytes = frame.bytes;
  for (const std::size_t i : frame.holes) {
    const Cell& cell = frame.cells[i];
    if (cell.kind == Cell::Kind::check) {
      bytes[i] = check_byte(frame, cell, bytes);
      continue;
    }
    const auto found =
        cell.kind == Cell::Kind::reuse ? captures.find(frame.names[cell.part]) : captures.end();
    if (found == captures.end() || cell.index >= found->second.size())
      return fail(
          fmt::format("cannot send byte {} of the frame: its place is open; only `expect` may "
                      "leave places open",
                      i));
    bytes[i] = static_cast<Byte>(found->second[cell.index]);
  }
  return bytes;
}

std::optional<std::size_t> first_mismatch(const FrameTemplate& frame, ByteView received,
                                          Captures& captures) {
  const std::size_t common = std::min(frame.bytes.size(), received.size());
  Captures found = captures;
  std::size_t at = 0;
  for (const std::size_t hole : frame.holes) {
    if (hole >= common) break;
    at = equal_until(hole, at, frame.bytes, received);
    if (at < hole || !cell_matches(frame, hole, received, found)) return at;
    ++at;
  }
  at = equal_until(common, at, frame.bytes, received);
  if (at < common || frame.bytes.size() != received.size()) return at;
  captures = std::move(found);
  return std::nullopt;
}

std::string to_hex_with_holes(const FrameTemplate& frame) {
  std::string text;
  for (std::size_t i = 0; i < frame.bytes.size(); ++i) {
    if (i) text += ' ';
    text += frame.cells[i].kind == Cell::Kind::literal ? hex_number(frame.bytes[i], 2) : "??";
  }
  return text;
}

}  // namespace fieldproof::notation
