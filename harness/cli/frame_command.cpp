#include <fmt/format.h>
#include <algorithm>
#include <cstdio>
#include <optional>

#include "harness/cli/commands.hpp"
#include "harness/cli/frame_text.hpp"
#include "harness/protocol.hpp"
#include "harness/run/run_report.hpp"

namespace fieldproof::cli {

namespace {

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
    if (other && protocol->has_mark(other->bytes)) return other;
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
  const std::string hex_of_all = to_hex(bytes);
  if (const std::string text = notation::print_bytes(bytes); text != hex_of_all)
    run::tell(text + '\n');
  run::tell(
      fmt::format("{}\n{}, {} bytes\n\n", hex_of_all, reading->protocol->name(), bytes.size()));
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
