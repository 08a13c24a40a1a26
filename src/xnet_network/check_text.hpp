// What a vector says of PLCs on X-NET, checked as text before there is a device: addresses and
// actions.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/base/result.hpp"
#include "src/xnet_network/configuration.hpp"

namespace fieldproof::xnet {

/// No PLC can do `action`.
Error unknown_action(std::string_view action);
/// No servo counts what `address` asks for.
Error unknown_counter(std::string_view address);

class TextCheck {
 public:
  /// The PLCs of `config`, as make_network reads it. What is wrong with them is for that to tell:
  /// an unknown model makes all texts right.
  TextCheck(std::string_view model, const nlohmann::json& config);

  /// So many digits at an address that is set, or looked at.
  Status address(std::string_view address, std::size_t digits) const;
  /// As XnetNetwork::act takes it.
  Status action(std::string_view action) const;

 private:
  const Model* addressed(std::string_view& text) const;

  bool known_ = true;
  std::vector<std::pair<std::string, const Model*>> plcs_;  // by name, the first one first
};

}  // namespace fieldproof::xnet
