// What many protocols have, and some have not: Protocol hands out those that it has.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/bytes.hpp"
#include "src/base/result.hpp"

namespace fieldproof::harness {

/// A harmless request that any healthy device answers.
class Probing {
 public:
  virtual ~Probing() = default;

  /// Its reply cannot be mistaken for a reply to `tested` (empty: no such demand). Empty: there is
  /// none for this device, or none after that.
  virtual Bytes probing_request(int station, ByteView tested) const = 0;
  /// Has `reply` the form of a reply to it? Its check is not judged, only what tells it from
  /// others.
  virtual bool answers_probe(ByteView probe, ByteView reply) const = 0;
};

/// The requests that set, or read, memory through the protocol itself.
class MemoryRequests {
 public:
  virtual ~MemoryRequests() = default;

  /// Errors say why there is no way ("read only").
  virtual Result<std::vector<Bytes>> requests_to_write(int station, std::string_view address,
                                                       std::string_view hex) const = 0;
  virtual Result<std::vector<Bytes>> requests_to_read(int station, std::string_view address,
                                                      std::size_t digits) const = 0;
  /// Success when `reply` acknowledges a write request.
  virtual Status acknowledged(ByteView reply) const = 0;
  /// The hex digits in a reply to a read request; an error when it is a refusal or no such reply.
  virtual Result<std::string> digits_in(ByteView reply) const = 0;
};

/// Tables of a manual as src/ has them.
class Tables {
 public:
  virtual ~Tables() = default;

  /// Checks a `table` vector; the error says what the table holds instead.
  virtual Status check_table(const nlohmann::json& facts) const = 0;
};

}  // namespace fieldproof::harness
