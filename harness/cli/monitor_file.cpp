#include "harness/cli/monitor_file.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>

#include "src/plc/model.hpp"

namespace fieldproof::cli {

namespace {

std::string clock_text() {
  using namespace std::chrono;
  const auto now = system_clock::now();
  const auto ms = duration_cast<milliseconds>(now.time_since_epoch()) % 1s;
  return fmt::format("{:%Y/%m/%d %H:%M:%S}.{:03}", fmt::localtime(system_clock::to_time_t(now)),
                     ms.count());
}

std::string elapsed_text(Duration elapsed) {
  return fmt::format("{:.3f} s", to_ms(elapsed) / 1000);
}

}  // namespace

Result<plc::FrameMonitor::Record> open_monitor_file(const std::string& path,
                                                    std::string_view model) {
  const auto file = std::make_shared<std::ofstream>(path, std::ios::binary);
  if (!(*file << plc::csv_header() << std::flush))
    return fail(
        fmt::format("cannot write {}: {}; give --monitor a file in a folder that you may write",
                    path, std::strerror(errno)));
  const plc::PlcModel* known = plc::find_plc_model(model);
  const bool has_clock = !known || known->clock;
  return plc::FrameMonitor::Record(
      [file, has_clock, first = std::optional<Time>()](const plc::MonitoredFrame& frame) mutable {
        if (!first) first = frame.time;
        *file << plc::csv_row(frame, has_clock ? clock_text() : elapsed_text(frame.time - *first))
              << std::flush;
      });
}

}  // namespace fieldproof::cli
