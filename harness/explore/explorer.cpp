#include "harness/explore/explorer.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>

#include "harness/vectors/fingerprint.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::explore {

using results::CaseResult;
using results::Verdict;

namespace {

constexpr std::size_t first_weight = 4, news_weight = 16, least_weight = 1;
constexpr std::size_t most_findings = 50;  // more are counted
constexpr int most_trials = 200;           // of shortening one finding
constexpr int confirmations = 3;

bool differs(Verdict verdict) { return verdict == Verdict::fail || verdict == Verdict::non_strict; }

Byte upper(Byte byte) { return static_cast<Byte>(std::toupper(byte)); }

/// The same fault shows in many sequences: by what was asked, and what was wrong, without numbers.
std::string mark_of(const Request& request, const CaseResult& result) {
  std::string words;
  for (const char c : result.message)
    if (!std::isdigit(static_cast<unsigned char>(c)) &&
        !std::isupper(static_cast<unsigned char>(c)))
      words += c;
  return fmt::format("{}/{}: {}", request.topic, request.kind, words);
}

/// The same answer in other letters: which ones a device writes is open in many places, and vectors
/// ask where it is not.
bool differs_in_letters_alone(const CaseResult& result) {
  return !result.received_bytes.empty() &&
         std::ranges::equal(result.expected_bytes, result.received_bytes, {}, upper, upper);
}

/// The request that the failing step answers; the last where nobody says.
std::size_t failing_request(const CaseResult& result, std::size_t requests) {
  std::size_t sent = 0;
  for (const results::Event& event : result.exchange)
    if (event.kind == results::Event::Kind::sent && event.step >= 0) ++sent;
  return std::min(sent == 0 ? 0 : sent - 1, requests - 1);
}

}  // namespace

Explorer::Explorer(Device device, Oracle oracle, std::vector<Request> requests, std::uint64_t seed)
    : device_(std::move(device)),
      oracle_(std::move(oracle)),
      requests_(std::move(requests)),
      changes_(*device_.protocol, device_.station, !device_.over_the_wire),
      random_(seed) {
  if (!device_.room)
    device_.room = [own = device_.protocol](const std::string& area) {
      const std::uint32_t words = own->words_of(area);
      return words == 0 ? std::vector<safety::WriteFence::Words>()
                        : std::vector<safety::WriteFence::Words>{{0, words - 1}};
    };
  std::erase_if(requests_, [&](const Request& one) { return !can_be_sent(one); });
  for (std::size_t i = 0; i < requests_.size(); ++i) {
    by_topic_[requests_[i].topic].push_back(i);
    weights_[requests_[i].topic] = first_weight;
  }
}

/// There is some room in each area that it names.
bool Explorer::can_be_sent(const Request& request) const {
  return std::ranges::all_of(changes_.named_by(request), [&](const auto& one) {
    return !device_.over_the_wire || !device_.room(one.area).empty();
  });
}

/// A topic by its weight, then one of its requests.
const Request& Explorer::chosen() {
  std::size_t sum = 0;
  for (const auto& [topic, weight] : weights_) sum += weight;
  std::size_t at = random_.below(sum);
  for (const auto& [topic, weight] : weights_) {
    if (at < weight) return requests_[random_.of(by_topic_[topic])];
    at -= weight;
  }
  return requests_.front();
}

/// Mostly short, sometimes long; many have nothing wrong in them.
std::vector<Request> Explorer::invent() {
  const std::size_t sort = random_.below(100);
  const std::size_t length = sort < 50   ? 1 + random_.below(4)
                             : sort < 90 ? 4 + random_.below(12)
                             : sort < 99 ? 16 + random_.below(45)
                                         : 60 + random_.below(200);
  const bool faultless = random_.chance(40);
  HotWords hot(device_.room);
  std::vector<Request> requests;
  // Where there is little room, most requests have none.
  for (std::size_t trial = 0; requests.size() < length && trial < 50 * length; ++trial) {
    if (!requests.empty() && random_.chance(20)) {  // what works once may not work often
      requests.push_back(Request(random_.of(requests)));
      continue;
    }
    if (!requests.empty() && random_.chance(30))  // what did it do?
      if (std::optional<Request> look =
              random_.chance(80) ? changes_.look_at(random_.of(requests), random_)
                                 : changes_.look_anywhere(random_.of(requests), hot, random_);
          look && has_room(*look)) {
        requests.push_back(std::move(*look));
        continue;
      }
    std::optional<Request> one = invent_one(faultless, hot);
    if (!one) continue;
    const bool pieces = one->kind == "damage" || one->kind == "pause";
    requests.push_back(std::move(*one));
    // What is left of a frame waits for more as long as its protocol says, a bench no longer than
    // it must: on real time nothing of the same sequence comes behind it.
    if (pieces && device_.over_the_wire) break;
  }
  return requests;
}

