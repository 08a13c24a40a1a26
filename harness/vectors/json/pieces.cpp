#include "harness/vectors/json/pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/vectors/json/broken.hpp"
#include "src/base/nesting.hpp"

namespace fieldproof::vectors {

namespace {

class Cutter {
 public:
  explicit Cutter(std::string_view text) : json_(text) {}

  std::optional<std::vector<Piece>> cut() {
    std::vector<Piece> pieces;
    skip_space();
    const bool array = take('[');
    do {
      skip_space();
      if (array && pieces.empty() && take(']')) return pieces;
      if (peek() != '{') return std::nullopt;
      std::optional<Piece> piece = object();
      if (!piece) return std::nullopt;
      pieces.push_back(*piece);
      skip_space();
    } while (array && take(','));
    if (array && !take(']')) return std::nullopt;
    skip_space();
    if (at_ != json_.size()) return std::nullopt;
    return pieces;
  }

 private:
  char peek() const { return at_ < json_.size() ? json_[at_] : '\0'; }
  bool take(char c) {
    if (peek() != c || at_ >= json_.size()) return false;
    ++at_;
    return true;
  }
  void skip_space() {
    for (; at_ < json_.size(); ++at_) {
      if (json_[at_] == '\n')
        ++line_;
      else if (json_[at_] != ' ' && json_[at_] != '\t' && json_[at_] != '\r')
        return;
    }
  }

  /// From '{' to its '}'.
  std::optional<Piece> object() {
    Piece piece{{}, {}, line_};
    const std::size_t begin = at_;
    for (int depth = 0; at_ < json_.size();) {
      const char c = json_[at_];
      if (c == ' ') {
        ++at_;
        continue;
      }
      if (c == '"') {
        const std::optional<std::string_view> text = quoted();
        if (!text) return std::nullopt;
        if (depth == 1 && *text == "id" && piece.id.empty()) piece.id = text_behind_colon();
        continue;
      }
      ++at_;
      if (c == '\n') ++line_;
      if (c == '{' || c == '[') ++depth;
      if ((c == '}' || c == ']') && --depth == 0) {
        piece.text = json_.substr(begin, at_ - begin);
        return piece;
      }
    }
    return std::nullopt;
  }

  /// What stands between the quotes, as it stands.
  std::optional<std::string_view> quoted() {
    const std::size_t begin = ++at_;
    do {
      at_ = json_.find('"', at_);
      if (at_ == json_.npos) return std::nullopt;
    } while (is_escaped(begin, at_++));
    return json_.substr(begin, at_ - 1 - begin);
  }

  bool is_escaped(std::size_t begin, std::size_t at) const {
    std::size_t backslashes = 0;
    while (at - backslashes > begin && json_[at - backslashes - 1] == '\\') ++backslashes;
    return backslashes % 2 == 1;
  }

  std::string_view text_behind_colon() {
    skip_space();
    if (!take(':')) return {};
    skip_space();
    if (peek() != '"') return {};
    return quoted().value_or("");
  }

  std::string_view json_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

std::optional<std::vector<Piece>> cut(std::string_view text) { return Cutter(text).cut(); }

std::vector<Piece> pieces_of(std::string_view file_text, std::string_view what) {
  if (std::optional<std::vector<Piece>> pieces = cut(file_text)) return std::move(*pieces);
  [[maybe_unused]] const auto whole =
      nlohmann::ordered_json::parse(not_too_deep(file_text));  // throws what is wrong, mostly
  throw Broken(fmt::format("is no list of objects, as {} is; see vectors/README.md", what));
}

}  // namespace fieldproof::vectors
