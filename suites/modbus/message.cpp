#include "suites/modbus/message.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "suites/modbus/functions.hpp"

namespace fieldproof::modbus_suite {

std::string digits(ByteView bytes) {
  std::string text;
  for (Byte b : bytes) text += hex_number(b, 2);
  return text;
}

void put_word(Bytes& message, std::size_t value) {
  message.push_back(static_cast<Byte>(value >> 8));
  message.push_back(static_cast<Byte>(value));
}

namespace {

constexpr std::size_t reading_request = 6;  // station, function code, address, count
constexpr std::size_t acknowledgement =
    6;  // of a write: station, function code, address, value or count
constexpr std::size_t exception_reply = 3;

class Reader {
 public:
  Reader(ByteView message, Way way) : message_(message), way_(way) {}

  std::vector<Part> read() {
    take("station", 1);
    if (left() > 0) function();
    if (left() > 0) take("surplus", left(), "there is more than the function code has");
    return std::move(parts_);
  }

 private:
  std::size_t left() const { return message_.size() - at_; }

  /// Takes what is there of a part; what stands in it, or nothing when it is cut short.
  ByteView take(std::string name, std::size_t size, std::string problem = "") {
    const ByteView bytes = message_.subspan(at_, std::min(size, left()));
    if (bytes.empty()) return bytes;
    const bool cut = bytes.size() < size;
    parts_.push_back({std::move(name), at_, bytes.size(), digits(bytes),
                      cut ? "cut short" : std::move(problem)});
    at_ += bytes.size();
    return cut ? ByteView() : bytes;
  }

  void problem(std::string what) {
    if (parts_.back().problem.empty()) parts_.back().problem = std::move(what);
  }

  void function() {
    const Byte code = take("function code", 1).front();
    const bool exception = (code & exception_bit) != 0;
    const FunctionCode* known = find_function(code & ~exception_bit);
    if (!known) {
      problem("not a function code of the manual (9.3.3)");
      return exception ? exception_code() : void(take("data", left()));
    }
    parts_.back().text += fmt::format(" {}{}", exception ? "exception to " : "", known->name);
    if (exception) return exception_code();
    if (!known->write) return read_message(*known);
    known->many ? write_many(*known) : write_one(*known);
  }

  void exception_code() {
    const ByteView code = take("exception code", 1);
    if (code.empty()) return;
    const std::string_view meaning = exception_meaning(code.front());
    if (meaning.empty())
      problem("not a code of 9.2.2");
    else
      parts_.back().text += fmt::format(" {}", meaning);
  }

  void read_message(const FunctionCode& known) {
    if (is_reading_request(known)) {
      note("request");
      take("address", 2);
      return count(known);
    }
    note("reply");
    const ByteView bytes = take("byte count", 1);
    if (bytes.empty()) return;
    if (bytes.front() != left())
      problem(fmt::format("{} bytes of data follow", left()));
    else if (bytes.front() == 0 || (!known.bits && bytes.front() % 2 != 0))
      problem("not a whole number of elements");
    take("data", left());
  }

  /// Where the byte count agrees with the length it is a reply.
  bool is_reading_request(const FunctionCode& known) const {
    if (way_ != Way::unknown) return way_ == Way::request;
    const std::size_t follow = left() > 0 ? left() - 1 : 0;
    if (left() > 0 && message_[at_] != 0 && message_[at_] == follow) return false;
    if (message_.size() != reading_request)
      return message_.size() < reading_request && left() > 0 && message_[at_] == 0;
    const unsigned wanted = word_at(message_, 4);
    const bool nearly = message_[at_] + 1u >= follow &&
                        message_[at_] <= follow + 1;  // a byte count that is off by one
    return (wanted >= 1 && wanted <= known.limit) || !nearly;
  }

  /// A write of one bit or word, and its reply, are the same.
  void write_one(const FunctionCode& known) {
    note(way_ == Way::unknown ? "request or reply" : kind());
    take("address", 2);
    const ByteView value = take("value", 2);
    if (!value.empty() && known.bits && word_at(value, 0) != 0xFF00 && word_at(value, 0) != 0)
      problem("neither FF00 (on) nor 0000 (off)");
  }

  void write_many(const FunctionCode& known) {
    const bool short_one = message_.size() <= acknowledgement;
    note(way_ != Way::unknown ? kind() : short_one ? "reply" : "request");
    take("address", 2);
    count(known);
    const ByteView bytes = take("byte count", 1);
    if (bytes.empty()) return;
    const std::size_t due = known.bits ? (count_ + 7) / 8 : count_ * 2;
    if (bytes.front() != due) problem(fmt::format("{:02X} is right for this count", due));
    if (bytes.front() != left()) problem(fmt::format("{} bytes of data follow", left()));
    take("data", left());
  }

  void count(const FunctionCode& known) {
    const ByteView value = take("count", 2);
    if (value.empty()) return;
    count_ = word_at(value, 0);
    if (count_ == 0 || count_ > known.limit)
      problem(fmt::format("not 1 to {} {}", known.limit, known.bits ? "bits" : "words"));
  }

  std::string_view kind() const { return way_ == Way::request ? "request" : "reply"; }
  void note(std::string_view kind) { parts_.back().text += fmt::format(", {}", kind); }

  ByteView message_;
  Way way_;
  std::size_t at_ = 0;
  std::size_t count_ = 0;
  std::vector<Part> parts_;
};

}  // namespace

std::vector<Part> message_parts(ByteView message, Way way) {
  return message.empty() ? std::vector<Part>() : Reader(message, way).read();
}

std::vector<std::size_t> message_lengths(ByteView bytes) {
  if (bytes.size() < 2) return {};
  if (bytes[1] & exception_bit) return {exception_reply};
  const FunctionCode* known = find_function(bytes[1]);
  if (!known) return {};
  if (known->write && !known->many) return {acknowledgement};
  if (known->write) {
    if (bytes.size() <= acknowledgement) return {acknowledgement};
    return {acknowledgement, acknowledgement + 1u + bytes[6]};
  }
  const bool reply = bytes.size() > 2 && bytes[2] != 0 && (known->bits || bytes[2] % 2 == 0);
  if (!reply) return {reading_request};
  return {3u + bytes[2], reading_request};
}

bool can_be(ByteView message, bool request) {
  const std::vector<std::size_t> lengths = message_lengths(message);
  if (lengths.empty()) return false;
  if (message[1] & exception_bit) return !request;
  const FunctionCode& function = *find_function(message[1]);
  if (function.write && !function.many) return true;
  const bool both =
      lengths.size() >
      1;  // one length alone: of the acknowledgement of a write, or the request of a read
  if (request) return (both || !function.write) && message.size() == lengths.back();
  return (both || function.write) && message.size() == lengths.front();
}

}  // namespace fieldproof::modbus_suite
