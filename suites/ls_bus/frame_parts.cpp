#include "suites/ls_bus/frame_parts.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "src/base/letters.hpp"

namespace fieldproof::ls_bus_suite {

using checks::header_name, checks::is_header, checks::printable;

namespace {

constexpr std::size_t head_size = 4, sum_size = 2;  // header, station and command

constexpr std::array<std::pair<std::string_view, std::string_view>, 5> errors{{
    {"FE", "frame: the sum is wrong"},
    {"IA", "no such address"},
    {"ID", "bad data"},
    {"IF", "no such function"},
    {"WM", "not writable"},
}};

bool is_hex(ByteView bytes) {
  return std::ranges::all_of(bytes, [](Byte b) { return hex_digit(static_cast<char>(b)) >= 0; });
}

class Reader {
 public:
  explicit Reader(ByteView frame) : frame_(frame) {
    end_ = content_end_ = frame.size();
    if (frame.empty() || !is_header(frame[0])) return;
    end_ = static_cast<std::size_t>(std::ranges::find(frame, eot) - frame.begin());
    content_end_ = end_ == frame.size() || end_ < head_size + sum_size ? end_ : end_ - sum_size;
  }

  std::vector<harness::Field> read() {
    if (frame_.empty()) return {};
    const bool headed = is_header(frame_[0]);
    add("header", 1, std::string(header_name(frame_[0])),
        headed ? "" : "a frame begins with ENQ, ACK or NAK");
    if (!headed) {
      take("foreign bytes", frame_.size() - 1);
      return std::move(fields_);
    }
    hex("station", 2);
    const ByteView command = take("command", 1);
    if (!command.empty() && command[0] != 'R' && command[0] != 'W')
      fields_.back().problem = "neither R nor W";
    content(command.empty() ? '\0' : static_cast<char>(command[0]));
    if (left() > 0) {
      take("surplus", left());
      fields_.back().problem = "nothing stands here";
    }
    sum();
    if (end_ < frame_.size())
      add("tail", 1, "EOT");
    else if (fields_.back().problem.empty())
      fields_.back().problem = "no EOT follows, with the sum before it";
    if (pos_ < frame_.size())
      add("surplus", frame_.size() - pos_, printable(frame_.subspan(pos_)), "nothing follows EOT");
    return std::move(fields_);
  }

 private:
  std::size_t left() const { return content_end_ > pos_ ? content_end_ - pos_ : 0; }

  void add(std::string name, std::size_t size, std::string text, std::string problem = "") {
    fields_.push_back({std::move(name), pos_, size, std::move(text), std::move(problem)});
    pos_ += size;
  }

  /// Up to `size` bytes of the content; no field where there are none.
  ByteView take(std::string name, std::size_t size) {
    const ByteView bytes = frame_.subspan(pos_, std::min(size, left()));
    if (!bytes.empty())
      add(std::move(name), bytes.size(), printable(bytes), bytes.size() < size ? "cut short" : "");
    return bytes;
  }

  ByteView hex(std::string name, std::size_t size) {
    const ByteView digits = take(std::move(name), size);
    if (!digits.empty() && !is_hex(digits)) fields_.back().problem = "not hex";
    return digits;
  }

  void content(char command) {
    if (frame_[0] == nak) return error_code();
    if (frame_[0] == ack) return words(left());
    if (command == 'W' || command == 'w') return write();
    hex("address", digits_of_a_word);
    count();
  }

  void write() {
    const std::vector<WriteReading> readings = write_readings(frame_);
    const auto reading = std::ranges::find(readings, true, &WriteReading::adds_up);
    const bool count_first = reading != readings.end() && reading->count_first;
    if (count_first) {
      count();
      fields_.back().text += " (count first)";
    }
    hex("address", digits_of_a_word);
    if (!count_first) count();
    words(digits_of_a_word * count_);
  }

  void count() {
    const ByteView digit = hex("count", 1);
    if (digit.empty() || !fields_.back().problem.empty()) return;
    count_ = static_cast<unsigned>(hex_digit(static_cast<char>(digit[0])));
    if (count_ == 0 || count_ > max_words) fields_.back().problem = "not 1 to 8";
  }

  /// `digits` of data, a field a word. The count of a request says how many there are, whatever is
  /// there.
  void words(std::size_t digits) {
    const bool several = digits > digits_of_a_word;
    for (unsigned i = 1; digits > 0 && left() > 0; ++i) {
      hex(several ? fmt::format("data {}", i) : "data", digits_of_a_word);
      digits -= std::min(digits, digits_of_a_word);
    }
    if (digits > 0 && !fields_.empty() && fields_.back().problem.empty())
      fields_.back().problem = "words are missing behind it";
  }

