#include "harness/safety/saved_memory.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <tuple>

namespace fieldproof::safety {

using harness::Protocol;

namespace {
constexpr std::size_t word_digits = 4;
}

std::vector<Protocol::Written> joined(std::vector<Protocol::Written> written) {
  std::erase_if(written, [](const Protocol::Written& one) { return one.unknown(); });
  std::ranges::sort(written, {}, [](const Protocol::Written& one) {
    return std::tuple(one.area, one.contacts, one.first_word);
  });
  std::vector<Protocol::Written> result;
  for (Protocol::Written& one : written) {
    const bool meets = !result.empty() && result.back().area == one.area &&
                       result.back().contacts == one.contacts &&
                       one.first_word <= result.back().last_word + 1;
    if (meets)
      result.back().last_word = std::max(result.back().last_word, one.last_word);
    else
      result.push_back(std::move(one));
  }
  return result;
}

bool SavedMemory::is_open(const Key& key) const {
  return std::ranges::any_of(journal_->open_entries(), [&](const OpenEntry& one) {
    return one.address == key.first && one.value.size() == key.second &&
           is_same_device(one.device, device_);
  });
}

/// The same memory, a word a place; empty where there are no such names.
std::vector<Protocol::Place> SavedMemory::words_of(const std::string& address,
                                                   std::size_t digits) const {
  const std::optional<Protocol::Written> all = protocol_.named(address, digits);
  std::vector<Protocol::Place> words;
  for (std::uint32_t word = 0; all && !all->contacts && word < digits / word_digits; ++word)
    for (Protocol::Place& place :
         protocol_.places({all->area, all->first_word + word, all->first_word + word, address}))
      words.push_back(std::move(place));
  return words;
}

/// A device that cannot read several words may still read one.
Reading SavedMemory::word_by_word(const Protocol::Place& place) {
  Reading all{Reading::Kind::digits, "", {}};
  for (const Protocol::Place& word : words_of(place.address, place.digits)) {
    Reading one = memory_.read(word.address, word_digits);
    if (one.kind != Reading::Kind::digits) return one;
    all.digits += one.digits;
  }
  return all;
}

Reading SavedMemory::read(const Protocol::Place& place) {
  Reading reading = memory_.read(place.address, place.digits);
  if (reading.kind == Reading::Kind::refused && place.declared && place.digits > word_digits)
    reading = word_by_word(place);
  return reading;
}

Status SavedMemory::save(const std::vector<Protocol::Written>& written) {
  failure_ = Reading::Kind::digits;
  if (written.empty()) return ok();
  if (!journal_) return fail("writes, and no journal is open that would keep what the device held");
  std::vector<OpenEntry> entries;
  std::optional<Error> unreadable;
  for (const Protocol::Written& one : joined(written)) {
    if (unreadable && lost()) break;  // it does not answer for the next either
    for (const Protocol::Place& place : protocol_.places(one)) {
      const Key key{place.address, place.digits};
      if (!known_.contains(key)) {
        const Reading reading = read(place);
        const bool absent = reading.kind == Reading::Kind::refused && !place.declared;
        if (reading.kind != Reading::Kind::digits && !absent) {
          failure_ = reading.kind;
          unreadable =
              Error{"cannot save what it writes: " + reading.why.message, reading.why.interrupted};
          if (port_failed()) return *unreadable;
          if (lost()) break;
          continue;
        }
        known_[key] = reading.digits;
      }
      if (!known_[key].empty() && !is_open(key))
        entries.push_back({0, device_, place.address, known_[key]});
    }
  }
  memory_.leave();  // the case has all connections of the device
  if (Status kept = journal_->save(entries); !kept) return kept;
  return unreadable ? Status(*unreadable) : ok();
}

/// A device that cannot write several words may still write one.
Status SavedMemory::write(const OpenEntry& entry, const std::string& holds) {
  const Status whole = memory_.write(entry.address, entry.value);
  if (whole || !memory_.refused() || entry.value.size() <= word_digits) return whole;
  const std::vector<Protocol::Place> words = words_of(entry.address, entry.value.size());
  if (words.size() * word_digits != entry.value.size()) return whole;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = entry.value.substr(i * word_digits, word_digits);
    if (holds.compare(i * word_digits, word_digits, word) == 0) continue;
    if (Status set = memory_.write(words[i].address, word); !set) return set;
  }
  return ok();
}

/// What a write came to is seen by reading: its answer may be lost, or late.
Status SavedMemory::put_back(const OpenEntry& entry) {
  constexpr int attempts = 3;
  const Protocol::Place place{entry.address, entry.value.size()};
  Status done = ok();
  for (int i = 0; i <= attempts; ++i) {
    Reading holds = memory_.look(place.address, place.digits);
    if (holds.kind == Reading::Kind::refused && place.digits > word_digits)
      holds = word_by_word(place);
    failure_ = holds.kind;
    if (holds.kind != Reading::Kind::digits) return holds.why;
    if (holds.digits == entry.value) return ok();
    if (!done && memory_.refused()) return done;
    if (i == attempts)
      return fail(fmt::format("{} holds {} and not {}", entry.address, holds.digits, entry.value));
    done = write(entry, holds.digits);
  }
  return done;
}

std::string SavedMemory::open_places() const {
  std::string text;
  if (!journal_) return text;
  for (const OpenEntry& one : journal_->open_entries())
    if (is_same_device(one.device, device_))
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", one.address, one.value);
  return text;
}

std::string SavedMemory::restore() {
  std::string problem;
  if (!journal_) return problem;
  const std::vector<OpenEntry> entries = journal_->open_entries();
  for (auto one = entries.rbegin(); one != entries.rend(); ++one) {
    if (!is_same_device(one->device, device_)) continue;
    Status done = put_back(*one);
    if (done) done = journal_->restored(*one);
    if (!done && problem.empty()) why_ = done.error();
    if (!done && problem.empty()) problem = why_.message;
    if (!done && (port_failed() || lost())) break;  // nobody answers the next either
  }
  memory_.leave();
  return problem;
}

}  // namespace fieldproof::safety
