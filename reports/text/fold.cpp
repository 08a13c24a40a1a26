#include "reports/text/fold.hpp"

#include <algorithm>
#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::text {

namespace {

constexpr char escape = '\x1b';

/// Behind the character, or the colour, that begins at `at`.
std::size_t next_character(std::string_view text, std::size_t at) {
  if (text[at] == escape) return std::min(text.find('m', at), text.size() - 1) + 1;
  ++at;
  while (at < text.size() && (static_cast<Byte>(text[at]) & 0xC0u) == 0x80u) ++at;
  return at;
}

char32_t code_point(std::string_view utf8) {
  char32_t code = static_cast<Byte>(utf8[0]);
  if (utf8.size() > 1) code &= 0x3Fu >> (utf8.size() - 1);
  for (const char c : utf8.substr(1)) code = (code << 6u) | (static_cast<Byte>(c) & 0x3Fu);
  return code;
}

/// Hangul, Chinese and Japanese take two columns, a colour none.
std::size_t columns_of_character(std::string_view utf8) {
  if (utf8[0] == escape) return 0;
  const char32_t code = code_point(utf8);
  const auto within = [code](char32_t first, char32_t last) {
    return first <= code && code <= last;
  };
  return within(0x1100, 0x115F) || within(0x2E80, 0xA4CF) || within(0xAC00, 0xD7A3) ||
                 within(0xF900, 0xFAFF) || within(0xFF00, 0xFF60)
             ? 2
             : 1;
}

/// Behind the characters that fit in `width` columns, and the colours behind them.
std::size_t end_of_columns(std::string_view text, std::size_t width) {
  std::size_t at = 0;
  for (std::size_t used = 0; at < text.size();) {
    const std::size_t next = next_character(text, at);
    used += columns_of_character(text.substr(at, next - at));
    if (used > width) break;
    at = next;
  }
  return at;
}

std::size_t blanks_at(std::string_view line, std::size_t at) {
  return std::min(line.find_first_not_of(' ', at), line.size()) - at;
}

/// Where the text of a line begins: behind its indentation, and the label that two blanks end.
std::size_t text_begin(std::string_view line, std::size_t width) {
  const std::size_t indentation = blanks_at(line, 0);
  const std::size_t gap = line.find("  ", indentation);
  if (gap == std::string_view::npos) return indentation;
  const std::size_t behind = gap + blanks_at(line, gap);
  return columns_of(line.substr(0, behind)) <= width * 2 / 5 ? behind : indentation;
}

/// Behind the word that begins at `at`; one of the shell may have blanks in quotes.
std::size_t end_of_word(std::string_view line, std::size_t at, bool of_shell) {
  for (bool quoted = false; at < line.size() && (quoted || line[at] != ' '); ++at)
    if (of_shell && line[at] == '\'') quoted = !quoted;
  return at;
}

/// With the blanks in front of each but the first.
std::vector<std::string_view> words_of(std::string_view text, bool of_shell) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = end_of_word(text, at + blanks_at(text, at), of_shell);
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

/// The part of a word of the shell that goes into `width` columns with what breaks it; where there
/// is a blank in its second half, up to that.
std::size_t end_of_part(std::string_view word, std::size_t width) {
  std::size_t end = std::max<std::size_t>(end_of_columns(word, width), 1);
  if (end >= word.size()) return word.size();
  if (const std::size_t blank = word.rfind(' ', end - 1);
      blank != std::string_view::npos && blank > end / 2)
    end = blank + 1;
  while (end > 1 && word[end - 1] == '\\') --end;  // what it takes the meaning from comes with it
  return end;
}

/// One line that is too wide.
class Folded {
 public:
  Folded(std::string_view line, std::size_t width) : width_(width) {
    const std::size_t begin = text_begin(line, width);
    const std::string_view text = line.substr(begin);
    command_ = begin > 0 && text.starts_with("fieldproof ");
    out_ = line.substr(0, begin);
    used_ = hang_ = columns_of(out_);
    for (const std::string_view word : words_of(text, command_)) add(word);
  }
  std::string take() { return std::move(out_); }

 private:
  void add(std::string_view word) {
    const std::size_t room = width_ - (command_ ? 2 : 0);  // for the backslash
    if (used_ + columns_of(word) > room && used_ > hang_) {
      out_ += command_ ? " \\\n" : "\n";
      out_.append(hang_ + (command_ ? 2 : 0), ' ');
      used_ = hang_ + (command_ ? 2 : 0);
      word.remove_prefix(blanks_at(word, 0));
    }
    if (command_ && used_ + columns_of(word) > room) return add_in_parts(word);
    const bool whole = command_ || word.find('/') != std::string_view::npos;
    while (!whole && used_ + columns_of(word) > width_ && used_ + 1 < width_) {
      const std::size_t end = end_of_columns(word, width_ - used_);
      out_.append(word.substr(0, end)).append("\n").append(hang_, ' ');
      word.remove_prefix(end);
      used_ = hang_;
    }
    out_ += word;
    used_ += columns_of(word);
  }

  /// Nothing but a backslash and the end of the line stands between its parts, which makes them one
  /// word.
  void add_in_parts(std::string_view word) {
    bool quoted = false;
    while (!word.empty()) {
      const std::size_t taken = used_ + 2;  // by a quote and a backslash
      const std::size_t end = used_ + columns_of(word) + 2 <= width_
                                  ? word.size()
                                  : end_of_part(word, width_ - std::min(taken, width_));
      const std::string_view part = word.substr(0, end);
      for (std::size_t i = 0; i < part.size(); ++i)
        if (!quoted && part[i] == '\\')
          ++i;
        else if (part[i] == '\'')
          quoted = !quoted;
      out_ += part;
      used_ += columns_of(part);
      word.remove_prefix(end);
      if (word.empty()) return;
      out_ += quoted ? "'\\\n'" : "\\\n";
      used_ = quoted ? 1 : 0;
    }
  }

  std::size_t width_, hang_ = 0, used_ = 0;
  bool command_ = false;
  std::string out_;
};

}  // namespace

std::size_t columns_of(std::string_view utf8) {
  std::size_t columns = 0;
  for (std::size_t at = 0, next = 0; at < utf8.size(); at = next) {
    next = next_character(utf8, at);
    columns += columns_of_character(utf8.substr(at, next - at));
  }
  return columns;
}

std::string fold(std::string_view text, std::size_t width) {
  std::string folded;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    folded +=
        width == 0 || columns_of(line) <= width ? std::string(line) : Folded(line, width).take();
    if (end < text.size()) folded += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return folded;
}

std::string cut(std::string_view line, std::size_t width) {
  if (columns_of(line) <= width) return std::string(line);
  if (width < 4) return std::string(line.substr(0, end_of_columns(line, width)));
  std::string_view head = line.substr(0, end_of_columns(line, width - 3));
  while (head.ends_with(' ')) head.remove_suffix(1);
  return std::string(head) + "...";
}

std::string paragraph(const std::string& words, std::size_t width) {
  std::string lines;
  std::size_t column = 0;
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    if (column > 0 && column + 1 + end - at > width) column = 0, lines += '\n';
    lines += (column == 0 ? "  " : " ") + words.substr(at, end - at);
    column += end - at + (column == 0 ? 2 : 1);
    at = end + 1;
  }
  return lines + '\n';
}

}  // namespace fieldproof::text
