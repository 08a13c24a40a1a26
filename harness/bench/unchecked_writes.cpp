#include "harness/bench/unchecked_writes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

#include "harness/notation/beginning.hpp"

namespace fieldproof::bench {

using harness::Protocol;
using results::Event;
using safety::Reading;

namespace {

/// What came for a request that was sent.
struct Asked {
  Bytes request, reply;
};

std::vector<Asked> asked_in(const results::CaseResult& result) {
  std::vector<Asked> all;
  for (const Event& event : result.exchange) {
    if (event.kind == Event::Kind::sent) all.push_back({event.bytes, {}});
    if (event.kind == Event::Kind::received && !all.empty())
      all.back().reply.insert(all.back().reply.end(), event.bytes.begin(), event.bytes.end());
  }
  return all;
}

bool is_refusal(ByteView request, ByteView reply, const Protocol& protocol) {
  return protocol.sound_reply(request, reply) && !protocol.write_reply(reply);
}

/// As a whole, or each of the frames that were sent in one, by an answer of its own.
bool is_refused(const Asked& one, const Protocol& protocol) {
  if (is_refusal(one.request, one.reply, protocol)) return true;
  ByteView requests = one.request, replies = one.reply;
  const auto take = [&](ByteView& from) {
    const std::size_t size = protocol.frame_length(from).value_or(from.size());
    return std::exchange(from, from.subspan(size)).first(size);
  };
  while (!requests.empty() && !replies.empty())
    if (!is_refusal(take(requests), take(replies), protocol)) return false;
  return !one.reply.empty() && requests.empty() && replies.empty();
}

/// Some devices take lower-case digits, and answer with upper-case ones.
bool same(const std::string& digits, const std::string& others) {
  return from_hex(digits) == from_hex(others);
}

/// May they have changed it?
bool meets(const auto& place, const std::vector<Protocol::Written>& written,
           const Protocol& protocol) {
  const auto own = protocol.named(place.first, place.second.size());
  return !own || std::ranges::any_of(written, [&](const Protocol::Written& one) {
    return one.unknown() || own->overlaps(one);
  });
}

}  // namespace

bool writes_without_check(ByteView request, const Protocol& protocol) {
  if (protocol.on_network() || !protocol.memory()) return false;  // a network has its own
  return !protocol.written_by(request).empty() &&
         (!protocol.memory()->is_checked(request) ||
          !harness::faultless(protocol.explain_as(request, true)));
}

void UncheckedWrites::before(const std::vector<Bytes>& requests,
                             const std::vector<Protocol::Written>& changes,
                             const Protocol& protocol, safety::SavedMemory& memory) {
  writes_.clear();
  for (const Bytes& request : requests) {
    Write& write = writes_.emplace_back(Write{request, protocol.memory()->sets(request)});
    const auto changed = [&](const Place& place) { return meets(place, changes, protocol); };
    if (std::erase_if(write.sets, changed) > 0) write.shows = false;
    for (const auto& [address, digits] : write.sets) {
      const Reading held = memory.look(address, digits.size());
      write.shows = write.shows && held.kind == Reading::Kind::digits && !same(held.digits, digits);
    }
  }
}

void UncheckedWrites::after(const results::CaseResult& result, const Protocol& protocol,
                            safety::SavedMemory& memory, bool cut_off) {
  std::vector<Write*> taken;
  Due due;
  for (const Asked& one : writes_.empty() ? std::vector<Asked>() : asked_in(result)) {
    const std::vector<Protocol::Written> written = protocol.written_by(one.request);
    if (written.empty() || is_refused(one, protocol) || (one.reply.empty() && !cut_off)) continue;
    std::erase_if(due, [&](const auto& place) { return meets(place, written, protocol); });
    const auto write = std::ranges::find(writes_, one.request, &Write::request);
    if (write == writes_.end()) continue;
    if (std::ranges::find(taken, &*write) == taken.end())
      taken.push_back(&*write);
    else
      write->shows = false;  // the first of them may have gone astray
    for (const auto& [address, digits] : write->sets) {
      // A request may name a word twice: the last one counts.
      if (const auto own = protocol.named(address, digits.size()))
        std::erase_if(due, [&](const auto& place) { return meets(place, {*own}, protocol); });
      due.insert_or_assign(address, digits);
    }
  }
  for (Write* write : taken) {
    const bool lost = is_lost(*write, due, memory);
    if (!lost && write->shows) continue;
    (lost ? lost_ : unseen_)
        .push_back(fmt::format("{} in {}", notation::print_beginning(write->request), result.id));
  }
  writes_.clear();
}

/// Something else stands there, or nobody can see it.
bool UncheckedWrites::is_lost(Write& write, const Due& due, safety::SavedMemory& memory) {
  bool lost = false;
  write.shows = write.shows && !write.sets.empty();
  for (const auto& [address, digits] : write.sets) {
    const auto last = due.find(address);
    const bool over = last == due.end() || !same(last->second, digits);  // written over since
    const Reading holds = over ? Reading{} : memory.look(address, digits.size());
    const bool none = over || holds.kind == Reading::Kind::refused;
    write.shows = write.shows && !none;
    lost = lost || (!none && (holds.kind != Reading::Kind::digits || !same(holds.digits, digits)));
  }
  return lost;
}

std::string UncheckedWrites::doubtful(bool bad_line) const {
  constexpr std::size_t most = 10;
  std::vector<std::string> all = lost_;
  if (bad_line || !lost_.empty()) all.insert(all.end(), unseen_.begin(), unseen_.end());
  if (all.empty()) return {};
  const std::size_t count = all.size();
  all.resize(std::min(count, most));
  return fmt::format(
      "{}{}: without a check, or with a wrong one; the device did not refuse it, and what it names "
      "does not show that it came undamaged: it may have changed any other word",
      fmt::join(all, ", "), count > most ? fmt::format(" and {} more", count - most) : "");
}

}  // namespace fieldproof::bench
