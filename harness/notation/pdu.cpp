#include "harness/notation/pdu.hpp"

#include <fmt/format.h>

#include <functional>
#include <optional>

#include "harness/notation/notation.hpp"

namespace fieldproof::notation {

namespace {

/// pdu@02!(...) as it stands in a text.
struct Pdu {
  std::size_t begin = 0, end = 0;
  std::string_view station = "st";
  bool wrong = false;
  std::string_view body;
};

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Behind the ')' that closes the '(' at `at`; nothing where none does.
std::optional<std::size_t> behind_parenthesis(std::string_view text, std::size_t at) {
  int depth = 0;
  for (bool quoted = false; at < text.size(); ++at) {
    if (text[at] == '\'') quoted = !quoted;
    if (quoted) continue;
    if (text[at] == '(') ++depth;
    if (text[at] == ')' && --depth == 0) return at + 1;
  }
  return std::nullopt;
}

/// Where the next pdu( pdu@ pdu! stands from `from` on, outside quotes; npos where none does.
std::size_t find_word(std::string_view text, std::size_t from) {
  bool quoted = false;
  for (std::size_t at = from; at < text.size(); ++at) {
    if (text[at] == '\'') quoted = !quoted;
    if (quoted || text.substr(at, 3) != "pdu" || (at > 0 && is_letter_or_digit(text[at - 1])))
      continue;
    const char next = at + 3 < text.size() ? text[at + 3] : '\0';
    if (next == '(' || next == '@' || next == '!') return at;
  }
  return std::string_view::npos;
}

Result<Pdu> read_pdu(std::string_view text, std::size_t begin) {
  constexpr std::string_view form = "a shared body is pdu(03 00), pdu@02(03 00) or pdu!(03 00)";
  Pdu pdu;
  pdu.begin = begin;
  std::size_t at = begin + 3;
  if (at < text.size() && text[at] == '@') {
    const std::size_t end = text.find_first_of("!(", at);
    if (end == text.npos || end == at + 1) return fail(fmt::format("{}; column {}", form, at + 1));
    pdu.station = text.substr(at + 1, end - at - 1);
    at = end;
  }
  if (at < text.size() && text[at] == '!') pdu.wrong = true, ++at;
  if (at >= text.size() || text[at] != '(') return fail(fmt::format("{}; column {}", form, at + 1));
  const std::optional<std::size_t> end = behind_parenthesis(text, at);
  if (!end)
    return fail(fmt::format("the parenthesis at column {} is never closed; add ')'", at + 1));
  pdu.body = text.substr(at + 1, *end - at - 2);
  pdu.end = *end;
  return pdu;
}

class Speller {
 public:
  explicit Speller(bool digits) : digits_(digits) {}

  Result<Notation> spell(const Notation& body) const {
    Notation result;
    for (const Item& item : body) {
      Result<Item> spelled = one(item);
      if (!spelled) return spelled.error();
      if (!join(result, *spelled)) result.push_back(std::move(*spelled));
    }
    return result;
  }

 private:
  /// Digits that follow each other are one text.
  bool join(Notation& result, const Item& item) const {
    if (!digits_ || result.empty()) return false;
    Item& last = result.back();
    for (const Item& one : {std::cref(last), std::cref(item)})
      if (one.kind != Item::Kind::literal || one.repeat != 1) return false;
    last.bytes.insert(last.bytes.end(), item.bytes.begin(), item.bytes.end());
    last.text = quoted_hex(last.bytes);
    return true;
  }

  Result<Item> one(Item item) const {
    switch (item.kind) {
      case Item::Kind::literal:
        if (digits_) item.text = quoted_hex(item.bytes);
        return item;
      case Item::Kind::sequence: return sequence(item);
      case Item::Kind::any:
        if (digits_) hex_digits(item, 2 * item.repeat);
        return item;
      case Item::Kind::hex_digits: return wildcard(item);
      case Item::Kind::capture:
        if (digits_) item.number *= 2;
        return item;
      case Item::Kind::alternatives: return alternatives(std::move(item));
      case Item::Kind::reuse:
      case Item::Kind::station:
      case Item::Kind::pause: return item;
      case Item::Kind::name:
        if (!digits_) return item;
        break;
      case Item::Kind::open:
      case Item::Kind::close:
      case Item::Kind::check: break;
    }
    return fail(fmt::format("'{}' cannot stand in pdu(...): brackets and checks are of the frame",
                            print({item})));
  }

