// What `explore` sends: requests of the vectors, and what becomes of them by a change.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/notation/notation.hpp"
#include "harness/protocol.hpp"
#include "harness/vectors/case.hpp"

namespace fieldproof::explore {

/// What a vector says of the answer to a request of it.
struct Clause {
  std::string answer;         // its sort (sort_of); empty: it says nothing that can be told in one
  bool of_decisions = false;  // it binds as they do
  vectors::Source source;
  std::vector<vectors::Decision> decisions;
};

struct Request {
  std::string topic;   // of its vector: "rss"
  std::string vector;  // its id
  notation::Notation notation;
  std::string kind =
      "printed";         // of the change: one of Changes::kinds, "look", "past"; "printed": none
  std::string change{};  // in words: "block count 01 becomes 02"
  std::vector<harness::Protocol::Written> names{};  // memory that it named before it was damaged
  Clause clause{};                                  // of its vector
  bool off_before = false;  // the power of the device goes off and on before it is sent
  std::size_t link = 0;     // of the connections to a server on a network
};

/// As a client may send it: not as a bad line makes it, of which hardly a manual says anything.
bool is_a_right_frame(const Request& request);

/// How an answer reads where only its sort counts: "answered", "silence", "0003".
std::string sort_of(ByteView answer, const harness::Protocol& protocol);

/// The requests of these cases that go to a server of `protocol` on a device of `model`, each once:
/// those that say all of their bytes.
std::vector<Request> requests_of(const std::vector<vectors::Case>& cases,
                                 const harness::Protocol& protocol, std::string_view model);

/// Does it say no more of its device than the station?
bool is_of_any_set_up(const vectors::Case& one);

/// One word as vectors name it, of memory that no request can write too; nothing where there are no
/// words.
std::optional<harness::Protocol::Place> place_of(const harness::Protocol::Written& word,
                                                 const harness::Protocol& protocol);

/// Bytes as they are: no check follows them.
notation::Notation raw_notation(ByteView bytes);

/// A frame as a bracket in which station and checks are words, so that it can be moved, and what
/// vectors leave open in the header of every reply is open; where that would not be the same bytes,
/// those.
notation::Notation notation_of(ByteView frame, bool request, const harness::Protocol& protocol,
                               int station);

}  // namespace fieldproof::explore
