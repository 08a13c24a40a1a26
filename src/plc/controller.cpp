#include "src/plc/controller.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/base/spelling.hpp"
#include "src/plc/device_action.hpp"

namespace fieldproof::plc {

Status Controller::add(unsigned channel, std::unique_ptr<LineService> service) {
  if (!lines_.try_emplace(channel, service.get()).second)
    return fail(fmt::format("cannot put two services on channel {}; a channel has one", channel));
  if (services_.empty()) main_channel_ = channel;
  take(std::move(service));
  return ok();
}

Status Controller::add(std::unique_ptr<NetworkService> service) {
  if (const Status added = ethernet_.add(*service); !added) return added;
  take(std::move(service));
  return ok();
}

void Controller::take(std::unique_ptr<Service> service) {
  service->set_run(run_);
  services_.push_back(std::move(service));
}

line::Device* Controller::line(unsigned channel) {
  const auto found = lines_.find(channel == 0 ? main_channel_ : channel);
  return found == lines_.end() ? nullptr : found->second;
}

Result<std::string> Controller::get_of_service(std::string_view name, std::size_t digits) const {
  if (services_.empty())
    return fail(fmt::format("cannot read {}: the device has no service; add one", name));
  if (!ethernet_.empty())
    if (std::optional<std::string> packets = ethernet_.packets(name, digits))
      return std::move(*packets);
  return services_.front()->get(name, digits);
}

void Controller::scan() {
  for (const auto& service : services_) service->scan();
}

Status Controller::act(std::string_view action) {
  if (action == "power_cycle") {
    for (const auto& service : services_) service->power_cycle();
    ethernet_.forget_packets();
    return ok();
  }
  if (action == "run" || action == "stop") {
    run_ = action == "run";
    for (const auto& service : services_) service->set_run(run_);
    return ok();
  }
  std::optional<Status> done;
  for (const auto& service : services_) {
    std::optional<Status> one = service->act(action);
    if (one && (!done || *done)) done = std::move(one);
  }
  return done ? *done : no_such_action(action);
}

Error Controller::no_such_action(std::string_view action) const {
  std::vector<std::string> names{"run", "stop", "power_cycle"};
  for (const auto& service : services_)
    for (std::string& name : service->actions())
      if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
  if (names.size() == 3) return parse_device_action(action).error();
  const std::vector<std::string_view> views(names.begin(), names.end());
  return fail(fmt::format("cannot do '{}': there is no such action; use one of {}{}", action,
                          fmt::join(names, ", "), suggestion(action, views)));
}

}  // namespace fieldproof::plc
