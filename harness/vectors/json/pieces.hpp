// The elements of a JSON array, found without parsing them.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace fieldproof::vectors {

/// One element: an object, with what its key "id" holds (empty: none, or no plain text).
struct Piece {
  std::string_view text;
  std::string_view id;
  int line = 1;  // where it begins
};

/// The objects of the array that `json` is, or the one object that it is. Nothing where it is
/// neither, or is broken between them; inside them nothing is checked.
std::optional<std::vector<Piece>> cut(std::string_view json);

/// The same of a file; throws what is wrong with it where they cannot be told. `what` it should be,
/// for the message: "a file of vectors".
std::vector<Piece> pieces_of(std::string_view file_text, std::string_view what);

}  // namespace fieldproof::vectors
