#include "src/xnet_network/instruction.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "src/xnet/words.hpp"

namespace fieldproof::xnet {

namespace {

struct Name {
  std::string_view name;
  bool reads, bits;
};
constexpr std::array names{Name{"BIT_READ", true, true}, Name{"BIT_WRITE", false, true},
                           Name{"REG_READ", true, false}, Name{"REG_WRITE", false, false}};

const Name* find_name(std::string_view word) {
  for (const Name& one : names)
    if (one.name == word) return &one;
  return nullptr;
}

/// Its words, one after the other. The first error stays.
class Reader {
 public:
  Reader(std::string_view text, const Memory& memory)
      : words_(text), text_(text), memory_(memory) {}

  const std::optional<Error>& error() const { return error_; }
  std::string_view next() { return words_.next(); }
  void keyword(std::string_view expected) {
    if (const std::string_view word = next(); word != expected)
      wrong(fmt::format("'{}' where '{}' belongs", word, expected));
  }
  std::uint32_t number(std::string_view what, bool double_word = false) {
    const std::string_view word = next();
    if (const std::optional<std::uint32_t> value = plain_number(word)) {
      if (*value > 0xFFFF && !double_word)
        wrong(fmt::format("{} {} has more than 16 bits", what, word));
      return *value;
    }
    const std::optional<Component> found = memory_.find(word);
    if (found && !found->area->bits && memory_.room_from(*found) > (double_word ? 1 : 0)) {
      const unsigned high = double_word ? memory_.read({found->area, found->number + 1}) : 0;
      return high << 16 | memory_.read(*found);
    }
    wrong(fmt::format("{} '{}' is no number, nor a register; write 10, K10, H0A or D100", what,
                      word));
    return 0;
  }
  void wrong(const std::string& what) {
    if (!error_) error_ = fail(fmt::format("cannot execute '{}': {}", text_, what));
  }

 private:
  Words words_;
  std::string_view text_;
  const Memory& memory_;
  std::optional<Error> error_;
};

void read_target(Reader& reader, Instruction& read) {
  const std::string_view word = reader.next();
  if (word == "type") {
    read.type = reader.number("the type");
    reader.keyword("address");
    read.address = reader.number("the address", true);
    return;
  }
  const std::optional<Component> target = find_component(word);
  if (!target || target->area->type == 0)
    return reader.wrong(fmt::format(
        "there is no object '{}'; write D0, or in octal X17, or type 128 address 0", word));
  read.type = target->area->type;
  read.address = target->number;
}

void read_local(Reader& reader, const Memory& memory, Instruction& read) {
  reader.keyword(read.reads ? "to" : "from");
  const std::string_view word = reader.next();
  const std::optional<Component> local = memory.find(word);
  if (!local) return reader.wrong(fmt::format("this PLC has no '{}'", word));
  if (local->area->bits != read.bits)
    return reader.wrong(fmt::format("the local object {} is a {}, and the instruction is of {}",
                                    word, read.bits ? "register" : "coil",
                                    read.bits ? "coils" : "registers"));
  if (!read.reads && !read.bits && local->area->modules != 0)
    return reader.wrong(
        fmt::format("{} is of a module, and REG_WRITE takes no such local object", word));
  read.local = *local;
}

}  // namespace

bool is_instruction(std::string_view text) { return find_name(text.substr(0, text.find(' '))); }

Result<Instruction> read_instruction(std::string_view text, const Memory& memory) {
  Reader reader(text, memory);
  const Name* const name = find_name(reader.next());
  if (!name) {
    reader.wrong("it is none of BIT_READ, BIT_WRITE, REG_READ, REG_WRITE");
    return *reader.error();
  }
  Instruction read{name->reads, name->bits};
  reader.keyword("net");
  read.net = reader.number("the net");
  reader.keyword("station");
  read.station = reader.number("the station");
  read_target(reader, read);
  reader.keyword("count");
  read.count = reader.number("the count");
  read_local(reader, memory, read);
  if (const std::string_view rest = reader.next(); !rest.empty())
    reader.wrong(fmt::format("'{}' stands behind its end", rest));
  if (reader.error()) return *reader.error();
  return read;
}

}  // namespace fieldproof::xnet
