#include "harness/bench/fingerprint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "harness/notation/beginning.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::bench {

using harness::Protocol;

namespace {

constexpr const char* areas_key = "areas";
constexpr std::uint32_t word_limit = 1u << 20;  // more than any name of these protocols can say
constexpr int attempts = 3;                     // at one word, before the answer counts as none

std::string address_of(const std::string& area, std::uint32_t word) {
  return fmt::format("%{}W{}", area, word);
}

class Reader {
 public:
  Reader(endpoints::Endpoint& endpoint, const Protocol& protocol, int station, Duration patience)
      : protocol_(protocol),
        station_(station),
        memory_({&endpoint, &protocol, station}, patience) {}

  /// The last word of an area; nothing where the device has no such area.
  Result<std::optional<std::uint32_t>> last_word(const Protocol::Area& area) {
    std::uint32_t there = 0, beyond = word_limit;  // the end lies between the two
    const auto look = [&](std::uint32_t word) -> Status {
      const Result<bool> answers = has(area.name, word);
      if (!answers) return answers.error();
      (*answers ? there : beyond) = word;
      return ok();
    };
    const Result<bool> present = has(area.name, 0);
    if (!present) return present.error();
    if (!*present) return std::optional<std::uint32_t>();
    for (const std::uint32_t end : area.last_words)
      for (const std::uint32_t word : {end, end + 1})
        if (word > there && word < beyond)
          if (const Status looked = look(word); !looked) return looked.error();
    while (beyond - there > 1) {
      const std::uint32_t middle = beyond == word_limit ? std::min(there * 2 + 1, word_limit - 1)
                                                        : there + (beyond - there) / 2;
      if (const Status looked = look(middle); !looked) return looked.error();
    }
    return std::optional(there);
  }

 private:
  /// Does the device have this word? A name that the protocol cannot form lies beyond every device.
  Result<bool> has(const std::string& area, std::uint32_t word) {
    const Result<std::vector<Bytes>> requests =
        protocol_.read_requests(station_, address_of(area, word), 4);
    if (!requests) return false;
    Bytes reply;
    for (int attempt = 0; attempt < attempts; ++attempt) {
      Result<Bytes> came = memory_.ask(requests->front());
      if (!came) return came.error();
      reply = std::move(*came);
      if (protocol_.frame_length(reply) == reply.size()) return bool(protocol_.read_reply(reply));
    }
    return fail(fmt::format(
        "cannot take the fingerprint: a read of {} gets {}", address_of(area, word),
        reply.empty() ? "no answer" : "what is no reply: " + notation::print_beginning(reply)));
  }

  const Protocol& protocol_;
  int station_;
  exchange::MemoryAccess memory_;
};

}  // namespace

Result<Fingerprint> read_fingerprint(endpoints::Endpoint& endpoint, const Protocol& protocol,
                                     int station, Duration patience) {
  const std::vector<Protocol::Area> areas = protocol.areas();
  if (areas.empty())
    return fail(fmt::format(
        "cannot take a fingerprint by {}: it has no areas whose ends tell devices apart",
        protocol.name()));
  Reader reader(endpoint, protocol, station, patience);
  Fingerprint found{{areas_key, ""}};
  for (const Protocol::Area& area : areas) {
    const Result<std::optional<std::uint32_t>> last = reader.last_word(area);
    if (!last) return last.error();
    if (!*last) continue;
    found[areas_key] += area.name;
    found[area.name] = fmt::format("0-{}", **last);
  }
  return found;
}

Status check_fingerprint(const Fingerprint& declared, const Protocol& protocol) {
  std::vector<std::string_view> keys{areas_key};
  const std::vector<Protocol::Area> areas = protocol.areas();
  for (const Protocol::Area& area : areas) keys.push_back(area.name);
  for (const auto& [key, value] : declared)
    if (std::ranges::find(keys, key) == keys.end())
      return fail(fmt::format(
          "fingerprint.{} is nothing that reads by {} find{}; take it with fieldproof probe "
          "ENDPOINT --fingerprint: {}",
          key, protocol.name(), suggestion(key, keys),
          areas.empty() ? "this protocol has none" : fmt::format("{}", fmt::join(keys, ", "))));
  return ok();
}

std::string fingerprint_difference(const Fingerprint& declared, const Fingerprint& found) {
  std::string text;
  for (const auto& [key, value] : declared) {
    const auto is = found.find(key);
    const std::string came = is == found.end() ? "none" : is->second;
    if (came == value) continue;
    text += fmt::format("{}{} {} declared, {} found", text.empty() ? "" : "; ",
                        key == areas_key ? "areas" : "area " + key + ':', value, came);
  }
  return text;
}

std::string to_string(const Fingerprint& fingerprint) { return nlohmann::json(fingerprint).dump(); }

}  // namespace fieldproof::bench
