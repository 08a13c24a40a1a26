// The map of what a device was seen to do: services by their answers, how much of each it grants,
// and where its memory ends.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/explore/counts.hpp"
#include "harness/explore/random.hpp"

namespace fieldproof::explore {

class Limits {
 public:
  /// A right request, and how it was answered. `words`: of memory that it named.
  void note(const std::string& service, const std::optional<Count>& count,
            const std::vector<harness::Protocol::Written>& words, const std::string& sort);

  /// Between what was granted and what was not: where the limit lies; nothing where it is known.
  std::optional<std::uint32_t> count_between(const std::string& service) const;

  /// "r SS: answered 120, 0003 more than 16 blocks 4".
  std::vector<std::string> services() const;
  /// "r SS, block count: 1 to 16 accepted, 17 refused with 0003 ..", "area M: M0 to M1023 good,
  /// M1024 refused with ..". `spelling` names words.
  std::vector<std::string> limits(const harness::Protocol& spelling) const;

 private:
  /// How numbers were answered: those of a count, or words of an area.
  struct Scale {
    std::string name;
    std::optional<std::uint32_t> first, last;             // answered
    std::map<std::string, std::uint32_t> lowest_refused;  // above the last, by answer

    void note(std::uint32_t number, const std::string& sort);
    std::optional<std::uint32_t> middle() const;
    /// ", 17 refused with 0003": the nearest.
    std::string refused(const std::function<std::string(std::uint32_t)>& spell) const;
  };
  std::map<std::string, std::map<std::string, std::uint64_t>> answers_;
  std::map<std::string, Scale> counts_, areas_;
};

}  // namespace fieldproof::explore
