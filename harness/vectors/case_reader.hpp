// One vector to its cases: texts substituted, notation parsed, what is not readable named.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "harness/notation/pdu.hpp"
#include "harness/vectors/case.hpp"
#include "harness/vectors/json/each.hpp"

namespace fieldproof::vectors {

/// Reads the cases of one vector of one protocol, whose shape is right.
class CaseReader {
 public:
  /// `vector` outlives the reader. `file` is for messages. `dressing`: what the protocol makes of
  /// pdu(...); nullptr: it has none.
  CaseReader(const nlohmann::ordered_json& vector, std::string file,
             const notation::Dressing* dressing);

  /// The case of one combination of rows; throws Broken.
  Case read(const Combination& combination) const;

 private:
  const nlohmann::ordered_json& vector_;
  std::string file_;
  const notation::Dressing* dressing_;
};

/// The kind of a step with this key: "send", "do". Throws Broken where no step has it.
Step::Kind step_kind(std::string_view key);

}  // namespace fieldproof::vectors
