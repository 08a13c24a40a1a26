#include "suites/xgt_cnet/frame_parts.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "src/base/letters.hpp"

namespace fieldproof::xgt_cnet_suite {

using checks::header_name, checks::is_header, checks::printable;

namespace {

bool is_lower(Byte b) { return b >= 'a' && b <= 'z'; }

/// Cnet EN and KO Appendix 3.1.
constexpr std::array<std::pair<std::string_view, std::string_view>, 13> errors{{
    {"0003", "more than 16 blocks"},
    {"0004", "name longer than 16 characters"},
    {"0007", "data type other than X, B, W, D, L"},
    {"0011", "data error"},
    {"0090", "execution of a monitor that is not registered"},
    {"0190", "registration number out of range (execution)"},
    {"0290", "registration number out of range (registration)"},
    {"1132", "device memory: no such area, or not writable"},
    {"1232", "more than 60 words"},
    {"1234", "surplus in the frame"},
    {"1332", "blocks of different data types"},
    {"1432", "data not hex"},
    {"7132", "address beyond the area"},
}};

class Reader {
 public:
  explicit Reader(ByteView frame) : frame_(frame) {
    if (frame.empty()) return;
    const Byte tail = frame[0] == enq ? eot : etx;
    const auto found = std::ranges::find(frame, tail);
    tail_ = static_cast<std::size_t>(found - frame.begin());
  }

  std::vector<harness::Field> read() {
    if (frame_.empty()) return {};
    field("header", 1, std::string(header_name(frame_[0])),
          is_header(frame_[0]) ? "" : "a frame begins with ENQ, ACK or NAK");
    if (!is_header(frame_[0])) {
      take("foreign bytes", frame_.size() - 1);
      fields_.back().problem = "no part of a frame";
      return std::move(fields_);
    }
    hex("station", 2);
    const char command = at(pos_);
    take("command", 1);
    const char main =
        is_lower(static_cast<Byte>(command)) ? static_cast<char>(command - 'a' + 'A') : command;
    if (main == 'X' || main == 'Y')
      hex("registration number", 2);
    else
      command_type();
    body(main);
    if (pos_ < tail_) take("surplus", tail_ - pos_);
    tail_and_check(is_lower(static_cast<Byte>(command)));
    if (fields_.back().problem.empty())
      fields_.back().problem = missing(is_lower(static_cast<Byte>(command)));
    return std::move(fields_);
  }

 private:
  char at(std::size_t i) const { return i < frame_.size() ? static_cast<char>(frame_[i]) : '\0'; }
  std::size_t left() const { return tail_ > pos_ ? tail_ - pos_ : 0; }

  void field(std::string name, std::size_t size, std::string text, std::string problem = "") {
    fields_.push_back({std::move(name), pos_, size, std::move(text), std::move(problem)});
    pos_ += size;
  }

  ByteView take(std::string name, std::size_t size) {
    const std::size_t has = std::min(size, frame_.size() > pos_ ? frame_.size() - pos_ : 0);
    const ByteView bytes = frame_.subspan(std::min(pos_, frame_.size()), has);
    if (has > 0) field(std::move(name), has, printable(bytes), has < size ? "cut short" : "");
    return bytes;
  }

  /// A field of hex digits inside the frame; its value, or nothing.
  std::optional<unsigned> hex(std::string name, std::size_t size) {
    const std::size_t has = std::min(size, left());
    const ByteView digits = take(std::move(name), has);
    if (digits.empty()) return std::nullopt;
    unsigned value = 0;
    for (Byte b : digits) {
      const int digit = hex_digit(static_cast<char>(b));
      if (digit < 0) fields_.back().problem = "not hex";
      if (digit < 0) return std::nullopt;
      value = value << 4 | static_cast<unsigned>(digit);
    }
    if (has < size) fields_.back().problem = "cut short";
    return has < size ? std::nullopt : std::optional(value);
  }

  void command_type() {
    take("command type", 2);
    if (const std::string type = upper(fields_.back().text); type != "SS" && type != "SB")
      fields_.back().problem = "not SS or SB";
  }

