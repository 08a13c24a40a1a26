// The frame notation of the vectors (vectors/README.md): one parser, one printer.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/base/bytes.hpp"
#include "src/base/result.hpp"
#include "src/base/time.hpp"

namespace fieldproof::notation {

/// A pause in milliseconds (~20ms, ~1s) or in character times of the line (~1.6c).
struct Pause {
  double amount = 0;
  bool characters = false;

  Duration at(Duration character_time) const;
};

/// One word of the notation.
struct Item {
  enum class Kind {
    open,
    close,       // [ ]
    literal,     // ENQ, 0D, 'rSS': `bytes`
    station,     // st, st+1: `number` is what is added
    name,        // name(%MW020): `text`
    sequence,    // seq(60): `number` words
    check,       // BCC, BCC!: `text` is its name, `wrong`
    pause,       // ~20ms
    any,         // ??
    hex_digits,  // x:4
    capture,
    reuse,        // {id:4}, {id}: `text` and `number`, of {id} only where it is known
    alternatives  // (a:'ss'|b:'SS')
  };
  struct Alternative;

  Kind kind = Kind::literal;
  std::string text;  // as written, less the repetition
  Bytes bytes;
  int number = 0;
  bool wrong = false;
  Pause pause;
  std::vector<Alternative> alternatives;
  int repeat = 1;  // '1234'*60
};

struct Item::Alternative {
  std::string name;
  std::vector<Item> items;
};

using Notation = std::vector<Item>;

/// Errors name the column and the word, and suggest a near miss.
Result<Notation> parse_notation(std::string_view text);

/// The reverse: parse_notation(print(n)) prints the same again.
std::string print(const Notation& notation);

/// Plain bytes in notation: ENQ '01rSS' EOT 'A4' FF; numbers that are hardly text as hex alone: 01
/// 03 00 63.
std::string print_bytes(ByteView bytes);

}  // namespace fieldproof::notation
