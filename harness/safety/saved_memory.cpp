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
Result<std::string> SavedMemory::word_by_word(const Protocol::Place& place) {
  std::string value;
  for (const Protocol::Place& word : words_of(place.address, place.digits)) {
    const Result<std::string> digits = memory_.get(device_.station, word.address, word_digits);
    if (!digits) return digits.error();
    value += *digits;
  }
  return value;
}

Result<std::string> SavedMemory::read(const Protocol::Place& place) {
  Result<std::string> value = memory_.get(device_.station, place.address, place.digits);
  endpoint_failed_ = !value && !memory_.refused() &&
                     protocol_.read_requests(device_.station, place.address, place.digits);
  if (!value && memory_.refused() && place.declared && place.digits > word_digits)
    value = word_by_word(place);
  if (value && value->size() != place.digits)
    return fail(fmt::format("cannot read {}: {} digits came, {} are due", place.address,
                            value->size(), place.digits));
  return value;
}

Status SavedMemory::save(const std::vector<Protocol::Written>& written) {
  if (written.empty()) return ok();
  if (!journal_) return fail("writes, and no journal is open that would keep what the device held");
  const exchange::Leaving leaving(memory_);  // the case has all connections of the device
  std::vector<OpenEntry> entries;
  std::optional<Error> unreadable;
  for (const Protocol::Written& one : joined(written)) {
    for (const Protocol::Place& place : protocol_.places(one)) {
      const Key key{place.address, place.digits};
      if (!known_.contains(key)) {
        const Result<std::string> value = read(place);
        const bool absent = !value && memory_.refused() && !place.declared;
        if (!value && !absent) {
          port_failed_ = endpoint_failed_;
          unreadable = Error{fmt::format("cannot save what it writes: {}", value.error().message),
                             value.error().interrupted};
          if (port_failed_) return *unreadable;
          continue;
        }
        known_[key] = value ? *value : "";
      }
      if (!known_[key].empty() && !is_open(key))
        entries.push_back({0, device_, place.address, known_[key]});
    }
  }
  if (Status kept = journal_->save(entries); !kept) return kept;
  return unreadable ? Status(*unreadable) : ok();
}

Status SavedMemory::write(const OpenEntry& entry, const std::string& holds) {
  const Status whole = memory_.set(device_.station, entry.address, entry.value);
  if (whole || entry.value.size() <= word_digits) return whole;
  const std::vector<Protocol::Place> words = words_of(entry.address, entry.value.size());
  if (words.size() * word_digits != entry.value.size()) return whole;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string word = entry.value.substr(i * word_digits, word_digits);
    if (holds.compare(i * word_digits, word_digits, word) == 0) continue;
    if (Status set = memory_.set(device_.station, words[i].address, word); !set) return set;
  }
  return ok();
}

Status SavedMemory::put_back(const OpenEntry& entry) {
  const Protocol::Place place{entry.address, entry.value.size()};
  Result<std::string> holds = read(place);
  if (!holds) return holds.error();
  if (*holds == entry.value) return ok();
  if (Status written = write(entry, *holds); !written) return written;
  holds = read(place);
  if (!holds) return holds.error();
  if (*holds == entry.value) return ok();
  return fail(fmt::format("{} holds {} and not {}", entry.address, *holds, entry.value));
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
  const exchange::Leaving leaving(memory_);
  const std::vector<OpenEntry> entries = journal_->open_entries();
  for (auto one = entries.rbegin(); one != entries.rend(); ++one) {
    if (!is_same_device(one->device, device_)) continue;
    Status done = put_back(*one);
    if (done) done = journal_->restored(*one);
    if (!done && problem.empty()) problem = done.error().message;
    if (!done && (memory_.silent() || !memory_.refused())) break;  // nobody answers the next either
  }
  return problem;
}

}  // namespace fieldproof::safety
