#include "harness/notation/notation.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <numeric>
#include <optional>

namespace fieldproof::notation {

namespace {

struct Control {
  std::string_view name;
  Byte value;
};
constexpr std::array controls{Control{"ENQ", 0x05}, Control{"ACK", 0x06}, Control{"NAK", 0x15},
                              Control{"EOT", 0x04}, Control{"ETX", 0x03}, Control{"STX", 0x02},
                              Control{"CR", 0x0D},  Control{"LF", 0x0A}};
constexpr std::string_view words =
    "ENQ ACK NAK EOT ETX STX CR LF, 'text', two hex digits, st, st+1, name(...), seq(n), a check "
    "of the protocol (BCC), ~20ms, ?? x:4 {id:4} (a:..|b:..)";

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Result<Notation> parse() {
    Notation notation = items("");
    if (error_.empty() && depth_ > 0) error_at(text_.size(), "'[' is never closed; add ']'");
    if (!error_.empty()) return fail(error_);
    return notation;
  }

 private:
  bool failed() const { return !error_.empty(); }
  bool at_end() const { return pos_ >= text_.size(); }
  char peek() const { return at_end() ? '\0' : text_[pos_]; }

  void error_at(std::size_t position, std::string_view what) {
    if (error_.empty())
      error_ = fmt::format("cannot read the notation at column {}: {}", position + 1, what);
  }

  void skip_space() {
    while (!at_end() && (peek() == ' ' || peek() == '\t' || peek() == '\n')) ++pos_;
  }

  /// Items up to one of `stops` or the end.
  Notation items(std::string_view stops) {
    Notation result;
    for (skip_space(); !failed() && !at_end() && stops.find(peek()) == std::string_view::npos;
         skip_space()) {
      Item item = one();
      if (failed()) break;
      if (peek() == '*') item.repeat = repetition(item);
      result.push_back(std::move(item));
    }
    return result;
  }

  Item one() {
    switch (peek()) {
      case '[': return bracket(Item::Kind::open, +1);
      case ']': return bracket(Item::Kind::close, -1);
      case '\'': return quoted();
      case '~': return pause();
      case '?': return any();
      case '{': return capture();
      case '(': return alternatives();
      default: return word();
    }
  }

  Item bracket(Item::Kind kind, int step) {
    if ((step > 0) == (depth_ > 0))
      error_at(pos_, step > 0 ? "'[' inside '['; a frame holds no frame" : "']' without '['");
    depth_ += step;
    Item item;
    item.kind = kind;
    item.text = text_[pos_++];
    return item;
  }

  Item quoted() {
    const std::size_t begin = pos_;
    const std::size_t end = text_.find('\'', begin + 1);
    Item item;
    if (end == std::string_view::npos) {
      error_at(begin, "the quote is never closed; add '");
    } else if (end == begin + 1) {
      error_at(begin, "empty quotes; write the characters between them");
    } else {
      item.text = text_.substr(begin, end + 1 - begin);
      item.bytes = to_bytes(text_.substr(begin + 1, end - begin - 1));
      pos_ = end + 1;
    }
    return item;
  }

  Item pause() {
    const std::size_t begin = pos_++;
    Item item;
    item.kind = Item::Kind::pause;
    const auto [rest, error] =
        std::from_chars(text_.data() + pos_, text_.data() + text_.size(), item.pause.amount);
    if (error != std::errc{}) {
      error_at(begin, "a pause is ~20ms, ~1s or ~1.6c");
      return item;
    }
    pos_ = static_cast<std::size_t>(rest - text_.data());
    const std::string_view unit = take_letters();
    if (unit == "c")
      item.pause.characters = true;
    else if (unit == "s")
      item.pause.amount *= 1000;
    else if (unit != "ms")
      error_at(begin, "a pause is ~20ms, ~1s or ~1.6c");
    if (!(item.pause.amount >= 0 && item.pause.amount <= longest_pause))
      error_at(begin, "a pause lasts an hour at most");
    item.text = text_.substr(begin, pos_ - begin);
    return item;
  }

  Item any() {
    Item item;
    item.kind = Item::Kind::any;
    item.text = "??";
    if (text_.substr(pos_, 2) != "??") error_at(pos_, "any byte is written ??");
    pos_ += 2;
    return item;
  }

