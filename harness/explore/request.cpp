#include "harness/explore/request.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <set>

#include "harness/notation/check.hpp"
#include "harness/notation/pdu.hpp"
#include "harness/safety/brackets.hpp"
#include "harness/vectors/binding.hpp"

namespace fieldproof::explore {

using harness::Field;
using harness::Protocol;
using notation::Item;
using notation::Notation;
using vectors::Case;
using vectors::Step;

namespace {

/// "rss" of "xgt_cnet/rss/two_words".
std::string topic_of(const std::string& id) {
  const std::size_t begin = id.find('/') + 1;
  return id.substr(begin, id.find('/', begin) - begin);
}

/// Of a server of this protocol, set up as any device is.
bool is_for(const Case& one, const Protocol& protocol, std::string_view model) {
  if (one.protocol != protocol.name() || vectors::is_client_case(one) || !one.on_model.empty())
    return false;
  if (!one.models.empty() && std::ranges::find(one.models, model) == one.models.end()) return false;
  return is_of_any_set_up(one);
}

/// Is more than one answer to it right? Then our own device's is but one of them.
bool allows_several(const Case& one, const Step& send) {
  const auto next = &send - one.steps.data() + 1;
  return static_cast<std::size_t>(next) < one.steps.size() &&
         one.steps[static_cast<std::size_t>(next)].frames.size() > 1;
}

/// The sort of answer that stands behind a request in its vector.
std::string answer_in(const Case& one, const Step& send, const Protocol& protocol) {
  const auto next = static_cast<std::size_t>(&send - one.steps.data() + 1);
  if (next >= one.steps.size() || one.steps[next].kind == Step::Kind::silence) return "silence";
  if (one.steps[next].kind == Step::Kind::expect_close) return "closed";
  if (one.steps[next].kind != Step::Kind::expect) return {};
  const Result<Bytes> bytes =
      safety::bytes_of(one.steps[next].frames.front().notation, protocol.fields_at(1));
  return bytes ? sort_of(*bytes, protocol) : std::string();
}

/// What the step rests on is said by itself, or by its case.
Clause clause_of(const Case& one, const Step& send, const Protocol& protocol) {
  const auto next = static_cast<std::size_t>(&send - one.steps.data() + 1);
  if (one.level != "must") return {};  // it binds nobody
  const bool own = next < one.steps.size() && !one.steps[next].source.quote.empty();
  return {answer_in(one, send, protocol), vectors::rests_on_decisions(one),
          own ? one.steps[next].source : one.source, one.decisions};
}

bool says_all(const Notation& notation) {
  return std::ranges::none_of(notation, [](const Item& item) {
    return item.kind == Item::Kind::reuse || item.kind == Item::Kind::alternatives;
  });
}

Item item_of(Item::Kind kind, std::string text) {
  Item item;
  item.kind = kind;
  item.text = std::move(text);
  return item;
}

void append(Notation& notation, ByteView bytes) {
  Result<Notation> words = notation::parse_notation(notation::print_bytes(bytes));
  if (words && !bytes.empty()) std::ranges::move(*words, std::back_inserter(notation));
}

/// The bytes that a check covers, of a frame that stands in one bracket.
ByteView covered_by(const notation::Check& check, const Field& field, ByteView frame) {
  return check.behind ? frame.subspan(field.offset + field.size) : frame.first(field.offset);
}

/// The word for a field that moves with the station, or follows from the others; empty: its bytes.
Notation word_for(const Field& field, ByteView frame, const Protocol& protocol, int station) {
  const ByteView bytes = frame.subspan(field.offset, field.size);
  if (field.name == "station" && std::ranges::equal(bytes, protocol.station_bytes(station)))
    return {item_of(Item::Kind::station, "st")};
  const notation::Checks checks = protocol.checks();
  const notation::Check* check = notation::find_check(checks, field.name);
  if (check && check->size == field.size && !(check->absent && check->absent(frame)) &&
      check->compute && std::ranges::equal(check->over(covered_by(*check, field, frame)), bytes))
    return {item_of(Item::Kind::check, std::string(check->name))};
  return {};
}

/// A word for some bytes of a frame.
struct Word {
  std::size_t offset = 0, size = 0;
  Item item;
};

/// What moves in it.
std::vector<Word> moving_words(ByteView frame, bool request, const Protocol& protocol,
                               int station) {
  std::vector<Word> words;
  std::size_t at = 0;
  for (const Field& field : protocol.explain_as(frame, request)) {
    if (field.offset < at || field.size == 0 || field.offset + field.size > frame.size()) continue;
    const Notation word = word_for(field, frame, protocol, station);
    if (word.empty()) continue;
    words.push_back({field.offset, field.size, word.front()});
    at = field.offset + field.size;
  }
  return words;
}

std::size_t size_of(const Item& item, const Protocol& protocol) {
  const notation::Checks checks = protocol.checks();
  const notation::Check* check = nullptr;
  if (item.kind == Item::Kind::check) check = notation::find_check(checks, item.text);
  if (item.kind == Item::Kind::station) return protocol.station_bytes(0).size();
  return check ? check->size : item.bytes.size() * static_cast<std::size_t>(item.repeat);
}

/// What all vectors leave open in a reply, since it is the device's own: in its header (pdu(...)),
/// and what is reserved in its body.
std::vector<Word> left_open(const Protocol& protocol) {
  if (!protocol.dressing()) return {};
  const Result<std::string> reply = notation::dress("pdu(00)", protocol.dressing()->of(true, false),
                                                    [] { return Result<std::string>("00 00"); });
  if (!reply) return {};
  const Result<Notation> items = notation::parse_notation(*reply);
  std::vector<Word> words;
  std::size_t at = 0;
  for (const Item& item : *items) {
    if (item.kind != Item::Kind::any) {
      at += size_of(item, protocol);
      continue;
    }
    words.push_back({at, static_cast<std::size_t>(item.repeat), item});
    at += words.back().size;
  }
  const std::size_t before = protocol.dressing()->before_own_word, body = at - 1;  // of one byte
  if (before == 0) return words;
  words.push_back({body + before, 2, item_of(Item::Kind::any, "??")});
  words.back().item.repeat = 2;
  return words;
}

/// One bracket with these words in it, each of which stands behind the one before.
Notation bracketed(ByteView frame, const std::vector<Word>& words) {
  Notation notation{item_of(Item::Kind::open, "[")};
  std::size_t at = 0;
  for (const Word& word : words) {
    append(notation, frame.subspan(at, word.offset - at));
    notation.push_back(word.item);
    at = word.offset + word.size;
  }
  append(notation, frame.subspan(at));
  notation.push_back(item_of(Item::Kind::close, "]"));
  return notation;
}

}  // namespace

bool is_a_right_frame(const Request& request) {
  return request.kind != "damage" && request.kind != "pause" && request.kind != "twice";
}

std::string sort_of(ByteView answer, const Protocol& protocol) {
  if (answer.empty()) return "silence";
  for (const Field& field : protocol.explain_as(answer, false))
    if (field.name == "error code" || field.name == "exception code") return field.text;
  return "answered";
}

bool is_of_any_set_up(const Case& one) {
  return std::ranges::all_of(one.config.items(),
                             [](const auto& item) { return item.key() == "station"; });
}

std::optional<Protocol::Place> place_of(const Protocol::Written& word, const Protocol& protocol) {
  if (const std::vector<Protocol::Place> places = protocol.places(word); !places.empty())
    return places.front();
  const std::vector<Protocol::Area> areas = protocol.areas();
  const auto area = std::ranges::find(areas, word.area, &Protocol::Area::name);
  if (area == areas.end() || word.contacts) return std::nullopt;
  return Protocol::Place{fmt::format("%{}W{}", word.area, word.first_word), 4,
                         word.first_word < protocol.words_of(word.area)};
}

Notation raw_notation(ByteView bytes) {
  Notation notation;
  append(notation, bytes);
  return notation;
}

Notation notation_of(ByteView frame, bool request, const Protocol& protocol, int station) {
  const std::optional<std::size_t> length = protocol.frame_length(frame);
  if (!request && length && *length > 0 && *length < frame.size()) {  // replies in a row
    Notation all = notation_of(frame.first(*length), request, protocol, station);
    const Notation rest = notation_of(frame.subspan(*length), request, protocol, station);
    all.insert(all.end(), rest.begin(), rest.end());
    return all;
  }
  if (!length || *length != frame.size()) return raw_notation(frame);
  std::vector<Word> words = moving_words(frame, request, protocol, station);
  const Result<Bytes> made = safety::bytes_of(bracketed(frame, words), protocol.fields_at(station));
  if (!made || !std::ranges::equal(*made, frame)) return raw_notation(frame);
  if (!request)
    for (Word& open : left_open(protocol)) {
      if (open.offset + open.size > frame.size()) continue;
      std::erase_if(words, [&](const Word& word) {
        return word.offset < open.offset + open.size && open.offset < word.offset + word.size;
      });
      words.push_back(std::move(open));
    }
  std::ranges::sort(words, {}, &Word::offset);
  return bracketed(frame, words);
}

std::vector<Request> requests_of(const std::vector<Case>& cases, const Protocol& protocol,
                                 std::string_view model) {
  std::vector<Request> requests;
  std::set<std::string> seen;
  for (const Case& one : cases) {
    if (!is_for(one, protocol, model)) continue;
    for (const Step& step : one.steps) {
      if (step.kind != Step::Kind::send || !step.link.protocol.empty()) continue;
      if (allows_several(one, step)) continue;
      const vectors::Frame& frame = step.frames.front();
      if (!says_all(frame.notation) || !seen.insert(notation::print(frame.notation)).second)
        continue;
      requests.push_back({topic_of(one.id), one.id, frame.notation});
      requests.back().clause = clause_of(one, step, protocol);
    }
  }
  return requests;
}

}  // namespace fieldproof::explore
