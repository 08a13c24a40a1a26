#include "harness/notation/frame_template.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace fieldproof::notation {

namespace {

using Cell = FrameTemplate::Cell;

/// XGT: byte 3 of the bracket (after header and station) is the main command; upper case has no
/// check (Cnet EN 7.1.2 Note 5).
bool check_vanishes(const FrameTemplate& frame, std::size_t begin) {
  const std::size_t command = begin + 3;
  return command < frame.bytes.size() && frame.cells[command].kind == Cell::Kind::literal &&
         frame.bytes[command] >= 'A' && frame.bytes[command] <= 'Z';
}

class Builder {
 public:
  explicit Builder(const Stations& stations) : stations_(stations) {
    frames_.emplace_back();
    begins_.push_back(0);
  }

  Status add_all(const Notation& notation) {
    for (const Item& item : notation)
      for (int i = 0; i < item.repeat; ++i)
        if (Status added = add(item); !added) return added;
    return ok();
  }

  std::vector<FrameTemplate> take() { return std::move(frames_); }

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
      case Item::Kind::close: break;
      case Item::Kind::literal: literal(frame, item.bytes); break;
      case Item::Kind::station:
        literal(frame, item.number == 0 ? stations_.own : stations_.foreign);
        break;
      case Item::Kind::name:
        literal(frame, to_bytes(hex_number(item.text.size(), 2) + item.text));
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
        hole(frame, Cell::Kind::reuse, captured_size(frame, item.text), item.text);
        break;
      case Item::Kind::alternatives: break;
    }
  }

  /// {id} is as long as {id:n} made it; captures of an earlier step are four characters.
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
    frame.open = true;
  }

  static void check(FrameTemplate& frame, std::size_t begin, const Item& item) {
    if (item.check == CheckKind::bcc && !item.wrong && check_vanishes(frame, begin)) return;
    const bool settled =
        std::all_of(frame.cells.begin() + static_cast<std::ptrdiff_t>(begin), frame.cells.end(),
                    [](const Cell& cell) { return cell.kind == Cell::Kind::literal; });
    if (settled) {
      const ByteView covered = ByteView(frame.bytes).subspan(begin);
      literal(frame, item.wrong ? compute_wrong_check(item.check, covered)
                                : compute_check(item.check, covered));
      return;
    }
    const auto part = static_cast<std::uint16_t>(frame.checks.size());
    frame.checks.push_back({item.check, item.wrong, begin, frame.bytes.size()});
    for (std::size_t i = 0; i < check_size; ++i) {
      frame.bytes.push_back(0);
      frame.cells.push_back({Cell::Kind::check, part, static_cast<std::uint32_t>(i)});
    }
  }

  const Stations& stations_;
  std::vector<FrameTemplate> frames_;
  std::vector<std::size_t> begins_;  // of the bracket that is open, one a frame
};

Byte check_byte(const FrameTemplate& frame, const Cell& cell, ByteView bytes) {
  const FrameTemplate::Check& check = frame.checks[cell.part];
  const ByteView covered = bytes.subspan(check.begin, check.at - check.begin);
  return (check.wrong ? compute_wrong_check(check.kind, covered)
                      : compute_check(check.kind, covered))[cell.index];
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

}  // namespace

Result<std::vector<FrameTemplate>> make_templates(const Notation& notation,
                                                  const Stations& stations) {
  Builder builder(stations);
  if (Status added = builder.add_all(notation); !added) return added.error();
  return builder.take();
}

Result<Bytes> render(const FrameTemplate& frame, const Captures& captures) {
  Bytes bytes = frame.bytes;
  for (std::size_t i = 0; frame.open && i < bytes.size(); ++i) {
    const Cell& cell = frame.cells[i];
    if (cell.kind == Cell::Kind::literal) continue;
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
  if (!frame.open) {
    const auto [expected, actual] = std::ranges::mismatch(frame.bytes, received);
    if (expected == frame.bytes.end() && actual == received.end()) return std::nullopt;
    return static_cast<std::size_t>(expected - frame.bytes.begin());
  }
  Captures found = captures;
  const std::size_t common = std::min(frame.bytes.size(), received.size());
  for (std::size_t i = 0; i < common; ++i)
    if (!cell_matches(frame, i, received, found)) return i;
  if (frame.bytes.size() != received.size()) return common;
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
