#include "harness/vectors/vector_shape.hpp"

#include <algorithm>
#include <array>

#include "harness/vectors/case.hpp"

namespace fieldproof::vectors {

/// Words for keys, types and texts of a vector.
namespace vector_shapes {
namespace {

using Kind = Shape::Kind;
using Words = std::string_view;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_id_character(char c) { return is_digit(c) || (c >= 'a' && c <= 'z') || c == '_'; }
bool is_word(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, is_id_character);
}

bool is_id(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == text.npos) return false;
  const std::string_view rest = text.substr(slash + 1);
  return is_word(text.substr(0, slash)) && (is_word(rest) || is_id(rest));
}

bool is_decision(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return is_id_character(c) || c == '/' || c == '-';
  });
}

bool is_duration(std::string_view text) {
  if (is_filled(text)) return true;
  const auto take_digits = [&] {
    const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    text.remove_prefix(digits);
    return digits > 0;
  };
  if (!take_digits()) return false;
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    if (!take_digits()) return false;
  }
  return text == "us" || text == "ms" || text == "s";
}

bool is_wire(std::string_view text) {
  return is_filled(text) ||
         (!text.empty() && text.find_first_not_of("0123456789ABCDEFabcdef? ") == text.npos);
}

constexpr Form word{"small letters, digits and _", "^[a-z0-9_]+$", is_word};
constexpr Form vector_id{"an id: words of small letters, digits and _, joined by /",
                         "^[a-z0-9_]+(/[a-z0-9_]+)+$", is_id};
constexpr Form duration_form{"a duration such as 500ms, 1.5s or 20us",
                             "^(\\$\\{[a-z0-9_]+\\}|[0-9]+(\\.[0-9]+)?(us|ms|s))$", is_duration};
constexpr Form wire_form{"two-digit hex bytes such as 05 3F ??",
                         "^(\\$\\{[a-z0-9_]+\\}|[0-9A-Fa-f? ]+)$", is_wire};
constexpr Form decision_id{"the id of a decision in DECISIONS.md", "^[a-z0-9_/-]+$", is_decision};
constexpr std::array forms{&word, &vector_id, &decision_id, &duration_form, &wire_form};

constexpr Shape any_text{};
constexpr Shape text{.least = 1};
constexpr Shape texts{.kind = Kind::list, .least = 1, .items = &text};
constexpr Shape text_or_texts{.least = 1, .instead = &texts};
constexpr Shape reason{.least = 10};
constexpr Shape yes{.kind = Kind::yes};
constexpr Shape boolean{.kind = Kind::boolean};
constexpr Shape any_object{.kind = Kind::object, .open = true};
constexpr Shape memory{.kind = Kind::object, .least = 1, .open = true, .others = &text};
constexpr Shape duration{.form = &duration_form};

/// Addresses and values; with a `reading`, alternatives of them by name.
constexpr Shape value_or_alternative{.least = 1, .instead = &memory};
constexpr Shape checked{
    .kind = Kind::object, .least = 1, .open = true, .others = &value_or_alternative};

constexpr Shape quote{.least = 5};
constexpr std::array source_keys{Key{"manual", &text, true}, Key{"section", &text, true},
                                 Key{"quote", &quote, true}, Key{"statement", &text_or_texts}};
constexpr Shape source{.kind = Kind::object, .keys = source_keys};

constexpr std::array alternatives_keys{Key{"reading", &text, true}};
constexpr Shape alternatives{
    .kind = Kind::object, .least = 3, .keys = alternatives_keys, .open = true, .others = &text};
constexpr Shape frame{.least = 1, .instead = &alternatives};

constexpr Shape wire{.form = &wire_form};
constexpr Shape named_wires{.kind = Kind::object, .open = true, .others = &wire};
constexpr Shape framed_wire{.form = &wire_form, .instead = &named_wires};
constexpr Shape framed_wires{.kind = Kind::object, .open = true, .others = &framed_wire};
constexpr Shape wires{.form = &wire_form, .instead = &framed_wires};

constexpr auto fault_words = [] {
  std::array<Words, partner_faults.size() + 1> words{"none"};
  std::ranges::copy(partner_faults, words.begin() + 1);
  return words;
}();
constexpr Shape fault{.words = fault_words, .filled = true};
constexpr std::array partner_keys{Key{"model", &text}, Key{"memory", &memory},
                                  Key{"fault", &fault}};
constexpr Shape partner{.kind = Kind::object, .keys = partner_keys, .open = true};