/// Nothing: it would go where no request may.
std::optional<Request> Explorer::invent_one(bool faultless, HotWords& hot) {
  Request one = chosen();
  if (random_.chance(85) || !has_room(one)) changes_.make("elsewhere", one, hot, random_);
  one.names = changes_.named_by(one);
  if (!faultless && random_.chance(50))
    changes_.make(Changes::kinds[1 + random_.below(Changes::kinds.size() - 1)], one, hot, random_);
  std::ranges::move(changes_.named_by(one), std::back_inserter(one.names));
  return has_room(one) ? std::optional(std::move(one)) : std::nullopt;
}

/// All that it names lies where requests may go.
bool Explorer::has_room(const Request& request) const {
  const Result<Bytes> bytes =
      safety::bytes_of(request.notation, device_.protocol->fields_at(device_.station));
  if (!bytes || !device_.allowed(*bytes)) return false;
  std::vector<harness::Protocol::Written> names = request.names;
  if (names.empty()) names = changes_.named_by(request);
  return std::ranges::all_of(names, [&](const harness::Protocol::Written& one) {
    return !device_.over_the_wire ||
           std::ranges::any_of(device_.room(one.area), [&](const auto& words) {
             return words.first <= one.first_word && one.last_word <= words.last;
           });
  });
}

/// Nothing: the model refuses to be asked so, or what it answers depends on what was before, which
/// nobody knows of a real device.
std::optional<Explorer::Sequence> Explorer::answered(std::vector<Request> requests,
                                                     const Memory* memory) {
  Sequence sequence{std::move(requests), {}, {}};
  bool unsettable = false;
  sequence.memory = memory ? *memory
                           : memory_of(sequence.requests, *device_.protocol, device_.station,
                                       device_.over_the_wire, random_, unsettable);
  if (sequence.requests.empty() || unsettable) return std::nullopt;
  Result<std::vector<Answer>> answers = oracle_.ask(sequence.requests, sequence.memory, true);
  if (!answers || answers->empty()) return std::nullopt;
  if (device_.over_the_wire) {
    const Result<std::vector<Answer>> again =
        oracle_.ask(sequence.requests, sequence.memory, false);
    if (!again || again->size() != answers->size()) return std::nullopt;
    for (std::size_t i = 0; i < answers->size(); ++i)
      if ((*again)[i].bytes != (*answers)[i].bytes) return std::nullopt;
  }
  sequence.answers = std::move(*answers);
  sequence.requests.resize(sequence.answers.size());
  return sequence;
}

CaseResult Explorer::run(const Sequence& sequence, const std::string& id) {
  vectors::Case& one = running_[turn_ ^= 1];
  one = case_of(sequence.requests, sequence.answers, sequence.memory, *device_.protocol,
                device_.station, id);
  sent_ += sequence.answers.size();
  return device_.run(one);
}

void Explorer::step() {
  const std::optional<Sequence> sequence = answered(invent(), nullptr);
  barren_ = sequence ? 0 : barren_ + 1;
  if (!sequence) return;
  ++sequences_;
  note(*sequence, run(*sequence, fmt::format("explore/{}", sequences_)));
}

void Explorer::weigh(const Request& request, const std::string& sort) {
  std::map<std::string, std::uint64_t>& seen = seen_[{request.topic, request.kind}];
  std::size_t& weight = weights_[request.topic];
  if (seen[sort]++ == 0)
    weight = news_weight;
  else if (seen[sort] % 64 == 0)
    weight = std::max(least_weight, weight / 2);
}

