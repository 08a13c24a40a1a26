// What one case came to: the only thing that reports see.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reports/results/reason.hpp"
#include "reports/results/section_titles.hpp"
#include "reports/results/verdict.hpp"
#include "src/base/burst.hpp"
#include "src/base/result.hpp"
#include "src/base/trace.hpp"

namespace fieldproof::results {

/// Of bytes that are too many to keep: what stands beside the first of them. Empty: all are kept.
struct Extract {
  std::uint64_t count = 0;  // of all
  Bytes tail{};             // the last of them
  std::string sha256{};     // of all: 64 digits

  bool empty() const { return count == 0; }
  /// `head`: how many are kept of the beginning.
  std::uint64_t left_out(std::size_t head) const { return count - head - tail.size(); }
  bool operator==(const Extract&) const = default;
};

/// A line of the exchange, as a frame monitor would show it.
struct Event {
  /// opened, closed (FIN), reset (RST): of a link; `by_device` tells who did it.
  enum class Kind { sent, received, note, opened, closed, reset };
  Kind kind = Kind::note;
  Time start{};
  Time end{};
  Bytes bytes;       // sent, received; the first of them, where there is an extract
  std::string text;  // frame notation of the bytes, or the note: "set %MW100 = 1234", "silence
                     // until here"
  int step = -1;  // the executed step whose bytes these are; -1: of none (a probe and its answer)
  bool surplus = false;    // bytes that no step was waiting for
  std::string link{};      // its name in the vector; empty: the only one
  std::uint16_t port = 0;  // the one that listens, of a connection or datagram; 0: a line
  Transport transport = Transport::tcp;
  bool by_device = false;  // opened, closed, reset: the device did it, not the bench
  Extract extract{};       // received: of a whole run of bytes, which came in many pieces
};

/// "sent", "received", ...
std::string_view to_string(Event::Kind kind);

/// What an executed step came to, besides the frames in the exchange.
struct StepOutcome {
  Time stimulus{};  // expect: the end of what the reply answers; wait: when it is over
  std::vector<std::pair<std::string, std::string>> memory;  // check: address, and what it held
  std::string refused;  // set, check, do: why it could not be done
  bool refused_by_device = false;
  bool passed_over = false;  // check: at a moment that the endpoint cannot keep; not judged
  bool timed = true;  // `stimulus` is a moment; not in files, where 0 is none or the beginning
};

/// Where a case was moved on a real device: what it names in these words of the area lies so many
/// words further on.
struct Move {
  std::string area;
  std::uint32_t first = 0, last = 0;  // in words
  int words = 0;

  bool operator==(const Move&) const = default;
};

/// What makes an exchange fit to be judged again (`fieldproof judge`).
struct Recording {
  std::string stimulus;       // fingerprint of all that was done to the device; empty: nothing was
  int station = 1;            // that the frames were made for
  std::vector<Move> moves{};  // of its addresses, before the frames were made
  std::vector<StepOutcome> steps;
  bool flooded = false;
  std::string dead;         // why the link counts as dead after the case
  Duration timing_floor{};  // what this link could show: JudgeRules
  Duration link_floor{};    // the part of it that is not the device's own: no smaller shift between
                            // runs counts
  Duration earliest{};      // below 0: a reply that begins earlier is not of its request
  Duration gap_floor{};     // silence inside a frame that the link may make itself
  Duration max_gap{};
  Duration period_tolerance{};

  bool empty() const { return stimulus.empty(); }
};

/// One field that differs: "block count", expected "01", received "00", hint "".
struct Difference {
  std::string field;
  std::string expected;
  std::string received;
  std::string hint;
};

/// When the answer of a step was due: by `until`, counted from the end of what it answers.
struct Due {
  Time from{}, until{};

