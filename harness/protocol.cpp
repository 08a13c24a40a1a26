#include "harness/protocol.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace fieldproof {

nlohmann::json Protocol::write_config() const { return nlohmann::json::object(); }

bool Protocol::has_model(std::string_view model) const { return std::ranges::count(models(), model) > 0; }

}  // namespace fieldproof
