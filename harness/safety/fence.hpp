// The write fence: on a real device nothing is written outside the ranges that the engineer
// allowed.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/protocol.hpp"
#include "src/base/result.hpp"

namespace fieldproof::safety {

/// Protocols::read_word.
using WordReader = std::function<std::optional<harness::Protocol::WordName>(std::string_view)>;

class WriteFence {
 public:
  /// Adds an area ("M"), a word ("D0"), words ("M100-M199", as `words` reads their ends), or "all";
  /// several separated by commas. All is every area but physical outputs, which are written only
  /// when named. Errors name the part that is wrong.
  Status allow(const std::string& ranges, const WordReader& words);

  /// All there is, outputs too: of a device that is nobody's plant.
  void allow_everything() { ranges_.push_back({std::string(everything), 0, ~0u}); }

  /// Axes that may move: "1", "3-5", of a partner of the device "B:1", "B:all", and "all", of
  /// whatever there is; several separated by commas. `last` is the last that there is. Errors name
  /// the part that is wrong.
  Status allow_motion(const std::string& axes, unsigned last);
  /// Empty when that axis may; else what must be allowed: "moves axis 3 (MOTO ...); allow it with
  /// --allow-motion 3". An axis that nobody can tell is allowed with all.
  std::string motion_objection(std::string_view axis, std::string_view by) const;
  /// The same of all axes that writing there moves.
  std::string motion_objection(const std::vector<harness::Protocol::Written>& written,
                               const harness::Protocol& protocol) const;

  bool empty() const { return ranges_.empty(); }

  /// Empty when all of it is allowed; else what must be allowed: "writes %MW100; allow it with
  /// --allow-write M100".
  std::string objection(const std::vector<harness::Protocol::Written>& written,
                        const harness::Protocol& protocol) const;

  struct Words {
    std::uint32_t first = 0, last = 0;
  };
  /// What is allowed of an area, in the order of its words, joined where ranges meet.
  std::vector<Words> allowed(std::string_view area,
                             const std::vector<std::string_view>& output_areas) const;

 private:
  static constexpr std::string_view everything = "*";
  struct Range {
    std::string area;  // "all" for every area
    std::uint32_t first = 0, last = 0;
  };
  struct Axes {
    std::string of;  // "", "B:"; "all" of whatever there is
    std::uint32_t first = 0, last = 0;
  };
  bool allows(const harness::Protocol::Written& written,
              const std::vector<std::string_view>& output_areas) const;

  std::vector<Range> ranges_;
  std::vector<Axes> axes_;
};

}  // namespace fieldproof::safety