  void error_code() {
    if (left() == 0) return;
    const std::string code = printable(take("error code", left()));
    const std::string_view meaning = error_meaning(code);
    if (!meaning.empty())
      fields_.back().text = fmt::format("{} {}", code, meaning);
    else if (code.size() != 2)
      fields_.back().problem = "an error code has two characters";
  }

  void sum() {
    if (content_end_ == end_) return;
    pos_ = content_end_;
    const std::string given = printable(frame_.subspan(pos_, end_ - pos_));
    add("SUM", end_ - pos_, given, sum_problem(given));
  }

  std::string sum_problem(const std::string& given) const {
    const auto begin = frame_.begin(), end = begin + static_cast<std::ptrdiff_t>(content_end_);
    const unsigned right = std::accumulate(begin + 1, end, 0u);
    const auto digits = [](unsigned value) { return hex_number(value & 0xFF, 2); };
    if (given == digits(right)) return {};
    if (upper(given) == digits(right)) return "lower-case hex";
    std::string hint;
    if (given == digits(right + frame_[0])) hint = "; this one takes the header in";
    if (given == digits(right + frame_[0] + eot)) hint = "; this one takes header and tail in";
    return fmt::format("{} is right: low byte of the sum {:04X} between header and sum{}",
                       digits(right), right, hint);
  }

  ByteView frame_;
  std::size_t pos_ = 0;
  std::size_t end_ = 0;          // of what stands before EOT
  std::size_t content_end_ = 0;  // of what stands before the sum
  unsigned count_ = 0;
  std::vector<harness::Field> fields_;
};

}  // namespace

Bytes in_plain_letters(ByteView request) {
  constexpr std::size_t command = 3, behind = sum_size + 1;  // sum and EOT
  Bytes plain(request.begin(), request.end());
  if (plain.size() < head_size + behind || plain[0] != enq || plain.back() != eot) return plain;
  const auto sum_at = static_cast<std::ptrdiff_t>(plain.size() - behind);
  const auto sum = [&] {
    return to_bytes(
        hex_number(std::accumulate(plain.begin() + 1, plain.begin() + sum_at, 0u) & 0xFF, 2));
  };
  const auto raise = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    for (std::ptrdiff_t i = from; i < to; ++i) {
      Byte& b = plain[static_cast<std::size_t>(i)];
      b = static_cast<Byte>(upper(static_cast<char>(b)));
    }
  };
  raise(sum_at, sum_at + static_cast<std::ptrdiff_t>(sum_size));
  if (!std::ranges::equal(ByteView(plain).subspan(plain.size() - behind, sum_size), sum()))
    return {request.begin(), request.end()};
  raise(1, command);
  raise(command + 1, sum_at);
  std::ranges::copy(sum(), plain.begin() + sum_at);
  return plain;
}

std::string_view error_meaning(std::string_view code) {
  const auto found =
      std::ranges::find(errors, code, &std::pair<std::string_view, std::string_view>::first);
  return found == errors.end() ? std::string_view() : found->second;
}

std::optional<std::size_t> frame_length(ByteView bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i > 0 && is_header(bytes[i])) return i;
    if (bytes[i] == eot && is_header(bytes[0])) return i + 1;
  }
  return std::nullopt;
}

std::vector<WriteReading> write_readings(ByteView frame) {
  constexpr std::size_t address_and_count = digits_of_a_word + 1;
  const auto end = static_cast<std::size_t>(std::ranges::find(frame, eot) - frame.begin());
  const std::size_t behind = end < frame.size() ? sum_size : 0;
  if (end < head_size + address_and_count + behind) return {};
  const ByteView content = frame.subspan(head_size, end - head_size - behind);
  const std::size_t data_digits = content.size() - address_and_count;
  std::vector<WriteReading> readings;
  for (const bool count_first : {false, true}) {
    const ByteView address = content.subspan(count_first ? 1 : 0, digits_of_a_word);
    if (!is_hex(address)) continue;
    const auto count = static_cast<unsigned>(
        std::max(0, hex_digit(static_cast<char>(content[count_first ? 0 : digits_of_a_word]))));
    const auto words =
        static_cast<unsigned>((data_digits + digits_of_a_word - 1) / digits_of_a_word);
    readings.push_back({to_text(address), std::max({count, words, 1u}), count_first,
                        count * digits_of_a_word == data_digits});
  }
  return readings;
}

std::vector<harness::Field> explain(ByteView frame) { return Reader(frame).read(); }

}  // namespace fieldproof::ls_bus_suite
