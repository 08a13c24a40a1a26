#include "src/xgt_fenet/splitter.hpp"

#include "src/xgt_fenet/header.hpp"

namespace fieldproof::xgt_fenet {

void FrameSplitter::receive(const Burst& burst, plc::FrameSink& sink) {
  heard_.insert(heard_.end(), burst.bytes.begin(), burst.bytes.end());
  std::size_t taken = 0;
  while (const std::optional<Header> header = read_header(ByteView(heard_).subspan(taken))) {
    if (heard_.size() - taken < header->frame_size()) break;
    sink.on_frame(ByteView(heard_).subspan(taken, header->frame_size()), burst.end());
    taken += header->frame_size();
  }
  heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(taken));
}

}  // namespace fieldproof::xgt_fenet
