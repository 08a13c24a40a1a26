#include "src/plc/multi_drop.hpp"

#include <algorithm>

namespace fieldproof::plc {

void MultiDrop::receive(const Burst& burst) {
  for (const auto& device : devices_) device->line()->receive(burst);
}

std::optional<Time> MultiDrop::wake_at() const {
  std::optional<Time> first;
  for (const auto& device : devices_)
    if (const std::optional<Time> wake = device->line()->wake_at();
        wake && (!first || *wake < *first))
      first = wake;
  return first;
}

Bytes MultiDrop::advance(Time now) {
  for (const auto& sender : devices_) {
    Bytes bytes = sender->line()->advance(now);
    if (bytes.empty()) continue;
    for (const auto& listener : devices_)
      if (listener != sender) listener->line()->receive({bytes, now, Duration{}});
    return bytes;  // whoever else has something to send is still awake
  }
  return {};
}

}  // namespace fieldproof::plc
