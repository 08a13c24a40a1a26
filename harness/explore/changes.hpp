// What can be done to a request so that it asks something else, or is wrong in one place.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/explore/counts.hpp"
#include "harness/explore/random.hpp"
#include "harness/explore/request.hpp"
#include "harness/safety/brackets.hpp"
#include "harness/safety/fence.hpp"

namespace fieldproof::explore {

/// The words of an area that requests may name; empty: none.
using Room = std::function<std::vector<safety::WriteFence::Words>(const std::string& area)>;

/// Words of memory that the requests of one sequence come back to, so that one sees what another
/// did: by area.
class HotWords {
 public:
  /// `room`: where requests may go to.
  explicit HotWords(Room room) : room_(std::move(room)) {}

  /// A word near one of them, or as far from one as a lost address bit takes it, or anywhere there
  /// is room; nothing where there is none.
  std::optional<std::uint32_t> word(const std::string& area, Random& random);

 private:
  Room room_;
  std::map<std::string, std::uint32_t> words_;
};

/// Refers to the protocol.
class Changes {
 public:
  static constexpr std::array<std::string_view, 9> kinds{
      "elsewhere", "field", "damage", "pause", "resized", "letters", "order", "station", "twice"};

  /// `line`: pauses in a frame can be kept to the millisecond, and nobody else is on it.
  Changes(const harness::Protocol& protocol, int station, bool line, Counts counts)
      : protocol_(protocol),
        station_(station),
        line_(line),
        fields_(protocol.fields_at(station)),
        counts_(std::move(counts)) {}
  const Counts& counts() const { return counts_; }

  /// Does one of `kinds` to a request, and says so in it. False: it cannot be done to this one.
  bool make(std::string_view kind, Request& request, HotWords& hot, Random& random) const;

  /// Other memory, and other data: its checks and lengths follow.
  bool elsewhere(Request& request, HotWords& hot, Random& random) const;
  /// Another value of one field: one more, one less, none, all, any.
  bool field(Request& request, Random& random) const;
  /// As a bad line makes it: a bit, a byte, two frames in one. No check follows.
  bool damage(Request& request, Random& random) const;
  /// A pause within the frame.
  bool pause(Request& request, Random& random) const;

  /// More or less of it: a right request. `wish`: as much; else any.
  bool resized(Request& request, std::optional<std::uint32_t> wish, Random& random) const;
  /// A letter in the other case; the check follows.
  bool letters(Request& request, Random& random) const;
  /// Two fields beside each other change places; the check follows.
  bool order(Request& request, Random& random) const;
  /// To another station. Not where somebody else could answer.
  bool station(Request& request, Random& random) const;
  /// The same again without a pause.
  bool twice(Request& request) const;

  /// A request that reads what this one names, or what lies beside it; nothing where nobody can.
  std::optional<Request> look_at(const Request& request, Random& random) const;
  /// The same of any memory that the device has.
  std::optional<Request> look_anywhere(Request like, HotWords& hot, Random& random) const;
  /// A request that reads a word past the last one of an area.
  std::optional<Request> look_past(Request like, Random& random) const;
  /// The same that registers something under another number; nothing where it does not.
  std::optional<Request> with_registration(const Request& request, unsigned number) const;
  /// The memory that it names.
  std::vector<harness::Protocol::Written> named_by(const Request& request) const;

 private:
  std::optional<Request> read(Request like, const harness::Protocol::Written& names,
                              bool declared = true) const;
  bool move(Request& request, const safety::Bracket& bracket, HotWords& hot, Random& random) const;
  bool put(Request& request, const safety::Bracket& bracket, const harness::Field& field,
           ByteView bytes) const;

  const harness::Protocol& protocol_;
  int station_;
  bool line_;
  notation::Fields fields_;
  Counts counts_;
};

}  // namespace fieldproof::explore