  void body(char main) {
    if (frame_[0] == nak) return error_code();
    const std::string type =
        fields_.back().name == "command type" ? upper(fields_.back().text) : "";
    if (frame_[0] == enq)
      request(main, type);
    else
      reply(main, type);
  }

  void error_code() {
    if (left() == 0) return;
    const ByteView code = take("error code", std::min<std::size_t>(4, left()));
    const std::string text = printable(code);
    const std::string_view meaning = error_meaning(text);
    if (!meaning.empty())
      fields_.back().text = fmt::format("{} {}", text, meaning);
    else
      fields_.back().problem = "not a code of Appendix 3.1";
  }

  void request(char main, const std::string& type) {
    if (main == 'X') {
      const ByteView format = take("registration format", std::min<std::size_t>(3, left()));
      return request('R', upper(printable(format)).substr(std::min<std::size_t>(1, format.size())));
    }
    if (main == 'Y') return;
    if (type == "SS") return blocks(main == 'W');
    if (type != "SB") return;
    const std::string name = device_name("");
    const std::optional<unsigned> count = hex("number of data", 2);
    if (main == 'W' && count && left() > 0) take("data", left());
    (void)name;
  }

  void blocks(bool with_data) {
    const unsigned count = hex("block count", 2).value_or(0);
    for (unsigned i = 1; i <= count && left() > 0; ++i) {
      const std::string number = count > 1 ? fmt::format(" {}", i) : "";
      const std::string name = device_name(number);
      if (with_data && left() > 0) take("data" + number, std::min(left(), data_digits(name)));
    }
  }

  std::string device_name(const std::string& number) {
    const std::optional<unsigned> length = hex("name length" + number, 2);
    if (!length || left() == 0) return {};
    const ByteView name = take("name" + number, std::min<std::size_t>(*length, left()));
    if (name.size() < *length)
      fields_.back().problem = fmt::format("cut short: {} of {} characters", name.size(), *length);
    return printable(name);
  }

  static std::size_t data_digits(const std::string& name) {
    switch (name.size() > 2 ? std::toupper(name[2]) : 0) {
      case 'W': return 4;
      case 'D': return 8;
      case 'L': return 16;
      default: return 2;
    }
  }

  void reply(char main, const std::string& type) {
    if (left() == 0 || main == 'W' || main == 'X') return;
    // The reply to Y of a continuous registration is printed without a block count (Cnet EN 7.1.5
    // (6)(c)2).
    if (main == 'Y' && count_fits_at(pos_)) return data_block("");
    const unsigned count = hex("block count", 2).value_or(0);
    for (unsigned i = 1; i <= count && left() > 0; ++i)
      data_block(count > 1 && type != "SB" ? fmt::format(" {}", i) : "");
  }

  /// Does a number of data at `pos` account for all that is left?
  bool count_fits_at(std::size_t pos) const {
    const int high = hex_digit(at(pos)), low = hex_digit(at(pos + 1));
    return high >= 0 && low >= 0 && static_cast<std::size_t>(high * 16 + low) * 2 + 2 == left();
  }

  void data_block(const std::string& number) {
    const std::optional<unsigned> bytes = hex("number of data" + number, 2);
    if (bytes && left() > 0) take("data" + number, std::min<std::size_t>(*bytes * 2, left()));
  }

  void tail_and_check(bool with_bcc) {
    if (pos_ >= frame_.size()) return;
    if (tail_ < frame_.size()) field("tail", 1, frame_[0] == enq ? "EOT" : "ETX");
    const std::size_t rest = frame_.size() - std::min(pos_, frame_.size());
    if (rest == 0) return;
    if (!with_bcc) {
      take("surplus", rest);
      fields_.back().problem = rest == 2 ? "a BCC after an upper-case command, which has none"
                                         : "nothing follows the tail";
      return;
    }
    const std::size_t end = pos_;
    const std::string bcc = printable(take("BCC", std::min<std::size_t>(2, rest)));
    fields_.back().problem = bcc_problem(bcc, end);
    if (pos_ < frame_.size()) take("surplus", frame_.size() - pos_);
  }