  bool empty() const { return from == until; }
  bool operator==(const Due&) const = default;
};

struct CaseResult {
  std::string id;    // "xgt_cnet/rss/two_words", unique in a run together with `line` and `repeat`
  std::string line;  // step of a line matrix: "38400-8N1"; empty: there is none
  int repeat = 0;    // 0-based repetition
  std::string dut;   // which device, where the run has several (RunInfo::duts); else empty
  int rev = 1;
  std::string protocol;  // "xgt-cnet"
  std::string title;
  std::string level;     // must, should, info
  std::string basis;     // printed frame, printed rule, derived, decision
  std::string on_model;  // not on a wire: instruction, register, configuration, timing; else empty
  std::string manual, section, quote;

  Verdict verdict = Verdict::error;
  std::string message;             // one line: what is wrong and, where known, what to do
  std::vector<std::string> notes;  // transposition, line errors, waiver, reading taken
  std::string expected;            // notation of what had to come at the failing step
  Bytes expected_bytes;            // as far as the notation fixes them
  std::string expected_hex;        // with ?? for open bytes
  std::string received;            // notation of what came
  Bytes received_bytes;
  Extract received_extract;
  Due due;  // of the failing step
  std::vector<Difference> differences;
  std::vector<Event> exchange;
  Recording recording;
  Trace trace;                                  // of a model; its times are those of the exchange
  std::map<std::string, std::string> readings;  // named alternatives taken: type_echo = upper
  std::vector<double> response_ms;              // request's last byte to reply's first, each expect
  double seconds = 0;                           // wall clock
  std::string replay;                           // command that runs just this case again
};

/// What its times are shown from: the beginning of its exchange.
Time shown_from(const CaseResult& result);
/// Makes all of its times so much later.
void shift(CaseResult& result, Duration by);

/// Which device it is, as the engineer entered it: no command of these protocols reads it from the
/// device.
struct Identity {
  std::string name;  // in the bench file
  std::string maker, model, serial, firmware;
  std::string operator_name, notes;
  std::map<std::string, std::string> fingerprint;  // declared: what harmless reads must find
  std::map<std::string, std::string>
      fingerprint_found;  // by the bench; empty where it did not look

  bool operator==(const Identity&) const = default;
};

/// The fields that both have alike, the others empty.
Identity in_common(Identity a, const Identity& b);

/// One of several devices that shared a run.
struct DutInfo {
  std::string endpoint;
  std::map<std::string, std::string> properties;  // station, line
  Identity identity = {};
};

/// Words of a manual.
struct Passage {
  std::string manual, section, quote;
};

/// A mistake of a manual, once, with all its places.
struct ErratumInfo {
  std::string id, kind;
  std::string printed, right;
  std::string why, effect, doubt;  // `doubt` may be empty
  std::vector<Passage> places, proof;
  std::vector<std::string> vectors = {};  // of this run that were made by what is right
};

/// What a run is about: the first line of the NDJSON file and the head of each report.
struct RunInfo {
  std::string tool_version;
  std::string started;  // ISO 8601 with zone
  std::string endpoint, profile, command;
  std::string vectors_hash;
  std::map<std::string, std::string> properties;  // station, line, seed, options
  Identity identity = {};
  std::map<std::string, std::string> hashes = {};  // SHA-256 of tool, vectors, profile
  std::vector<ErratumInfo> errata = {};            // of the selected cases
  std::vector<DutInfo> duts =
      {};  // where there are several; `identity` then holds what they have in common
  std::map<std::string, SectionTitles> sections = {};  // of the selected cases, by manual
};

/// How a run ended: the last line of the NDJSON file; absent when it was killed.
struct RunEnd {
  std::string finished;
  double seconds = 0;
  int exit_code = 0;
  bool interrupted = false;
  std::string trouble;               // empty, or why the run stopped early
  std::string hint = {};             // which option would let it judge more: "with X: 250 more"
  std::vector<Reason> reasons = {};  // why the exit code is not 0

  /// One more; the exit code follows.
  void add(Reason reason);
};

}  // namespace fieldproof::results