constexpr std::array<Words, 2> transport_words{"tcp", "udp"};
constexpr std::array<Words, 3> close_words{"fin", "rst", "vanish"};
constexpr std::array<Words, 4> ending_words{"fin", "rst", "any", "may"};
constexpr Shape transport{.words = transport_words};
constexpr Shape port{.kind = Kind::number, .least = 1, .most = 65'535};
constexpr std::array link_keys{Key{"name", &text, true}, Key{"protocol", &text},
                               Key{"transport", &transport}, Key{"port", &port}};
constexpr Shape link{.kind = Kind::object, .keys = link_keys};
constexpr Shape open{.least = 1, .instead = &link};
constexpr Shape close{.words = close_words};
constexpr Shape ending{.words = ending_words};

constexpr Shape times{.kind = Kind::number, .least = 1, .most = 10'000};
constexpr std::array step_keys{
    Key{"send", &text},           Key{"expect", &frame},     Key{"wire", &wires},
    Key{"silence", &yes},         Key{"wait", &duration},    Key{"partner", &partner},
    Key{"set", &memory},          Key{"check", &checked},    Key{"do", &text},
    Key{"open", &open},           Key{"close", &close},      Key{"expect_close", &ending},
    Key{"expect_open", &open},    Key{"on", &text},          Key{"within", &duration},
    Key{"every", &duration},      Key{"max_gap", &duration}, Key{"times", &times},
    Key{"clause", &text_or_texts}};
constexpr Shape step{.kind = Kind::object, .keys = step_keys};
constexpr Shape steps{.kind = Kind::list, .least = 1, .items = &step};

constexpr Shape case_name{.form = &word};  // or that of a folder
constexpr std::array row_keys{Key{"case", &case_name, true}};
constexpr Shape row{.kind = Kind::object, .keys = row_keys, .open = true, .others = &any_text};
constexpr Shape rows{.kind = Kind::list, .least = 1, .items = &row};
constexpr Shape each{.kind = Kind::object, .least = 1, .open = true, .others = &rows};

constexpr std::array given_keys{Key{"config", &any_object}, Key{"memory", &memory},
                                Key{"fresh", &boolean}};
constexpr Shape given{.kind = Kind::object, .keys = given_keys};

constexpr std::array<Words, 6> kind_words{"case",     "table",         "instruction",
                                          "register", "configuration", "timing"};
constexpr std::array<Words, 3> level_words{"must", "should", "info"};
constexpr std::array<Words, 5> basis_words{"printed frame", "printed rule", "printed", "derived",
                                           "decision"};
constexpr std::array<Words, 2> argued_words{"derived", "decision"};
constexpr std::array<Words, 1> table_word{"table"};
constexpr Shape id{.most = 200, .form = &vector_id};
constexpr Shape rev{.kind = Kind::number, .least = 1};
constexpr Shape title{.least = 10};
constexpr Shape kind{.words = kind_words};
constexpr Shape level{.words = level_words};
constexpr Shape basis{.words = basis_words};

constexpr std::array argued{Demand{"basis", argued_words, "why", ""}};
constexpr Shape decision{.form = &decision_id};
constexpr Shape decisions{.kind = Kind::list, .least = 1, .items = &decision};
constexpr Shape clauses{.kind = Kind::object, .least = 1, .open = true, .others = &text_or_texts};
constexpr std::array difference_keys{
    Key{"title", &title},  Key{"describes", &reason}, Key{"statement", &text_or_texts},
    Key{"basis", &basis},  Key{"why", &reason},       Key{"decision", &decisions},
    Key{"models", &texts}, Key{"clauses", &clauses}};
constexpr Shape difference{
    .kind = Kind::object, .least = 1, .keys = difference_keys, .demands = argued};
constexpr Shape differs{.kind = Kind::object, .least = 1, .open = true, .others = &difference};
constexpr Shape framings{.kind = Kind::list, .least = 1, .items = &case_name};

constexpr std::array vector_keys{Key{"id", &id, true},        Key{"rev", &rev},
                                 Key{"title", &title, true},  Key{"describes", &reason},
                                 Key{"framings", &framings},  Key{"differs", &differs},
                                 Key{"kind", &kind},          Key{"statement", &text_or_texts},
                                 Key{"source", &source},      Key{"level", &level, true},
                                 Key{"basis", &basis, true},  Key{"why", &reason},
                                 Key{"decision", &decisions}, Key{"models", &texts},
                                 Key{"each", &each},          Key{"given", &given},
                                 Key{"steps", &steps},        Key{"facts", &any_object},
                                 Key{"line_alone", &boolean}, Key{"transpose", &boolean}};
constexpr std::array vector_demands{Demand{"basis", argued_words, "why", ""},
                                    Demand{"kind", table_word, "facts", "steps"}};
constexpr Shape vector{.kind = Kind::object, .keys = vector_keys, .demands = vector_demands};

}  // namespace
}  // namespace vector_shapes

const Shape& vector_shape() { return vector_shapes::vector; }

std::span<const Form* const> vector_forms() { return vector_shapes::forms; }

}  // namespace fieldproof::vectors