void Explorer::note(const Sequence& sequence, const CaseResult& result) {
  if (differs(result.verdict) && differs_in_letters_alone(result)) {
    ++unjudged_[{Verdict::blocked, "the same answers, in other letters"}];
    return;
  }
  const bool as_the_model = result.verdict == Verdict::pass || result.verdict == Verdict::marginal;
  if (!differs(result.verdict) && !as_the_model) {
    ++unjudged_[{result.verdict, result.message}];
    return;
  }
  ++judged_;
  if (!as_the_model) return note_finding(sequence, result);
  for (std::size_t i = 0; i < sequence.answers.size(); ++i)
    weigh(sequence.requests[i], sort_of(sequence.answers[i], *device_.protocol));
}

bool Explorer::shows(const Sequence& sequence, Verdict verdict) {
  return run(sequence, "explore/shorter").verdict == verdict;
}

/// Leaves out what it still shows without: halves, quarters, single requests.
Explorer::Sequence Explorer::shortened(Sequence sequence, Verdict verdict) {
  int trials = 0;
  for (std::size_t size = std::max<std::size_t>(1, sequence.requests.size() / 2); size > 0;
       size /= 2)
    for (std::size_t at = 0;
         at < sequence.requests.size() && trials < most_trials && device_.alive();) {
      if (sequence.requests.size() <= size) break;
      std::vector<Request> fewer = sequence.requests;
      const auto from = fewer.begin() + static_cast<std::ptrdiff_t>(at);
      fewer.erase(from, from + static_cast<std::ptrdiff_t>(std::min(size, fewer.size() - at)));
      std::optional<Sequence> shorter = answered(std::move(fewer), &sequence.memory);
      ++trials;
      if (shorter && shows(*shorter, verdict))
        sequence = std::move(*shorter);
      else
        at += size;
    }
  // A real device holds something everywhere: there all that is named is given.
  return device_.over_the_wire ? sequence : without_needless_memory(std::move(sequence), verdict);
}

Explorer::Sequence Explorer::without_needless_memory(Sequence sequence, results::Verdict verdict) {
  for (std::size_t at = 0; at < sequence.memory.size() && device_.alive();) {
    Memory fewer = sequence.memory;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(at));
    std::optional<Sequence> lean = answered(sequence.requests, &fewer);
    if (lean && lean->answers.size() == sequence.answers.size() && shows(*lean, verdict))
      sequence = std::move(*lean);
    else
      ++at;
  }
  return sequence;
}

/// Up to what failed, then less and less of it.
Explorer::Sequence Explorer::shortest(const Sequence& sequence, std::size_t failing,
                                      Verdict verdict) {
  std::vector<Request> until(sequence.requests.begin(),
                             sequence.requests.begin() + static_cast<std::ptrdiff_t>(failing) + 1);
  std::optional<Sequence> begun = answered(std::move(until), &sequence.memory);
  const bool enough = begun && shows(*begun, verdict);
  return shortened(enough ? std::move(*begun) : sequence, verdict);
}

void Explorer::note_finding(const Sequence& sequence, const CaseResult& result) {
  const std::size_t failing = failing_request(result, sequence.requests.size());
  const std::string mark = mark_of(sequence.requests[failing], result);
  if (const auto known = findings_.find(mark); known != findings_.end()) {
    ++known->second.times;
    return;
  }
  if (findings_.size() >= most_findings) {
    ++unjudged_[{result.verdict, "differs, not looked into: there are 50 findings"}];
    return;
  }
  Sequence found = shortest(sequence, failing, result.verdict);
  int shown = 0;
  while (shown < confirmations && device_.alive() && shows(found, result.verdict)) ++shown;
  Finding finding;
  finding.confirmed = shown == confirmations;
  if (!finding.confirmed) found = sequence;
  const std::string id = fmt::format(
      "{}/explore/f{:08x}", vectors::folder_of(*device_.protocol),
      static_cast<std::uint32_t>(vectors::extend_fingerprint(vectors::empty_fingerprint, mark)));
  finding.shortest =
      case_of(found.requests, found.answers, found.memory, *device_.protocol, device_.station, id);
  finding.result = finding.confirmed ? device_.run(finding.shortest) : result;
  finding.result.id = id;
  findings_.emplace(mark, std::move(finding));
}

}  // namespace fieldproof::explore
