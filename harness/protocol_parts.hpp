// What many protocols have, and some have not: Protocol hands out those that it has.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/bytes.hpp"
#include "src/base/result.hpp"

namespace fieldproof::harness {

/// How much a read can ask for at once.
struct ReadLimit {
  std::string_view what;  // "bytes of a continuous read"
  unsigned printed = 0;   // in the manual
  unsigned most = 0;      // more cannot be asked for
  std::function<Bytes(unsigned count)> request{};
};

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
  /// Reads of memory that every device has; MemoryRequests::answers tells whether one is taken.
  virtual std::vector<ReadLimit> read_limits() const { return {}; }
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

  /// Does `reply`, whole and with the right check, answer this request: the same station and
  /// command, and as many digits as it asks for, or a refusal? A late reply to another may not.
  virtual bool answers(ByteView request, ByteView reply) const = 0;
  /// Do this request and its reply carry a check? Without one a damaged request may do harm
  /// elsewhere, and a damaged reply looks like a sound one.
  virtual bool is_checked([[maybe_unused]] ByteView request) const { return true; }
  /// What a write request sets where it arrives whole: addresses and their digits. Empty: nothing,
  /// or nobody can tell; only for requests that are not checked.
  virtual std::vector<std::pair<std::string, std::string>> sets(
      [[maybe_unused]] ByteView request) const {
    return {};
  }
  /// The same request in a mode in which neither it nor its reply carries a check; empty: there is
  /// no such mode.
  virtual Bytes without_check([[maybe_unused]] ByteView request) const { return {}; }
};

/// Tables of a manual as src/ has them.
class Tables {
 public:
  virtual ~Tables() = default;

  /// Checks a `table` vector; the error says what the table holds instead.
  virtual Status check_table(const nlohmann::json& facts) const = 0;
};

/// Addresses and actions of vectors that tell as text whether a device can have them; elsewhere
/// only a device can tell.
class Texts {
 public:
  virtual ~Texts() = default;

  /// What is wrong with those of a vector (address and hex digits; `do`), for a device of `model`
  /// with `config`.
  virtual Status check_texts(std::string_view model, const nlohmann::json& config,
                             const std::vector<std::pair<std::string, std::string>>& memory,
                             const std::vector<std::string>& actions) const = 0;
};

}  // namespace fieldproof::harness
