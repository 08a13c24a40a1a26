#include "reports/text/remedy.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "reports/text/failures.hpp"

namespace fieldproof::text {
namespace {

/// What a reason says, and what would end it; the first that fits. Options stand first: a reason
/// that names one says what to do.
constexpr std::array<std::pair<std::string_view, std::string_view>, 26> remedies = {{
    {"does not declare to follow",
     "a program of --stimulus that follows more of what a case asks of it"},
    {"--stimulus",
     "something that makes the device ask: --stimulus COMMAND, or \"prepared_blocks\""},
    {"--power-cycle", "a device fresh from power-on: --power-cycle COMMAND"},
    {"--allow-motion", "permission to move axes: --allow-motion AXES"},
    {"allow", "permission to write: --allow-write RANGES"},
    {"--aux", "another port of the same device: --aux ENDPOINT"},
    {"--control does not support",
     "a device or --control program that supports more of what a case asks of it"},
    {"--control", "a way to set the device up: --control COMMAND"},
    {"needs a second line", "a second line to the same device, which takes a wire of its own"},
    {"the device does not answer", "a device that answers when it is set up for a case"},
    {"the bench cannot look", "a way to look at memory in that moment: --control COMMAND"},
    {"line = ", "a line with these settings: serial:PORT, or --matrix"},
    {"no room", "more words to write in: --allow-write RANGES"},
    {"cannot be moved", "the very addresses of the manual's example: --allow-write RANGES"},
    {"is about station",
     "the station that the case is about: {station} in the command of exec:, --control"},
    {"no command reads", "a way to what no command reads: --control COMMAND, or a look in XG5000"},
    {"read only over the protocol", "a way into memory that the protocol cannot write: --control"},
    {"read only with the bases", "a way into memory that the protocol cannot write: --control"},
    {"cannot do ", "a device whose mode and power the bench can change: --control"},
    {"the profile declares",
     "other settings: marks in the command of exec:, --control, \"config\" of the profile"},
    {"needs connections", "a device on a network: tcp:HOST:PORT?udp=PORT"},
    {"needs datagrams", "a device that takes datagrams: tcp:HOST:PORT?udp=PORT"},
    {"behind a pty or socket", "a real line, which carries short times: serial:PORT"},
    {"set-up: ", "a device that takes what sets the case up (see the failures)"},
    {"would say the same", "a device that answers to the end of the run"},
    {"not run: ", "a run that goes on to its end"},
}};

}  // namespace

std::string remedy_of(const std::string& reason) {
  for (const auto& [says, remedy] : remedies)
    if (reason.find(says) != std::string::npos) return std::string(remedy);
  return reason.empty() ? "no reason given" : kind_of(reason);
}

}  // namespace fieldproof::text
