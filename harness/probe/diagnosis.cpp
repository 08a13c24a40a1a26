#include "harness/probe/diagnosis.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <charconv>

#include "harness/notation/notation.hpp"

namespace fieldproof::probe {

using harness::Field;
using line::LineSettings;

namespace {

struct Found {
  const harness::Protocol* protocol = nullptr;
  std::size_t at = 0, size = 0;
  int station = -1;

  std::size_t end() const { return at + size; }
};

/// The number in a frame's field "station", or -1.
int station_in(const std::vector<Field>& fields) {
  const auto field = std::ranges::find(fields, "station", &Field::name);
  if (field == fields.end()) return -1;
  int station = -1;
  std::from_chars(field->text.data(), field->text.data() + field->text.size(), station, 16);
  return station;
}

bool same_parts(const std::vector<Field>& a, const std::vector<Field>& b) {
  return std::ranges::equal(a, b, {}, &Field::name, &Field::name);
}

/// Does a faultless frame answer this question? A refusal may have a form of its own, but it begins
/// otherwise than the question; what is made of the same parts is a question itself, of another
/// master.
bool answers(const harness::Protocol& protocol, ByteView question, ByteView frame,
             const std::vector<Field>& fields) {
  if (same_parts(fields, protocol.explain(question))) return false;
  return protocol.is_reply_to_probe(question, frame) || frame.front() != question.front();
}

/// The first whole frame without a fault at or behind `from`; where there is a `question`, one that
/// answers it.
std::optional<Found> find_frame(const harness::Protocol& protocol, ByteView bytes, std::size_t from,
                                ByteView question) {
  for (std::size_t at = from; at < bytes.size(); ++at) {
    const ByteView rest = bytes.subspan(at);
    const auto size = protocol.frame_length(rest);
    if (!size || *size == 0 || *size > rest.size()) continue;
    const ByteView frame = rest.first(*size);
    const std::vector<Field> fields = protocol.explain(frame);
    const int station = station_in(fields);
    if (station < 0 ||
        !std::ranges::all_of(fields, [](const Field& f) { return f.problem.empty(); }))
      continue;
    if (!question.empty() && !answers(protocol, question, frame, fields)) continue;
    return Found{&protocol, at, *size, station};
  }
  return std::nullopt;
}

std::optional<Found> find_any(const harness::Protocols& known, ByteView bytes) {
  for (const harness::Protocol* protocol : known)
    if (const auto found = find_frame(*protocol, bytes, 0, {})) return found;
  return std::nullopt;
}

/// Header, station and command stand there as the reply has them, whatever follows.
bool begins_as_reply(const Trial& trial, ByteView bytes) {
  const std::vector<Field> fields = trial.protocol->explain(bytes);
  const auto station = std::ranges::find(fields, "station", &Field::name);
  if (station_in(fields) != trial.station || fields.end() - station < 2) return false;
  return std::all_of(fields.begin(), station + 2, [](const Field& f) { return f.problem.empty(); });
}

Bytes changed(ByteView bytes, Byte (*change)(Byte)) {
  Bytes result;
  std::ranges::transform(bytes, std::back_inserter(result), change);
  return result;
}

/// The parity that all of these bytes have, their eighth bit included; N: some this, some that.
char parity_of(ByteView bytes) {
  const auto odd = static_cast<std::size_t>(
      std::ranges::count_if(bytes, [](Byte b) { return std::popcount(b) % 2 != 0; }));
  if (odd == 0) return 'E';
  return odd == bytes.size() ? 'O' : 'N';
}

/// Seven data bits read as eight: the eighth is the parity bit, or the first of two stop bits.
std::optional<LineSettings> seven_bits(const Trial& trial, ByteView bytes, ByteView question) {
  if (trial.line.data_bits != 8 || std::ranges::all_of(bytes, [](Byte b) { return b < 0x80; }))
    return std::nullopt;
  const Bytes low = changed(bytes, [](Byte b) { return static_cast<Byte>(b & 0x7F); });
  if (!find_frame(*trial.protocol, low, 0, question)) return std::nullopt;
  LineSettings line = trial.line;
  line.data_bits = 7;
  line.parity = parity_of(bytes);
  return line;
}

/// A byte that frames in ASCII are made of.
bool is_frame_text(Byte b) {
  return (b >= 0x02 && b <= 0x06) || b == 0x15 || b == '\r' || b == '\n' || (b >= 0x20 && b < 0x7F);
}

/// Read without parity, a parity bit stands where the stop bit is due: what has a 0 there is
/// dropped with a framing error, and what remains is all of one parity. So are the bytes of a
/// device that is slower by half, but no text.
std::optional<LineSettings> parity_bit_as_stop(const Trial& trial, const Heard& heard,
                                               ByteView bytes) {
  constexpr std::size_t enough = 3;
  if (trial.line.parity != 'N' || bytes.size() < enough ||
      heard.errors.find("framing") == std::string::npos)
    return std::nullopt;
  if (!std::ranges::all_of(bytes, is_frame_text)) return std::nullopt;
  if (std::ranges::all_of(bytes, [&](Byte b) { return b == bytes.front(); })) return std::nullopt;
  const char survivors = parity_of(bytes);
  if (survivors == 'N') return std::nullopt;
  LineSettings line = trial.line;
  line.parity = survivors == 'O' ? 'E' : 'O';  // even parity sets the bit where the ones are odd
  return line;
}

std::optional<LineSettings> other_format(const Trial& trial, const Heard& heard, ByteView bytes,
                                         ByteView question) {
  if (const auto seven = seven_bits(trial, bytes, question)) return seven;
  if (const auto parity = parity_bit_as_stop(trial, heard, bytes)) return parity;
  // Parity errors alone: the stop bits stand where they are due, so speed and length of the
  // characters are right.
  if (heard.errors.find("parity") == std::string::npos ||
      heard.errors.find("framing") != std::string::npos)
    return std::nullopt;
  LineSettings line = trial.line;
  if (bytes.empty()) {  // the other parity leaves no byte right
    line.parity = line.parity == 'E' ? 'O' : 'E';
  } else if (line.data_bits == 7) {  // an eighth data bit stands where parity is due
    line.data_bits = 8;
    line.parity = 'N';
  } else {
    return std::nullopt;
  }
  return line;
}

Time start_of(const std::vector<Burst>& bursts, std::size_t index) {
  for (const Burst& burst : bursts) {
    if (index < burst.bytes.size())
      return burst.start + burst.character_time * static_cast<Duration::rep>(index);
    index -= burst.bytes.size();
  }
  return {};
}

class Reading {
 public:
  Reading(const Trial& trial, const Heard& heard)
      : trial_(trial), heard_(heard), bytes_(all_bytes(heard.after)) {
    if (trial.protocol) question_ = trial.protocol->probe(trial.station, {});
    diagnosis_.echo = !question_.empty() && bytes_.size() >= question_.size() &&
                      std::equal(question_.begin(), question_.end(), bytes_.begin());
    if (diagnosis_.echo) from_ = question_.size();
    diagnosis_.frame.assign(bytes_.begin() + static_cast<std::ptrdiff_t>(from_), bytes_.end());
  }

