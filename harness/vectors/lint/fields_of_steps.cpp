#include "harness/vectors/lint/fields_of_steps.hpp"

#include <fmt/format.h>

namespace fieldproof::vectors {

Result<notation::Fields> FieldsOfSteps::next(const Step& step) {
  const Result<std::string> link = links_.next(step);
  if (!link) return link.error();
  const std::string& named = step.link.protocol;
  const bool opens = step.kind == Step::Kind::open || step.kind == Step::Kind::expect_open;
  if (opens && !named.empty() && named != own_.name()) {
    const harness::Protocol* const other = known_.find(named);
    if (!other) return fail(fmt::format("there is no protocol '{}'", named));
    services_[*link] = other;
  }
  const auto service = services_.find(*link);
  if (service == services_.end()) return own_.fields_at(config_station(one_.config, 1).value_or(1));
  const nlohmann::json services = one_.config.value("services", nlohmann::json::object());
  return service->second->fields_at(
      config_station(services.value(std::string(service->second->name()), nlohmann::json::object()),
                     1)
          .value_or(1));
}

}  // namespace fieldproof::vectors
