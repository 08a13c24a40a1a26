// Memory of the device under test, by the best way there is: the back door of an emulator, the
// protocol itself (a device that asks answers nothing), a second channel of the same PLC.
#pragma once

#include <string>

#include "harness/endpoints/endpoint.hpp"
#include "harness/exchange/arming.hpp"
#include "harness/exchange/prepared_case.hpp"
#include "harness/protocol.hpp"

namespace fieldproof::exchange {

/// --aux: a second channel of the PLC under test, as server. Nothing is owned.
struct AuxLink {
  endpoints::Endpoint* endpoint = nullptr;  // none
  const harness::Protocol* protocol = nullptr;
  int station = 1;
};

class MemoryAccess {
 public:
  /// `arming` may be nullptr: then sets ask for nothing.
  MemoryAccess(endpoints::Endpoint& endpoint, const harness::Protocol& protocol, Duration patience,
               AuxLink aux = {}, Arming* arming = nullptr)
      : endpoint_(endpoint), protocol_(protocol), patience_(patience), aux_(aux), arming_(arming) {}

  /// Errors name the address and the reason; `refused()` then tells whether the device itself
  /// refused. Memory of a real client that nobody can set is left: the bench has seen that the line
  /// does not depend on it (Arming::objection).
  Status set(const PreparedCase& prepared, const std::string& address, const std::string& hex);
  Result<std::string> get(const PreparedCase& prepared, const std::string& address,
                          std::size_t digits);
  /// Is there a way to read it? Of a real client only over a second channel, and no counters.
  bool can_read(const PreparedCase& prepared, const std::string& address) const;
  /// The last error came from the device (a NAK, no answer), not from a way that does not exist.
  bool refused() const { return refused_; }
  /// The last request was not answered at all.
  bool silent() const { return silent_; }

  /// Over the wire, of a server, whatever the case.
  Status set(int station, const std::string& address, const std::string& hex);
  Result<std::string> get(int station, const std::string& address, std::size_t digits);
  /// What comes back to a request over the wire, as far as it came in time; empty: nothing.
  Result<Bytes> ask(int station, ByteView request) {
    return ask(Server{endpoint_, protocol_, station}, request);
  }

 private:
  /// A server that holds the memory.
  struct Server {
    endpoints::Endpoint& endpoint;
    const harness::Protocol& protocol;
    int station;
  };
  Server own(const PreparedCase& prepared) const {
    return {endpoint_, protocol_, prepared.station};
  }
  Server aux() const { return {*aux_.endpoint, *aux_.protocol, aux_.station}; }
  Status write(const Server& server, const std::string& address, const std::string& hex);
  Result<std::string> read(const Server& server, const std::string& address, std::size_t digits);
  Result<Bytes> ask(const Server& server, ByteView request);

  endpoints::Endpoint& endpoint_;
  const harness::Protocol& protocol_;
  Duration patience_;
  AuxLink aux_;
  Arming* arming_;
  bool refused_ = false, silent_ = false;
};

}  // namespace fieldproof::exchange
