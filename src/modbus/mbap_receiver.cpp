#include "src/modbus/mbap_receiver.hpp"

#include "src/modbus/mbap.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::modbus {

namespace service_status = plc::service_status;

void MbapReceiver::receive(const Burst& burst, plc::FrameSink& sink) {
  if (lost_) return;
  heard_.insert(heard_.end(), burst.bytes.begin(), burst.bytes.end());
  std::size_t taken = 0;
  while (const std::optional<MbapHeader> header = read_mbap(ByteView(heard_).subspan(taken))) {
    if (!header->length_is_possible()) {
      lost_ = true;
      heard_.clear();
      return sink.on_broken_frame(header->length < mbap_least_length ? service_status::not_modbus
                                                                     : service_status::too_long);
    }
    if (heard_.size() - taken < header->frame_size()) break;
    sink.on_frame(ByteView(heard_).subspan(taken, header->frame_size()), burst.end());
    taken += header->frame_size();
  }
  heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(taken));
}

void MbapReceiver::reset() {
  heard_.clear();
  lost_ = false;
}

}  // namespace fieldproof::modbus
