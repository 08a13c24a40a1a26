#include "suites/xgt_fenet/frame_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "suites/checks/control_bytes.hpp"

namespace fieldproof::xgt_fenet_suite {

using harness::Field;

namespace {

constexpr std::array<std::pair<unsigned, std::string_view>, 14> errors{
    {{0x01, "number of blocks"},
     {0x02, "type letter of a name"},
     {0x03, "area not there, or not writable"},
     {0x04, "past the end of the area"},
     {0x05, "size or number of data"},
     {0x06, "too much data in all"},
     {0x10, "device"},
     {0x11, "form or length of a name"},
     {0x12, "continuous with anything but bytes"},
     {0x24, "data type"},
     {0x75, "company id"},
     {0x76, "length of the body"},
     {0x77, "check sum of the header"},
     {0x78, "command"}}};

std::string digits(ByteView bytes) {
  std::string text;
  for (const Byte b : bytes) text += hex_number(b, 2);
  return text;
}

std::string_view letter_of(unsigned type) {
  constexpr std::array<std::string_view, 5> letters{"bit", "byte", "word", "dword", "lword"};
  return type < letters.size() ? letters[type] : type == continuous_type ? "continuous" : "";
}

unsigned size_of(unsigned type) {
  constexpr std::array<unsigned, 5> sizes{1, 1, 2, 4, 8};
  return type < sizes.size() ? sizes[type] : 0;
}

class Reader {
 public:
  explicit Reader(ByteView frame) : frame_(frame) {}

  std::vector<Field> read() {
    header();
    if (left() > 0) body();
    if (left() > 0) {
      take("surplus", left());
      problem("follows a complete body");
    }
    if (fields_.empty() || !fields_.back().problem.empty()) return std::move(fields_);
    if (frame_.size() < header_size)
      problem("the frame ends here: a header has 20 bytes");
    else if (!complete_)
      problem("the frame ends here");
    return std::move(fields_);
  }

 private:
  std::size_t left() const { return frame_.size() - pos_; }
  void problem(std::string what) {
    if (fields_.back().problem.empty()) fields_.back().problem = std::move(what);
  }

  ByteView take(std::string name, std::size_t size) {
    const ByteView bytes = frame_.subspan(pos_, std::min(size, left()));
    if (bytes.empty()) return bytes;
    fields_.push_back({std::move(name), pos_, bytes.size(), digits(bytes), ""});
    if (bytes.size() < size) problem("cut short");
    pos_ += bytes.size();
    return bytes;
  }
  std::optional<Byte> byte(std::string name) {
    const ByteView bytes = take(std::move(name), 1);
    return bytes.empty() ? std::nullopt : std::optional(bytes[0]);
  }
  std::optional<unsigned> word(std::string name) {
    const ByteView bytes = take(std::move(name), 2);
    return bytes.size() < 2 ? std::nullopt : std::optional(word_at(bytes, 0));
  }

  void header() {
    const ByteView company = take("company id", 10);
    if (company.empty()) return;
    fields_.back().text = checks::printable(company);
    const std::string text = to_text(company);
    if (text != std::string("LSIS-XGT\0\0", 10) && text != "LGIS-GLOFA")
      problem("LSIS-XGT and two zeros, or LGIS-GLOFA");
    plc_info();
    take("CPU info", 1);
    if (const std::optional<Byte> source = byte("source")) {
      from_server_ = *source == 0x11;
      fields_.back().text += *source == 0x33 ? " client" : from_server_ ? " server" : "";
      if (*source != 0x33 && *source != 0x11) problem("33 is a client, 11 a server");
    }
    if (const auto invoke = word("invoke id")) fields_.back().text += fmt::format(" ({})", *invoke);
    length();
    if (const auto position = byte("position"))
      fields_.back().text += fmt::format(" base {}, slot {}", *position >> 4, *position & 15);
    check();
  }

  void plc_info() {
    const std::optional<unsigned> info = word("PLC info");
    if (!info || *info == 0) return;
    constexpr std::array<std::string_view, 9> states{"", "RUN", "STOP", "",     "ERROR",
                                                     "", "",    "",     "DEBUG"};
    const unsigned state = *info >> 8 & 0x1F;
    fields_.back().text += fmt::format(" CPU type {:02X}", *info & 0x3F);
    if (*info & 0x40) fields_.back().text += ", slave";
    if (*info & 0x80) fields_.back().text += ", CPU error";
    if (state < states.size() && !states[state].empty())
      fields_.back().text += fmt::format(", {}", states[state]);
  }

  void length() {
    const std::optional<unsigned> length = word("length");
    if (!length) return;
    fields_.back().text += fmt::format(" ({} bytes)", *length);
    const std::size_t body = frame_.size() - std::min(frame_.size(), header_size);
    if (*length != body && frame_.size() >= header_size)
      problem(fmt::format("{:02X}{:02X} is right: {} bytes follow the header", body & 0xFF,
                          body >> 8 & 0xFF, body));
  }

  void check() {
    const std::optional<Byte> check = byte("check sum");
    if (!check) return;
    const ByteView covered = frame_.first(check_at);
    const auto right = static_cast<Byte>(std::accumulate(covered.begin(), covered.end(), 0u));
    if (*check == 0 && right != 0)  // "h00 : Reserved area", Table 5-3
      fields_.back().text += " none";
    else if (*check != right)
      problem(fmt::format("{:02X} is right: the sum of the 19 bytes before it", right));
  }