  Item capture() {
    const std::size_t begin = pos_++;
    Item item;
    item.text = take_name();
    item.kind = Item::Kind::reuse;
    if (peek() == ':') {
      ++pos_;
      item.kind = Item::Kind::capture;
      item.number = take_number();
    }
    if (peek() != '}' || item.text.empty() || (item.kind == Item::Kind::capture && item.number < 1))
      error_at(begin, "a capture is {id:4}, and {id} uses it again");
    ++pos_;
    return item;
  }

  Item alternatives() {
    const std::size_t begin = pos_++;
    Item item;
    item.kind = Item::Kind::alternatives;
    if (++nested_ > most_nested)
      error_at(begin, fmt::format("alternatives stand at most {} deep", most_nested));
    while (!failed()) {
      skip_space();
      Item::Alternative alternative;
      alternative.name = take_name();
      if (alternative.name.empty() || peek() != ':') {
        error_at(begin, "alternatives are (name: ... | name: ...)");
        break;
      }
      ++pos_;
      alternative.items = items("|)");
      item.alternatives.push_back(std::move(alternative));
      if (at_end()) error_at(begin, "'(' is never closed; add ')'");
      if (failed()) break;
      if (text_[pos_++] == ')') break;
    }
    --nested_;
    return item;
  }

  Item word() {
    const std::size_t begin = pos_;
    if (text_.substr(pos_, 2) == "x:") {
      pos_ += 2;
      Item item;
      item.kind = Item::Kind::hex_digits;
      item.number = take_number();
      if (item.number < 1) error_at(begin, "hex digits are written x:4");
      return item;
    }
    const std::string_view letters = take_name();
    if (letters == "name") return name(begin);
    if (letters == "seq") return sequence(begin);
    if (letters == "st") return station();
    Item item;
    item.text = letters;
    for (const Control& control : controls)
      if (letters == control.name) item.bytes = {control.value};
    // Several bytes stand together where they are repeated together: a forgotten quote is noticed.
    const bool together = letters.size() % 2 == 0 && peek() == '*';
    if (item.bytes.empty() && (letters.size() == 2 || together))
      item.bytes = from_hex(letters).value_or(Bytes{});
    if (item.bytes.empty() && may_be_check(letters)) return check(letters);
    if (item.bytes.empty())
      error_at(begin, fmt::format("unknown word '{}'; there are {}",
                                  letters.empty() ? text_.substr(begin, 1) : letters, words));
    return item;
  }

  Item name(std::size_t begin) {
    Item item;
    item.kind = Item::Kind::name;
    const std::size_t end = text_.find(')', pos_);
    if (peek() != '(' || end == std::string_view::npos) {
      error_at(begin, "a name is written name(...), with the device address in the brackets");
      return item;
    }
    item.text = text_.substr(pos_ + 1, end - pos_ - 1);
    if (item.text.size() > 255) error_at(begin, "a name has at most 255 characters");
    pos_ = end + 1;
    return item;
  }

  Item sequence(std::size_t begin) {
    Item item;
    item.kind = Item::Kind::sequence;
    if (peek() == '(') ++pos_;
    item.number = take_number();
    if (item.number < 1 || item.number > 0xFFFF || peek() != ')')
      error_at(begin, "a sequence of words is written seq(60)");
    ++pos_;
    return item;
  }

  Item station() {
    Item item;
    item.kind = Item::Kind::station;
    if (peek() == '+') {
      ++pos_;
      item.number = take_number();
      if (item.number < 0) error_at(pos_, "another station is written st+1");
    }
    return item;
  }

  /// Which checks there are is the protocol's affair (make_templates). One letter away from a
  /// control name is a slip of it.
  static bool may_be_check(std::string_view letters) {
    const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
    const auto is_slip_of = [&](const Control& control) {
      return control.name.size() == letters.size() &&
             std::inner_product(letters.begin(), letters.end(), control.name.begin(), 0,
                                std::plus<>(), std::not_equal_to<>()) == 1;
    };
    return letters.size() >= 3 && std::ranges::all_of(letters, is_capital) &&
           std::ranges::none_of(controls, is_slip_of);
  }

  Item check(std::string_view name) {
    Item item;
    item.kind = Item::Kind::check;
    item.text = name;
    if (depth_ == 0) error_at(pos_, "a check stands inside '[ ]': it covers its own bracket");
    if (peek() == '!') {
      ++pos_;
      item.wrong = true;
    }
    return item;
  }