  static void hex_digits(Item& item, int count) {
    item.kind = Item::Kind::hex_digits;
    item.number = count;
    item.repeat = 1;
  }

  Result<Item> wildcard(Item item) const {
    if (item.number % 2)
      return fail(fmt::format("x:{} is half a byte too long for pdu(...): two digits are a byte",
                              item.number));
    const int bytes = item.number / 2 * item.repeat;
    if (digits_) {
      hex_digits(item, 2 * bytes);
    } else {
      item.kind = Item::Kind::any;
      item.text = "??";
      item.repeat = bytes;
    }
    return item;
  }

  Item sequence(Item item) const {
    if (digits_) return item;
    Bytes spelled;
    for (int word = 1; word <= item.number; ++word) {
      spelled.push_back(static_cast<Byte>(word >> 8));
      spelled.push_back(static_cast<Byte>(word));
    }
    item.kind = Item::Kind::literal;
    item.text = to_hex(spelled);
    if (item.repeat > 1) std::erase(item.text, ' ');
    return item;
  }

  Result<Item> alternatives(Item item) const {
    for (Item::Alternative& alternative : item.alternatives) {
      Result<Notation> spelled = spell(alternative.items);
      if (!spelled) return spelled.error();
      alternative.items = std::move(*spelled);
    }
    return item;
  }

  static std::string quoted_hex(ByteView bytes) {
    std::string text = "'";
    for (const Byte byte : bytes) text += hex_number(byte, 2);
    return text + "'";
  }

  bool digits_;
};

/// Notation of a station or a body in the dress of the frame.
Result<std::string> spell(std::string_view text, bool digits) {
  const Result<Notation> plain = parse_notation(text);
  if (!plain) return plain.error();
  const Result<Notation> spelled = Speller(digits).spell(*plain);
  if (!spelled) return spelled.error();
  return print(*spelled);
}

/// The frame with its places filled.
Result<std::string> fill(const Dressing& dressing, const Pdu& pdu,
                         const std::function<Result<std::string>()>& transaction) {
  const std::string_view frame = dressing.frame;
  if (pdu.wrong && frame.find("${wrong}") == frame.npos)
    return fail("pdu!(...): frames of this protocol have no check that could be wrong");
  std::string text;
  for (std::size_t at = 0; at < frame.size();) {
    const std::size_t place = std::min(frame.find("${", at), frame.size());
    text += frame.substr(at, place - at);
    if (place == frame.size()) break;
    const std::size_t end = frame.find('}', place);
    const std::string_view key = frame.substr(place + 2, end - place - 2);
    at = end + 1;
    if (key == "wrong") {
      if (pdu.wrong) text += '!';
      continue;
    }
    const Result<std::string> value = key == "station" ? spell(pdu.station, dressing.digits)
                                      : key == "body"  ? spell(pdu.body, dressing.digits)
                                                       : transaction();
    if (!value) return value.error();
    text += *value;
  }
  return text;
}

}  // namespace

bool has_pdu(std::string_view text) { return find_word(text, 0) != text.npos; }

Result<std::string> dress(std::string_view text, const Dressing& dressing,
                          const std::function<Result<std::string>()>& transaction) {
  std::string result;
  std::size_t from = 0;
  for (std::size_t at; (at = find_word(text, from)) != text.npos;) {
    const Result<Pdu> pdu = read_pdu(text, at);
    if (!pdu) return pdu.error();
    const Result<std::string> frame = fill(dressing, *pdu, transaction);
    if (!frame) return frame.error();
    result.append(text.substr(from, at - from)).append(*frame);
    from = pdu->end;
  }
  return result.append(text.substr(from));
}

}  // namespace fieldproof::notation
