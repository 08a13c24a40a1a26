#include "harness/safety/transposition.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <functional>

#include "harness/exchange/prepared_case.hpp"
#include "harness/safety/brackets.hpp"

namespace fieldproof::safety {

using harness::Protocol;
using notation::Fields;
using notation::Notation;
using results::Move;
using vectors::Case;
using vectors::Frame;
using vectors::Step;

namespace {

using Written = Protocol::Written;
using Words = WriteFence::Words;
using Memory = std::vector<std::pair<std::string, std::string>>;

constexpr int alignment = 4;  // words: a long word stays a long word, a bit its place
constexpr std::uint32_t last_word_of_any = 0xFFFF;

/// An address of the case, wherever it stands.
struct Spot {
  Written place;
  bool asked = false;                // of a request to the device
  std::function<bool(int)> movable;  // by so many words
};

/// Every Memory of a case, and every frame with its direction.
void for_each_memory(const Case& source,
                     const std::function<void(const Memory&, bool writes)>& visit) {
  visit(source.memory, true);
  for (const Step& step : source.steps)
    if (step.kind == Step::Kind::set || step.kind == Step::Kind::check)
      visit(step.memory, step.kind == Step::Kind::set);
}
void for_each_frame(const Case& source,
                    const std::function<void(const Frame&, bool reply)>& visit) {
  for (const Step& step : source.steps)
    for (const Frame& frame : step.frames) visit(frame, step.kind == Step::Kind::expect);
}

std::vector<Spot> spots_of(const Case& source, const Fields& stations, const Protocol& protocol) {
  std::vector<Spot> spots;
  for_each_memory(source, [&](const Memory& memory, bool) {
    for (const auto& [address, hex] : memory)
      if (const auto place = protocol.named(address, hex.size()))
        spots.push_back({*place, false, [&protocol, name = address](int words) {
                           return protocol.moved(name, words).has_value();
                         }});
  });
  for_each_frame(source, [&](const Frame& frame, bool reply) {
    for (const Bracket& bracket : brackets_of(frame.notation, reply, stations, protocol))
      for (const Protocol::AddressField& field : bracket.fields)
        spots.push_back({field.names, !reply, [&protocol, field, bytes = bracket.bytes](int words) {
                           return protocol.moved_field(bytes, field, words).has_value();
                         }});
  });
  return spots;
}

/// What the case writes, as far as its requests can be made.
std::vector<Written> writes_of(const Case& source, int station, const Fields& stations,
                               const Protocol& protocol) {
  std::vector<Written> writes;
  const auto add = [&](ByteView request) {
    std::ranges::move(protocol.written_by(request), std::back_inserter(writes));
  };
  for_each_memory(source, [&](const Memory& memory, bool setting) {
    for (const auto& [address, hex] : memory)
      if (const auto requests = protocol.write_requests(station, address, hex); setting && requests)
        for (const Bytes& request : *requests) add(request);
  });
  for_each_frame(source, [&](const Frame& frame, bool reply) {
    if (const Result<Bytes> bytes = bytes_of(frame.notation, stations); !reply && bytes)
      add(*bytes);
  });
  return writes;
}

// ---- planning

/// Why a case cannot leave where it is: it is about an end of the area.
std::string about_an_end(const std::vector<Spot>& spots, const std::string& area,
                         const Protocol& protocol) {
  const std::uint32_t words = protocol.words_of(area);
  for (const Spot& spot : spots) {
    if (spot.place.area != area) continue;
    if (spot.asked && spot.place.first_word == 0)
      return fmt::format("it is about the beginning of {}", area);
    if (spot.place.last_word >= words - 1) return fmt::format("it is about the end of {}", area);
  }
  return {};
}

/// Runs of adjacent words that the spots of an area make.
std::vector<Words> clusters_of(const std::vector<Spot>& spots, const std::string& area) {
  std::vector<Words> all;
  for (const Spot& spot : spots)
    if (spot.place.area == area) all.push_back({spot.place.first_word, spot.place.last_word});
  std::ranges::sort(all, {}, &Words::first);
  std::vector<Words> clusters;
  for (const Words& one : all) {
    if (!clusters.empty() && one.first <= clusters.back().last + 1)
      clusters.back().last = std::max(clusters.back().last, one.last);
    else
      clusters.push_back(one);
  }
  return clusters;
}

class Mover {
 public:
  Mover(const std::vector<Spot>& spots, std::string area, std::vector<Words> allowed)
      : spots_(spots), area_(std::move(area)), allowed_(std::move(allowed)) {}

