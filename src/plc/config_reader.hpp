// Values out of one JSON object. Numbers and booleans may be given as text: so they come from an
// endpoint's options.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/base/time.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::plc {

/// Is it an object with no other keys than these? The error lists them.
Status known_keys(const nlohmann::json& object, std::string_view what,
                  std::span<const std::string_view> keys);

/// "192.0.2.1": four numbers up to 255, without zeros in front.
bool is_ipv4(std::string_view text);

/// A key that is absent leaves `to` as it is. The first that is wrong stays in `error`; later calls
/// change nothing.
class ConfigReader {
 public:
  /// `what` is the object in messages: "the PLC's configuration". `object` must outlive the reader.
  ConfigReader(const nlohmann::json& object, std::string what)
      : object_(object), what_(std::move(what)) {}

  const std::optional<Error>& error() const { return error_; }

  /// `least` to `most`.
  void whole(const char* key, unsigned most, unsigned& to, unsigned least = 0);
  /// 0 to one minute, in milliseconds.
  void milliseconds(const char* key, Duration& to);
  /// true, false, 1, 0
  void boolean(const char* key, bool& to);
  void text(const char* key, std::string& to);
  /// An IPv4 address, or what can be the name of a host.
  void host(const char* key, std::string& to);
  /// One of two words; `to`: is it `yes`?
  void either(const char* key, std::string_view yes, std::string_view no, bool& to);
  void line(const char* key, line::LineSettings& to);

 private:
  const nlohmann::json* find(const char* key) const;
  void number(const char* key, double least, double most, const std::function<void(double)>& take);
  void wrong(const std::string& key, const nlohmann::json& value, const std::string& expected);

  const nlohmann::json& object_;
  std::string what_;
  std::optional<Error> error_;
};

}  // namespace fieldproof::plc
