// What `explore` sends to a device, one part after another, and the rule by which it is invented.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/explore/random.hpp"
#include "harness/protocol.hpp"
#include "harness/vectors/case.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::explore {

/// What a part is about: "rss", "field"; of a client "read single", "late".
struct Topic {
  std::string name, kind;
};

/// Parts that can be left out one by one: requests to a server, or stimuli of a client. It holds
/// what our own device did with them; it never changes. Refers to its Inventor.
class Sequence {
 public:
  using Own = std::unique_ptr<const Sequence>;
  virtual ~Sequence() = default;

  virtual std::size_t parts() const = 0;
  /// Requests that the device gets, or should send.
  virtual std::uint64_t requests() const = 0;
  virtual Topic topic(std::size_t part) const = 0;
  /// How our own device took it: "answered", "silence", "0003", "closed".
  virtual std::string outcome(std::size_t part) const = 0;
  /// Holds another device to what ours did.
  virtual vectors::Case as_case(std::string id) const = 0;
  /// The part in which a device did otherwise; the last where nobody says.
  virtual std::size_t failing_part(const results::CaseResult& result) const = 0;
  /// What was wrong there, without what is different each time: the same fault has the same mark.
  virtual std::string mark(std::size_t part, const results::CaseResult& result) const = 0;

  /// The same without so many parts, of which one is left at least: our own device is asked anew.
  /// Nothing: what it then does cannot be told in order.
  virtual Own without(std::size_t from, std::size_t count) const = 0;
  /// Things that are set up for it, and could be left out, too.
  virtual std::size_t settings() const = 0;
  virtual Own without_settings(std::size_t from, std::size_t count) const = 0;
};

/// Makes sequences by seed.
class Inventor {
 public:
  virtual ~Inventor() = default;

  /// There is something to send.
  virtual bool can_invent() const = 0;
  /// Nothing: nothing that may be sent came to mind.
  virtual Sequence::Own invent() = 0;
  /// A part of this topic had this outcome for the first, second, .. time: what showed something
  /// new comes more often.
  virtual void note(const Topic& topic, std::uint64_t times) = 0;

  /// The device did all of it as the sequence has it.
  virtual void done(const Sequence&) {}
  /// It did otherwise in this part, of which nobody says what is right, and showed the same twice:
  /// that is how it reads the manuals. False: somebody says, or it has answered this before.
  virtual bool learn(const Sequence&, std::size_t, const results::CaseResult&) { return false; }
  virtual bool may_learn(const Sequence&, std::size_t) const { return false; }
  /// It could not be run as this device is: no more of the kind. False: it is the only kind.
  virtual bool give_up(const Sequence&) { return false; }
  /// What is known of the device beside its answers by topic, in lines: services by answer, their
  /// limits and those of areas, and its own readings.
  struct Known {
    std::vector<std::string> services, limits, readings;
  };
  virtual Known known() const { return {}; }
};

/// How often topics come.
class Weights {
 public:
  void add(const std::string& topic) { weights_[topic] = first; }
  const std::string& choose(Random& random) const;
  /// Of one that was not added: nothing.
  void note(const std::string& topic, std::uint64_t times);

 private:
  static constexpr std::size_t first = 4, news = 16, least = 1;
  std::map<std::string, std::size_t> weights_;
};

/// A list without `count` of its items, or all that there are from `from` on.
template <typename Item>
std::vector<Item> left_out(std::vector<Item> items, std::size_t from, std::size_t count) {
  const auto first = items.begin() + static_cast<std::ptrdiff_t>(from);
  items.erase(first, first + static_cast<std::ptrdiff_t>(std::min(count, items.size() - from)));
  return items;
}

/// A step of this kind, and no more.
vectors::Step step_of(vectors::Step::Kind kind);

/// What a case of `explore` rests on.
inline constexpr const char* own_model_decision = "explore/own-model";
inline constexpr const char* own_model_sentence =
    "`explore` holds a device to what fieldproof's own device answers, also where no manual prints "
    "it.";
inline constexpr const char* as_before_decision = "explore/as-before";
inline constexpr const char* as_before_sentence =
    "Where nobody says what is right, `explore` holds a device to what it answered itself before.";
/// A case that is held to our own model, without id, steps and basis.
vectors::Case case_of_own_model(const harness::Protocol& protocol);

}  // namespace fieldproof::explore