  /// All by the same distance, else each run by its own, in their order and still apart. Empty: no
  /// room.
  std::vector<Move> place(const std::vector<Words>& clusters) const {
    const Words span{clusters.front().first, clusters.back().last};
    if (const auto words = distance(span, 0)) return {{area_, span.first, span.last, *words}};
    std::vector<Move> moves;
    std::int64_t from = 0;
    for (const Words& cluster : clusters) {
      const auto words = distance(cluster, from);
      if (!words) return {};
      moves.push_back({area_, cluster.first, cluster.last, *words});
      from = std::int64_t{cluster.last} + *words + 2;
    }
    return moves;
  }

 private:
  /// The first distance that brings `words` into an allowed range, not before word `from`.
  std::optional<int> distance(const Words& words, std::int64_t from) const {
    for (const Words& range : allowed_) {
      const std::int64_t first = std::max<std::int64_t>(range.first, from),
                         last = std::min(range.last, last_word_of_any);
      std::int64_t by = first - words.first;
      by += ((-by % alignment) + alignment) % alignment;
      for (; words.last + by <= last; by += alignment)
        if (all_movable(words, static_cast<int>(by))) return static_cast<int>(by);
    }
    return std::nullopt;
  }

  bool all_movable(const Words& words, int by) const {
    return std::ranges::all_of(spots_, [&](const Spot& spot) {
      const bool within = spot.place.area == area_ && words.first <= spot.place.first_word &&
                          spot.place.last_word <= words.last;
      return !within || spot.movable(by);
    });
  }