  int repetition(const Item& item) {
    const std::size_t begin = pos_++;
    const int count = take_number();
    if (count < 1 || count > 100'000) error_at(begin, "a repetition is *n with n from 1 to 100000");
    if (item.kind == Item::Kind::open || item.kind == Item::Kind::close ||
        item.kind == Item::Kind::check)
      error_at(begin, "brackets and checks cannot be repeated");
    return count;
  }

  std::string_view take_while(auto accept) {
    const std::size_t begin = pos_;
    while (!at_end() && accept(peek())) ++pos_;
    return text_.substr(begin, pos_ - begin);
  }
  static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  std::string_view take_letters() { return take_while(is_letter); }
  std::string_view take_name() {
    return take_while([](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
  }

  int take_number() {
    const std::string_view digits = take_while(is_digit);
    int value = -1;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
  }

  std::string_view text_;
  static constexpr int most_nested = 8;
  static constexpr double longest_pause = 3'600'000;
  std::size_t pos_ = 0;
  int depth_ = 0;   // of brackets
  int nested_ = 0;  // alternatives within alternatives
  std::string error_;
};

std::string print_item(const Item& item) {
  switch (item.kind) {
    case Item::Kind::open:
    case Item::Kind::close:
    case Item::Kind::literal:
    case Item::Kind::any:
    case Item::Kind::pause: return item.text;
    case Item::Kind::station: return item.number ? fmt::format("st+{}", item.number) : "st";
    case Item::Kind::name: return fmt::format("name({})", item.text);
    case Item::Kind::sequence: return fmt::format("seq({})", item.number);
    case Item::Kind::check: return fmt::format("{}{}", item.text, item.wrong ? "!" : "");
    case Item::Kind::hex_digits: return fmt::format("x:{}", item.number);
    case Item::Kind::capture: return fmt::format("{{{}:{}}}", item.text, item.number);
    case Item::Kind::reuse: return fmt::format("{{{}}}", item.text);
    case Item::Kind::alternatives: break;
  }
  std::string text = "(";
  for (const Item::Alternative& alternative : item.alternatives)
    text += fmt::format("{}{}:{}", text.size() > 1 ? "|" : "", alternative.name,
                        print(alternative.items));
  return text + ")";
}

std::string_view control_name(Byte value) {
  for (const Control& control : controls)
    if (control.value == value) return control.name;
  return {};
}

}  // namespace

Duration Pause::at(Duration character_time) const {
  if (characters)
    return Duration(
        static_cast<Duration::rep>(amount * static_cast<double>(character_time.count())));
  return from_ms(amount);
}

Result<Notation> parse_notation(std::string_view text) { return Parser(text).parse(); }

std::string print(const Notation& notation) {
  std::string text;
  bool tight = true;
  for (const Item& item : notation) {
    if (!tight && item.kind != Item::Kind::close) text += ' ';
    text += print_item(item);
    // Several bytes without quotes are a word only with their repetition.
    const bool run =
        item.kind == Item::Kind::literal && item.bytes.size() > 1 && !item.text.starts_with('\'');
    if (item.repeat != 1 || run) text += fmt::format("*{}", item.repeat);
    tight = item.kind == Item::Kind::open;
  }
  return text;
}

namespace {
bool is_quotable(Byte b) { return b >= 0x20 && b < 0x7F && b != '\''; }

/// More than a quarter of the bytes has neither a character nor a name: numbers, not text.
bool is_binary(ByteView bytes) {
  return 4 * std::ranges::count_if(
                 bytes, [](Byte b) { return !is_quotable(b) && control_name(b).empty(); }) >
         std::ssize(bytes);
}
}  // namespace

std::string print_bytes(ByteView bytes) {
  if (is_binary(bytes)) return to_hex(bytes);
  std::string text;
  bool quoted = false;
  const auto separate = [&] {
    if (quoted) text += '\'';
    quoted = false;
    if (!text.empty()) text += ' ';
  };
  for (Byte b : bytes) {
    if (is_quotable(b)) {
      if (!quoted) {
        separate();
        text += '\'';
        quoted = true;
      }
      text += static_cast<char>(b);
      continue;
    }
    separate();
    const std::string_view control = control_name(b);
    text += control.empty() ? hex_number(b, 2) : std::string(control);
  }
  if (quoted) text += '\'';
  return text;
}

}  // namespace fieldproof::notation
