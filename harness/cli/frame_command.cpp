#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "harness/cli/commands.hpp"
#include "harness/notation/frame_template.hpp"
#include "harness/protocol.hpp"
#include "harness/run/run_report.hpp"

namespace fieldproof::cli {

namespace {

/// "[ENQ]01rSS[EOT]A4" or "<05>01": a frame monitor's text, with control names or hex in brackets.
Bytes read_monitor_text(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char close = text[i] == '[' ? ']' : text[i] == '<' ? '>' : '\0';
    const std::size_t end = close ? text.find(close, i) : std::string::npos;
    const Result<notation::Notation> word =
        end == std::string::npos ? Result<notation::Notation>(fail(""))
                                 : notation::parse_notation(text.substr(i + 1, end - i - 1));
    if (word && word->size() == 1 && word->front().bytes.size() == 1) {
      bytes.push_back(word->front().bytes.front());
      i = end;
    } else {
      bytes.push_back(static_cast<Byte>(text[i]));
    }
  }
  return bytes;
}

bool looks_like_hex(const std::string& text) {
  return std::ranges::all_of(text, [](char c) { return c == ' ' || hex_digit(c) >= 0; }) &&
         from_hex(text).has_value();
}

/// Notation, hex or raw, in this order of likelihood.
Result<Bytes> read_frame_text(const std::string& text, const notation::Fields& stations) {
  if (looks_like_hex(text)) return *from_hex(text);
  const Result<notation::Notation> notation = notation::parse_notation(text);
  if (!notation) {
    const bool raw = !text.empty() && (static_cast<unsigned char>(text[0]) < 0x20 ||
                                       text[0] == '[' || text[0] == '<');
    const bool monitor =
        raw && text.find('\'') == std::string::npos && text.find("] ") == std::string::npos;
    if (monitor) return read_monitor_text(text);
    return notation.error();
  }
  const Result<std::vector<notation::FrameTemplate>> templates =
      notation::make_templates(*notation, stations);
  if (!templates) return templates.error();
  return notation::render(templates->front(), {});
}

struct FrameReading {
  const harness::Protocol* protocol = nullptr;
  Bytes bytes;
  std::vector<harness::Field> fields;

  auto problems() const {
    return std::ranges::count_if(
        fields, [](const harness::Field& field) { return !field.problem.empty(); });
  }
  /// How little it is a frame of this protocol: what is foreign to it weighs more than what is
  /// wrong in it, or still missing.
  auto strangeness() const {
    constexpr int foreign = 10;
    return problems() +
           foreign * std::ranges::count(fields, "foreign bytes", &harness::Field::name);
  }
};

Result<FrameReading> read_as(const harness::Protocol& protocol, const FrameOptions& options) {
  const notation::Fields stations = protocol.fields_at(options.station);
  Result<Bytes> bytes = read_frame_text(options.frame, stations);
  if (!bytes) return bytes.error();
  std::vector<harness::Field> fields = protocol.explain(*bytes);
  return FrameReading{&protocol, std::move(*bytes), std::move(fields)};
}

/// As the protocol that was named, else as the one to which it is least strange. One part alone
/// explains nothing.
Result<FrameReading> best_reading(const FrameOptions& options,
                                  const harness::Protocols& protocols) {
  if (!options.protocol.empty()) {
    const Result<const harness::Protocol*> protocol = protocols.choose(options.protocol, "");
    if (!protocol) return protocol.error();
    return read_as(**protocol, options);
  }
  Result<FrameReading> best = read_as(protocols.front(), options);
  for (const harness::Protocol* protocol : protocols) {
    Result<FrameReading> other = read_as(*protocol, options);
    if (best && other && other->fields.size() > 1 && other->strangeness() < best->strangeness())
      best = std::move(other);
  }
  return best;
}

/// Empty: one whole frame.
std::string problem_of_end(const harness::Protocol& protocol, ByteView bytes) {
  if (!protocol.has_frame_ends()) return {};
  const std::optional<std::size_t> length = protocol.frame_length(bytes);
  if (!length) return "the frame is incomplete: more bytes must follow";
  if (*length < bytes.size())
    return fmt::format("the frame ends after {} bytes; {} more follow it", *length,
                       bytes.size() - *length);
  return {};
}

}  // namespace

int frame_command(const FrameOptions& options, const harness::Protocols& protocols) {
  const Result<FrameReading> reading = best_reading(options, protocols);
  if (!reading) return run::complain(reading.error().message, run::exit_code::usage);
  const ByteView bytes = reading->bytes;
  run::tell(fmt::format("{}\n{}\n{}, {} bytes\n\n", notation::print_bytes(bytes), to_hex(bytes),
                        reading->protocol->name(), bytes.size()));
  for (const harness::Field& field : reading->fields) {
    const std::string hex = to_hex(bytes.subspan(field.offset, field.size));
    run::tell(fmt::format("{:>4}  {:<22} {:<30} {}\n", field.offset, field.name, field.text,
                          hex.size() > 47 ? hex.substr(0, 44) + "..." : hex));
    if (!field.problem.empty()) run::tell(fmt::format("      {:<22} ! {}\n", "", field.problem));
  }
  const std::string end = problem_of_end(*reading->protocol, bytes);
  if (!end.empty()) run::tell(fmt::format("      {:<22} ! {}\n", "", end));
  return reading->problems() == 0 && end.empty() ? run::exit_code::ok : run::exit_code::failed;
}

}  // namespace fieldproof::cli
