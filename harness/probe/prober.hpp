// Asks the questions of a plan on a line whose settings can be changed.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/endpoints/endpoint.hpp"
#include "harness/probe/diagnosis.hpp"

namespace fieldproof::probe {

/// Opens the line with these settings; the one opened before is closed by then.
using LineOpener =
    std::function<Result<std::unique_ptr<endpoints::Endpoint>>(const line::LineSettings& settings)>;

struct ProbeTiming {
  Duration wait = 500ms;    // for the first byte of an answer (the profiles' response_max)
  Duration late = 2600ms;   // instead, once an answer came later: the longest delay time is 2550 ms
                            // (Cnet EN table 4.3.1)
  Duration quiet = 100ms;   // no further byte for so long: the answer is over
  Duration listen = 1s;     // before the first question of all
  Duration starting = 10s;  // a device that the bench has just started may not hear what is asked
                            // earlier: those questions come once more at the end
  Duration budget{};        // no question begins later; 0: all are asked
};

/// One question and what came of it.
struct Observation {
  Trial trial;
  Heard heard;
  Diagnosis diagnosis;
  bool late = false;  // a reply to a question of before
};

struct Search {
  std::vector<Observation> observations;  // all but the silent ones, in order
  std::size_t trials = 0;                 // done, the silent ones too
  std::vector<Trial> asked;               // the same without listening, each once, in order
  std::vector<line::LineSettings> lines;  // that were tried
  std::vector<std::string> not_offered;   // settings that the port refused, and why
  bool interrupted = false;               // Ctrl-C: not all was tried
};

/// The questions that an observation suggests next: the station, protocol or character format that
/// showed itself.
std::vector<Trial> suggestions(const Observation& observation);

class Prober {
 public:
  /// `done` of `total` trials; called after each.
  using Progress =
      std::function<void(std::size_t done, std::size_t total, const Observation& last)>;

  Prober(LineOpener open, const harness::Protocols& known, ProbeTiming timing, Progress progress)
      : open_(std::move(open)), known_(known), timing_(timing), progress_(std::move(progress)) {}

  /// Until the first sure find, which is asked twice more; with `all` to the end of the plan.
  /// Errors are trouble of the port.
  Result<Search> run(std::vector<Trial> plan, bool all);

 private:
  bool known_line(const line::LineSettings& line) const;
  void insert_next(std::vector<Trial>& rest, const std::vector<Trial>& trials);
  Result<bool> try_next(const Trial& trial, std::vector<Trial>& rest);
  Result<Observation> observe(const Trial& trial);
  Result<bool> confirm(const Trial& trial);
  Result<bool> settle(const line::LineSettings& line);
  bool out_of_time(Duration grace = {});
  bool may_be_starting() const;
  Status listen(Time until, std::vector<Burst>& heard);
  void keep(const Observation& observation);

  LineOpener open_;
  harness::Protocols known_;
  ProbeTiming timing_;
  Progress progress_;
  std::unique_ptr<endpoints::Endpoint> endpoint_;
  line::LineSettings line_;
  std::vector<line::LineSettings> lines_;  // of the plan
  std::vector<line::LineSettings> refused_;
  std::vector<Trial> done_;
  std::optional<Time> begun_;
  Time opened_{};  // the present endpoint
  std::string first_refusal_;
  std::size_t total_ = 0;
  bool late_ = false;  // a reply came after its wait
  Search search_;
};

}  // namespace fieldproof::probe