  void body() {
    const std::optional<unsigned> command = word("command");
    if (!command) return;
    const unsigned main = *command & ~1u;
    const bool known = main == read_command || main == write_command;
    const bool reply = known && (*command & 1);
    // The command 5300 is none, and its refusal has the next one, which is that of a request.
    if (known && !reply && is_refusal()) return unknown();
    if (!known) return problem("5400 reads, 5800 writes; 5500 and 5900 answer"), unknown();
    fields_.back().text +=
        fmt::format(" {}{}", main == read_command ? "read" : "write", reply ? " reply" : "");
    if (reply != from_server_)
      problem(reply ? "a reply comes from a server" : "a request comes from a client");
    const std::optional<unsigned> type = word("data type");
    if (!type) return;
    if (letter_of(*type).empty())
      problem("0000 bit, 0100 byte, 0200 word, 0300 dword, 0400 lword, 1400 continuous");
    else
      fields_.back().text += fmt::format(" {}", letter_of(*type));
    if (!word("reserved")) return;
    if (reply) return reply_body(main == write_command, *type);
    request_body(main == write_command, *type);
  }

  /// What follows a command is that of a refusal: data type, reserved word, status FFFF, code.
  bool is_refusal() const {
    return from_server_ && left() == 8 && word_at(frame_, pos_ + 4) == 0xFFFF;
  }

  /// A refusal to a command that is none has the form of any other.
  void unknown() {
    if (from_server_ && left() == 8) {
      word("data type");
      word("reserved");
      reply_body(false, 0);
    } else {
      complete_ = true;
    }
  }

  void reply_body(bool write, unsigned type) {
    const std::optional<unsigned> status = word("status");
    if (!status) return;
    if (*status != 0) return error_code();
    const std::optional<unsigned> blocks = block_count(type);
    if (!blocks) return;
    complete_ = write || each(*blocks, [&](unsigned i) { return data(i, write, type); });
  }

  void error_code() {
    const std::optional<unsigned> code = word("error code");
    if (!code) return;
    complete_ = true;
    for (const auto& [number, meaning] : errors)
      if (number == *code) fields_.back().text += fmt::format(" {}", meaning);
  }

  void request_body(bool write, unsigned type) {
    const std::optional<unsigned> blocks = block_count(type);
    if (!blocks || !each(*blocks, [&](unsigned i) { return name(i); })) return;
    if (write)
      complete_ = each(*blocks, [&](unsigned i) { return data(i, write, type); });
    else
      complete_ = type != continuous_type || number_of_data();
  }

  std::optional<unsigned> block_count(unsigned type) {
    const std::optional<unsigned> blocks = word("block count");
    if (!blocks) return std::nullopt;
    const unsigned most = type == continuous_type ? 1 : 16;
    several_ = *blocks > 1;
    if (*blocks == 0 || *blocks > most)
      problem(most == 1 ? "0100 is the one of a continuous request" : "0100 to 1000");
    return blocks;
  }

  /// Up to the end of the frame, whatever the number of blocks is.
  template <typename Part>
  bool each(unsigned blocks, Part part) {
    for (unsigned i = 1; i <= blocks; ++i)
      if (left() == 0 || !part(i)) return false;
    return true;
  }
  std::string numbered(std::string_view name, unsigned i) const {
    return several_ ? fmt::format("{} {}", name, i) : std::string(name);
  }

  bool name(unsigned i) {
    const std::optional<unsigned> length = word(numbered("name length", i));
    if (!length) return false;
    if (*length < 4 || *length > 16) problem("0400 to 1000");
    if (*length == 0) return true;
    const ByteView text = take(numbered(name_field, i), *length);
    if (!text.empty()) fields_.back().text = checks::printable(text);
    return text.size() == *length;
  }

  bool number_of_data() {
    const std::optional<unsigned> count = word(std::string(count_field));
    if (!count) return false;
    fields_.back().text += fmt::format(" ({} bytes)", *count);
    if (*count == 0 || *count > 512) problem("0100 to 0002: 1 to 512 bytes");
    return true;
  }

  bool data(unsigned i, bool write, unsigned type) {
    const std::optional<unsigned> size = word(numbered(size_field, i));
    if (!size) return false;
    const unsigned due = size_of(type);
    if (due != 0 && *size != due) problem(fmt::format("a {} has {} bytes", letter_of(type), due));
    if (due == 0 && (*size == 0 || *size > 512)) problem("0100 to 0002: 1 to 512 bytes");
    if (*size == 0) return true;
    const ByteView bytes = take(numbered(data_field, i), *size);
    if (write && type == 0 && !bytes.empty() && bytes[0] > 1) problem("00 or 01");
    return bytes.size() == *size;
  }

  ByteView frame_;
  std::vector<Field> fields_;
  std::size_t pos_ = 0;
  bool from_server_ = false, several_ = false, complete_ = false;
};

}  // namespace

void put_word(Bytes& bytes, std::size_t value) {
  bytes.push_back(static_cast<Byte>(value));
  bytes.push_back(static_cast<Byte>(value >> 8));
}

std::optional<std::size_t> frame_length(ByteView bytes) {
  if (bytes.size() < header_size) return std::nullopt;
  const std::size_t size = header_size + word_at(bytes, length_at);
  return size <= bytes.size() ? std::optional(size) : std::nullopt;
}

std::vector<Field> explain(ByteView frame) { return Reader(frame).read(); }

bool is_field(const Field& field, std::string_view name) {
  const std::string_view text = field.name;
  if (text == name) return true;
  return text.size() > name.size() + 1 && text.starts_with(name) && text[name.size()] == ' ' &&
         text[name.size() + 1] >= '0' && text[name.size() + 1] <= '9';
}

}  // namespace fieldproof::xgt_fenet_suite
