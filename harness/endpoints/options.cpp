#include "harness/endpoints/options.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

#include "src/base/spelling.hpp"

namespace fieldproof {

Status check_options(const EndpointName& name, std::initializer_list<std::string_view> own) {
  std::vector<std::string_view> known{"protocol", "station", "floor_ms"};
  known.insert(known.begin(), own.begin(), own.end());
  for (const auto& [key, value] : name.options) {
    if (std::ranges::find(known, key) != known.end()) continue;
    std::string list;
    for (const std::string_view one : known) list += (list.empty() ? "" : ", ") + std::string(one);
    return fail("cannot open " + name.kind + ':' + name.target + ": unknown option '" + key + "'" + suggestion(key, known) +
                "; its options are " + list);
  }
  return ok();
}

Result<Duration> timing_floor(const EndpointName& name) {
  const std::string text = name.option("floor_ms", "20");
  int value = -1;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size() || value < 0 || value > 10'000) {
    return fail("cannot open " + name.kind + ':' + name.target + ": floor_ms is '" + text + "'; write milliseconds from 0 to 10000");
  }
  return Duration(std::chrono::milliseconds(value));
}

}  // namespace fieldproof