  Diagnosis read(const harness::Protocols& known) {
    const bool answered = diagnosis_.frame.size() > 0;
    if (!answered) diagnosis_.frame = all_bytes(heard_.before);  // it was not for us, or comes late
    const Bytes rest = diagnosis_.frame;
    if (rest.empty() && heard_.errors.empty()) return std::move(diagnosis_);
    if (trial_.protocol && answered) {
      if (const auto found = find_frame(*trial_.protocol, bytes_, from_, question_))
        return reply(*found);
    }
    if (trial_.protocol) {
      if (const auto line = other_format(trial_, heard_, rest, question_)) {
        diagnosis_.right_format = line;
        return as(Symptom::format);
      }
    }
    if (const auto found = find_any(known, rest)) {
      take(*found, rest);
      return as(Symptom::foreign_frame);
    }
    if (trial_.protocol && begins_as_reply(trial_, rest)) return as(Symptom::damaged);
    if (find_any(known, changed(rest, [](Byte b) { return static_cast<Byte>(~b); })))
      return as(Symptom::inverted);
    return as(Symptom::garbage);
  }

 private:
  Diagnosis as(Symptom symptom) {
    diagnosis_.symptom = symptom;
    return std::move(diagnosis_);
  }

  void take(const Found& found, const Bytes& bytes) {
    diagnosis_.protocol = found.protocol;
    diagnosis_.station = found.station;
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(found.at);
    diagnosis_.frame.assign(first, first + static_cast<std::ptrdiff_t>(found.size));
  }

  Diagnosis reply(const Found& found) {
    take(found, bytes_);
    diagnosis_.stray = found.at - from_ + bytes_.size() - found.end();
    const std::vector<Burst>& bursts = heard_.after;
    diagnosis_.response_time =
        std::max<Duration>(Duration::zero(), start_of(bursts, found.at) - heard_.asked_until);
    if (const auto second = find_frame(*trial_.protocol, bytes_, found.end(), question_)) {
      diagnosis_.stray -= second->size;
      return as(Symptom::second_reply);
    }
    return as(found.station == trial_.station ? Symptom::reply : Symptom::other_station);
  }

  const Trial& trial_;
  const Heard& heard_;
  Bytes bytes_, question_;
  std::size_t from_ = 0;  // behind the echo
  Diagnosis diagnosis_;
};

}  // namespace

Bytes all_bytes(const std::vector<Burst>& bursts) {
  Bytes bytes;
  for (const Burst& burst : bursts)
    bytes.insert(bytes.end(), burst.bytes.begin(), burst.bytes.end());
  return bytes;
}

std::string_view to_string(Symptom symptom) {
  switch (symptom) {
    case Symptom::silence: return "silence";
    case Symptom::reply: return "reply";
    case Symptom::second_reply: return "two replies";
    case Symptom::other_station: return "another station answers";
    case Symptom::foreign_frame: return "a frame that answers nothing we asked";
    case Symptom::format: return "readable with another character format";
    case Symptom::damaged: return "a damaged reply";
    case Symptom::inverted: return "inverted bits";
    case Symptom::garbage: return "garbage";
  }
  return "";
}

Diagnosis diagnose(const Trial& trial, const Heard& heard, const harness::Protocols& known) {
  return Reading(trial, heard).read(known);
}

std::string shown(ByteView bytes) {
  constexpr std::size_t enough = 24;
  if (bytes.size() <= enough) return notation::print_bytes(bytes);
  return fmt::format("{} ... ({} bytes)", notation::print_bytes(bytes.first(enough)), bytes.size());
}

}  // namespace fieldproof::probe
