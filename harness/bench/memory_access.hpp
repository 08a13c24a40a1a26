// Memory of the device under test, by the best way there is: the back door of an emulator, else the protocol itself.
#pragma once

#include <string>

#include "harness/endpoints/endpoint.hpp"
#include "harness/protocol.hpp"

namespace fieldproof {

class MemoryAccess {
 public:
  MemoryAccess(Endpoint& endpoint, const Protocol& protocol, Duration patience)
      : endpoint_(endpoint), protocol_(protocol), patience_(patience) {}

  /// Errors name the address and the reason; `refused()` then tells whether the device itself refused.
  Status set(int station, const std::string& address, const std::string& hex);
  Result<std::string> get(int station, const std::string& address, std::size_t digits);
  /// The last error came from the device (a NAK, no answer), not from a way that does not exist.
  bool refused() const { return refused_; }
  /// The last request was not answered at all.
  bool silent() const { return silent_; }

 private:
  Result<Bytes> ask(ByteView request);

  Endpoint& endpoint_;
  const Protocol& protocol_;
  Duration patience_;
  bool refused_ = false, silent_ = false;
};

}  // namespace fieldproof
