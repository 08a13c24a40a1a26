// Finds XGT FEnet frames in the stream of one connection: the length field alone says where one
// ends (DECISIONS.md fenet/stream).
#pragma once

#include "src/plc/dedicated_server.hpp"

namespace fieldproof::xgt_fenet {

/// Any 20 bytes are a header, so no frame is ever broken. Holds at most one frame that is not
/// complete (65555 bytes).
class FrameSplitter : public plc::StreamSplitter {
 public:
  void receive(const Burst& burst, plc::FrameSink& sink) override;

 private:
  Bytes heard_;
};

}  // namespace fieldproof::xgt_fenet