  /// What must follow the last byte.
  std::string missing(bool with_bcc) const {
    const char* tail = frame_[0] == enq ? "EOT" : "ETX";
    if (tail_ >= frame_.size())
      return fmt::format("no {}{} follow{}", tail, with_bcc ? " and no BCC" : "",
                         with_bcc ? "" : "s");
    return with_bcc && tail_ + 1 == frame_.size() ? "no BCC follows" : "";
  }

  std::string bcc_problem(const std::string& bcc, std::size_t end) const {
    const unsigned sum =
        std::accumulate(frame_.begin(), frame_.begin() + static_cast<std::ptrdiff_t>(end), 0u);
    const auto digits = [](unsigned value) { return hex_number(value & 0xFF, 2); };
    if (bcc == digits(sum)) return {};
    if (upper(bcc) == digits(sum)) return "lower-case hex";
    std::string hint;
    if (bcc == digits(sum - frame_[end - 1])) hint = "; this one leaves the tail out";
    if (bcc == digits(sum - frame_[0])) hint = "; this one leaves the header out";
    if (bcc == digits(sum - frame_[0] - frame_[end - 1]))
      hint = "; this one leaves header and tail out";
    return fmt::format("{} is right: low byte of the sum {:04X} from header to tail{}", digits(sum),
                       sum, hint);
  }

  ByteView frame_;
  std::size_t pos_ = 0;
  std::size_t tail_ = 0;
  std::vector<harness::Field> fields_;
};

}  // namespace

std::string_view error_meaning(std::string_view code) {
  const auto found =
      std::ranges::find(errors, code, &std::pair<std::string_view, std::string_view>::first);
  return found == errors.end() ? std::string_view() : found->second;
}

std::optional<std::size_t> frame_length(ByteView bytes) {
  if (bytes.empty()) return std::nullopt;
  const auto next_header = std::ranges::find_if(bytes.subspan(1), is_header);
  const auto header_at = static_cast<std::size_t>(next_header - bytes.subspan(1).begin()) + 1;
  const bool another = next_header != bytes.subspan(1).end();
  if (!is_header(bytes[0])) return another ? std::optional(header_at) : std::nullopt;
  const auto tail = static_cast<std::size_t>(std::ranges::find(bytes, bytes[0] == enq ? eot : etx) -
                                             bytes.begin());
  if (another && header_at < tail) return header_at;
  if (tail == bytes.size()) return std::nullopt;
  const bool with_bcc = bytes.size() > 3 && tail > 3 && is_lower(bytes[3]);
  if (!with_bcc) return tail + 1;
  if (another && header_at < tail + 3) return header_at;  // the BCC is missing
  return tail + 3 <= bytes.size() ? std::optional(tail + 3) : std::nullopt;
}

Bytes in_plain_letters(ByteView request) {
  constexpr std::size_t command = 3, check = 2;
  Bytes plain(request.begin(), request.end());
  if (plain.size() <= command + check || plain[0] != enq) return plain;
  const auto bcc = [&](std::size_t size) {
    const auto end = plain.begin() + static_cast<std::ptrdiff_t>(size);
    return to_bytes(hex_number(std::accumulate(plain.begin(), end, 0u) & 0xFF, 2));
  };
  const auto raise = [](Bytes& bytes, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      bytes[i] = static_cast<Byte>(upper(static_cast<char>(bytes[i])));
  };
  const bool checked = is_lower(plain[command]);
  const std::size_t body = plain.size() - (checked ? check : 0);
  if (checked) {
    raise(plain, body, plain.size());
    if (!std::ranges::equal(ByteView(plain).subspan(body), bcc(body)))
      return {request.begin(), request.end()};
  }
  raise(plain, 1, command);
  raise(plain, command + 1, body);
  if (checked) std::ranges::copy(bcc(body), plain.begin() + static_cast<std::ptrdiff_t>(body));
  return plain;
}

std::vector<harness::Field> explain(ByteView frame) { return Reader(frame).read(); }

}  // namespace fieldproof::xgt_cnet_suite
