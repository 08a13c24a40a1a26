#include "suites/broken/good_device.hpp"

#include <algorithm>

namespace fieldproof::broken {

Bytes GoodDevice::answer(ByteView frame) {
  now_ += 10s;  // far from the frame before: no gap is judged here
  device_->line()->receive(Burst{Bytes(frame.begin(), frame.end()), now_, {}});
  Bytes reply;
  while (const std::optional<Time> wake = device_->line()->wake_at()) {
    now_ = std::max(now_, *wake);
    const Bytes part = device_->line()->advance(now_);
    reply.insert(reply.end(), part.begin(), part.end());
  }
  return reply;
}

}  // namespace fieldproof::broken
