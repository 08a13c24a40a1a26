// A notation made concrete for one station: literal bytes, open places, checks and pauses.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/notation/check.hpp"
#include "harness/notation/notation.hpp"

namespace fieldproof::notation {

/// What stands before a device's name in a frame: its length. Supplied by the protocol.
using NameHead = Bytes (*)(std::size_t characters);

/// What the moving fields of a notation become.
struct Fields {
  Bytes own;                     // st
  Bytes foreign;                 // st+1
  Checks checks{};               // of the protocol; they outlive the templates
  NameHead name_head = nullptr;  // nullptr: frames of this protocol have no names
};

/// Texts captured by {id:4}, by id.
using Captures = std::map<std::string, std::string>;

struct FrameTemplate {
  struct Cell {
    enum class Kind : Byte { literal, any, hex_digit, capture, reuse, check };
    Kind kind = Kind::literal;
    std::uint16_t part = 0;   // index into `names` (capture, reuse) or `checks`
    std::uint32_t index = 0;  // which byte of that part
  };
  struct Check {
    const notation::Check* kind = nullptr;
    bool wrong = false;
    std::size_t begin = 0;  // first byte of its bracket
    std::size_t at = 0;     // first byte of the check
    std::size_t end = 0;    // the end of its bracket, for a check of what is behind it
  };
  struct Gap {
    std::size_t before = 0;  // byte that the pause precedes
    Pause pause;
  };

  Bytes bytes;  // literal values; 0 in open cells; checks filled in where all they cover is literal
  std::vector<Cell> cells;  // one a byte
  std::vector<Check> checks;
  std::vector<Gap> gaps;
  std::vector<std::string> names;
  std::vector<std::size_t> holes;  // which cells are neither literal nor a settled check
  std::map<std::string, std::string>
      readings;  // alternatives taken inside the frame: name of the field -> "a"
};

/// Are all words of the notation known to the protocol: its checks, its names? The error names the
/// first that is not.
Status check_words(const Notation& notation, const Fields& fields);

/// Every choice of named alternatives gives one template, the preferred one first.
/// Errors: a check or a name that the protocol does not have, more than 64 alternatives.
Result<std::vector<FrameTemplate>> make_templates(const Notation& notation, const Fields& fields);

/// What the check is in these bytes of its frame.
Bytes check_bytes(const FrameTemplate::Check& check, ByteView frame);

/// The bytes to send; an error when a place is open.
Result<Bytes> render(const FrameTemplate& frame, const Captures& captures);

/// Does `received` match? On success captures are added. On failure the offset of the first byte
/// that differs
/// (`received.size()` when it is cut short, the template's size when it has a surplus).
std::optional<std::size_t> first_mismatch(const FrameTemplate& frame, ByteView received,
                                          Captures& captures);

/// "05 30 ?? ??": open places as ??, checks behind open places too.
std::string to_hex_with_holes(const FrameTemplate& frame);

}  // namespace fieldproof::notation