  const std::vector<Spot>& spots_;
  std::string area_;
  std::vector<Words> allowed_;
};

std::string text_of(const std::vector<Words>& all, const std::string& area,
                    const Protocol& protocol) {
  std::vector<std::string> texts;
  for (const Words& one : all) {
    const std::string first = protocol.spell(area, one.first);
    texts.push_back(one.first == one.last ? first : first + "-" + protocol.spell(area, one.last));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// A device name that stands in a request where no address is read: moving the memory would part
/// the two.
std::string name_elsewhere(const Case& source, const std::vector<Spot>& spots,
                           const Fields& stations, const Protocol& protocol) {
  std::string found;
  for_each_frame(source, [&](const Frame& frame, bool reply) {
    if (reply) return;
    for (const Bracket& bracket : brackets_of(frame.notation, false, stations, protocol)) {
      std::string text = to_text(bracket.bytes);
      for (const Protocol::AddressField& field : bracket.fields)
        text.replace(field.offset, field.size, field.size, ' ');
      for (const Spot& spot : spots)
        if (spot.place.address.starts_with('%') &&
            text.find(spot.place.address) != std::string::npos)
          found = spot.place.address;
    }
  });
  return found;
}

Error blocked(const std::string& objection, const std::string& why) {
  return fail(fmt::format("{}; it cannot be moved: {}", objection, why));
}

// ---- moving

int words_for(const Written& place, const std::vector<Move>& moves) {
  for (const Move& move : moves)
    if (move.area == place.area && move.first <= place.first_word && place.last_word <= move.last)
      return move.words;
  return 0;
}

Status move_memory(Memory& memory, const std::vector<Move>& moves, const Protocol& protocol) {
  for (auto& [address, hex] : memory) {
    const auto place = protocol.named(address, hex.size());
    const int words = place ? words_for(*place, moves) : 0;
    if (words == 0) continue;
    const auto moved = protocol.moved(address, words);
    if (!moved) return fail(fmt::format("{} cannot be moved by {} words", address, words));
    address = *moved;
  }
  return ok();
}

Status move_frame(Frame& frame, bool reply, const std::vector<Move>& moves, const Fields& stations,
                  const Protocol& protocol) {
  bool changed = false;
  for (const Bracket& bracket : brackets_of(frame.notation, reply, stations, protocol)) {
    for (const Protocol::AddressField& field : bracket.fields) {
      const int words = words_for(field.names, moves);
      if (words == 0) continue;
      const std::optional<Bytes> moved = protocol.moved_field(bracket.bytes, field, words);
      if (!moved || !patch(frame.notation, bracket, field.offset, *moved, stations))
        return fail(fmt::format("{} is not a moving field of {}", field.names.address, frame.text));
      changed = true;
    }
  }
  if (changed) frame.text = notation::print(frame.notation);
  if (changed) frame.wire.reset();
  return ok();
}

}  // namespace

Result<std::vector<Move>> plan_moves(const Case& source, int station, const WriteFence& fence,
                                     const Protocol& protocol) {
  std::vector<Move> moves;
  if (!source.transpose || source.config.value("role", "server") == "client") return moves;
  const Fields stations = protocol.fields_at(station);
  const std::vector<Spot> spots = spots_of(source, stations, protocol);
  std::vector<std::string> areas;
  for (const Written& write : writes_of(source, station, stations, protocol)) {
    const std::string objection = fence.objection({write}, protocol);
    if (objection.empty() || std::ranges::count(areas, write.area) > 0) continue;
    const std::vector<Words> allowed = fence.allowed(write.area, protocol.output_areas());
    if (allowed.empty()) return fail(objection);
    if (write.unknown()) return blocked(objection, "its target cannot be told");
    const std::vector<Words> clusters = clusters_of(spots, write.area);
    if (clusters.empty()) return blocked(objection, "its address is not a moving field");
    if (const std::string end = about_an_end(spots, write.area, protocol); !end.empty())
      return blocked(objection, end);
    const std::vector<Move> placed = Mover(spots, write.area, allowed).place(clusters);
    if (placed.empty())
      return blocked(objection, fmt::format("{} has no room, with as many digits, for {}",
                                            text_of(allowed, write.area, protocol),
                                            text_of(clusters, write.area, protocol)));
    moves.insert(moves.end(), placed.begin(), placed.end());
    areas.push_back(write.area);
  }
  if (moves.empty()) return moves;
  if (const std::string name = name_elsewhere(source, spots, stations, protocol); !name.empty())
    return fail(
        fmt::format("it cannot be moved: {} stands in its frame where it is no address", name));
  const Result<Case> moved = moved_case(source, station, moves, protocol);
  if (!moved) return fail("it cannot be moved: " + moved.error().message);
  if (const std::string still =
          fence.objection(writes_of(*moved, station, stations, protocol), protocol);
      !still.empty())
    return fail(fmt::format("{}; it is moved as far as it can be", still));
  return moves;
}

Result<Case> moved_case(const Case& source, int station, const std::vector<Move>& moves,
                        const Protocol& protocol) {
  const Fields stations = protocol.fields_at(station);
  Case moved = source;
  if (moves.empty()) return moved;
  if (Status done = move_memory(moved.memory, moves, protocol); !done) return done.error();
  for (Step& step : moved.steps) {
    if (Status done = move_memory(step.memory, moves, protocol); !done) return done.error();
    for (Frame& frame : step.frames)
      if (Status done =
              move_frame(frame, step.kind == Step::Kind::expect, moves, stations, protocol);
          !done)
        return done.error();
  }
  return moved;
}

std::string note_of(const Move& move, const Protocol& protocol) {
  const auto name = [&](std::uint32_t word) {
    const std::vector<Protocol::Place> places = protocol.places({move.area, word, word, ""});
    return places.empty() ? protocol.spell(move.area, word) : places.front().address;
  };
  const auto range = [&](std::uint32_t first, std::uint32_t last) {
    return first == last ? name(first) : name(first) + "-" + name(last);
  };
  const auto by = static_cast<std::uint32_t>(move.words);  // wraps round for a move down
  return fmt::format("transposed: {} to {}", range(move.first, move.last),
                     range(move.first + by, move.last + by));
}

}  // namespace fieldproof::safety
